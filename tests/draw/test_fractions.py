"""Transfer functions inside of blocks: polynomials as control books write them."""

from __future__ import annotations

import re

import pytest
from library.values import library
from tracewire.diagram import read_text
from tracewire.draw import draw
from tracewire.draw.font import text_width
from tracewire.draw.fractions import items_of, polynomial, raised
from tracewire.draw.graph import Look
from tracewire.draw.limits import LETTER
from tracewire.draw.shapes import SHAPES, Drawn, shape_of


@pytest.mark.parametrize(
    ("written", "shown"),
    [
        ("[1, 6, 4]", "s² + 6 s + 4"),
        ("[L, R]", "L s + R"),
        ("[-1, 0, -k/m]", "−s² − k/m"),
        ("[2*m, c, 0]", "(2*m) s² + c s"),
        ("[max(c, d), 1]", "(max(c, d)) s + 1"),
        ("[1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]", "s¹⁰"),
        ("[0]", "0"),
        ("k", "k"),
    ],
)
def test_coefficients_are_a_polynomial(written: str, shown: str) -> None:
    assert polynomial(items_of(written), "s") == shown


def test_a_delay_is_a_power() -> None:
    assert raised("z", -1) == "z⁻¹"


def look(type_name: str, numbers: dict[str, float] | None = None, **settings: str) -> Look:
    return shape_of(Drawn(type_name, settings, numbers or {}, 1, library()[type_name]))


@pytest.mark.parametrize(
    ("drawn", "lines"),
    [
        (look("integrator"), ("1", "s")),
        (look("transfer_function", denominator="[m, c, k]"), ("1", "m s² + c s + k")),
        (
            look("discrete_transfer_function", numerator="[0.1]", denominator="[1, -0.9]"),
            ("0.1", "z − 0.9"),
        ),
        (look("first_order", k="3", lag="T"), ("3", "T s + 1")),
        (look("lead_lag", lead="0.2", lag="T", k="2"), ("2 (0.2 s + 1)", "T s + 1")),
        (look("derivative", lag="T"), ("s", "T s + 1")),
        (look("discrete_integrator", {"weight": 0.0}), ("T", "z − 1")),
        (look("discrete_integrator", {"weight": 0.5}, gain="3"), ("3 T (z + 1)", "2 (z − 1)")),
        (look("unit_delay"), ("z⁻¹",)),
        (look("compare", level="3"), ("≥ 3",)),
    ],
)
def test_a_block_shows_what_it_is(drawn: Look, lines: tuple[str, ...]) -> None:
    assert drawn.lines == lines
    assert all(text_width(line) <= drawn.width for line in lines)


def test_a_long_polynomial_is_named_only() -> None:
    drawn = look("transfer_function", denominator=f"[{', '.join(['coefficient'] * 9)}]")
    assert drawn.lines == ("b(s)", "a(s)")
    drawn = look("transfer_function", numerator="gain_of_the_motor_and_the_plate" * 3)
    assert max(map(text_width, drawn.lines)) <= LETTER.most_text


def test_a_fraction_has_a_bar_over_its_text() -> None:
    text = (
        "blocks:\n  u: {type: time}\n  y: {type: transfer_function, of: u, denominator: [1, 6, 4]}"
    )
    svg = draw(read_text(text)).svg
    assert ">s² + 6 s + 4</text>" in svg
    bars = re.findall(r'class="axis ink" d="M([\d.]+) [\d.]+L([\d.]+)', svg)
    assert [float(b) - float(a) >= text_width("s² + 6 s + 4") for a, b in bars] == [True]


FAMILIES = ("control", "filters", "waves", "noise", "discrete", "logic", "delay")


def test_blocks_of_signals_and_control_have_a_shape_of_their_own() -> None:
    named = {name for name, family in library().families.items() if family in FAMILIES}
    assert named <= SHAPES.keys()


def test_a_signal_builder_shows_its_lines_and_jumps() -> None:
    drawn = look("signal_builder", times="[0, 2, 2, 4]", values="[0, 1, -2, -2]")
    assert drawn.curve == (((-1, 0), (0, 0.5), (0, -1), (1, -1)),)
    assert look("signal_builder", times="[0, 2]", values="[0, a]").curve
