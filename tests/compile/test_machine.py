"""Machine code against the readable source, bit for bit, and what its address API promises."""

from __future__ import annotations

import math
import random
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from compile.calls import EAGER, LAZY, Point, bits, both, called, moved, random_point, values
from compile.formulas import JUMPING, SMOOTH
from hypothesis import given, settings
from hypothesis import strategies as st
from library.values import library
from numpy.typing import NDArray
from solve.models import BALL, one
from tracewire.compile import Model, compile, native
from tracewire.diagram import read, read_text
from tracewire.errors import OptionError
from tracewire.library import Block

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "diagrams" / "papers" / "a_torsion" / "pendulum.yaml"
PLANE = """
span: [0, 1]
blocks:
  x: {{type: integrator, of: f, start: 0.3}}
  y: {{type: integrator, of: g}}
  f: {{type: expression, formula: "{0}"}}
  g: {{type: expression, formula: "{1}"}}
"""


def agree(diagram: object, seeds: range, record: tuple[str, ...] = (), lazy: bool = True) -> None:
    """Both back ends give the same bits for all functions at random points."""
    machine, python = both(diagram, record)  # type: ignore[arg-type]
    assert machine.routines.sizes == python.routines.sizes
    for seed in seeds:
        at = random_point(machine, seed)
        for name in (*EAGER, *LAZY) if lazy else EAGER:
            assert bits(values(machine, name, at)) == bits(values(python, name, at)), (name, at)


# the same bits


def test_paper_a_is_the_same_in_both_back_ends() -> None:
    agree(read(PAPER), range(40))


GIVEN = {
    "denominator": "[2, 0.3, 1]",
    "register": "[1, 0, 0]",
    "seed": "3",
    "limited_integrator.low": "-0.3",
    "off_at": "0.2",
    "times": "[0, 1, 1]",
    "rows": "[0, 1]",
    "columns": "[0, 1]",
    "signal_builder.values": "[1, 2, 0]",
    "lookup_table_2d.values": "[[1, x], [y, 2]]",
}
"""Parameters that are lists, or that another one bounds, by their names, or block and name."""


def use(block: Block) -> str:
    """A use of a shipped block that reads the states x and y; what reads a drive, the time."""
    parts = [f"type: {block.name}"]
    signals = ("now", "now") if block.effect and block.effect.place == "drive" else ("x", "y")
    for number, port in enumerate(block.inputs):
        if port.name == "past":  # of a delay: a signal of t alone
            continue
        wire = "[x, -y]" if port.many else signals[number % 2]
        parts.append(f"{port.name}: {wire}")
    for number, parameter in enumerate(block.parameters):
        if parameter.default is None:
            given = {"points": "[[0, 1], [1, 2], [3, 0.5]]", "formula": "x*y + t"}
            number_text = GIVEN.get(parameter.name, f"{0.3 + 0.4 * number:.1f}")
            value = given.get(parameter.kind, number_text)
            value = GIVEN.get(f"{block.name}.{parameter.name}", value)
            parts.append(f"{parameter.name}: {value}")
    return ", ".join(parts)


SCALAR = [
    block for block in library().blocks.values() if library().families[block.name] != "vector"
]


@pytest.mark.parametrize("block", SCALAR, ids=[block.name for block in SCALAR])
def test_every_shipped_block_is_the_same_in_both_back_ends(block: Block) -> None:
    text = (
        PLANE.format("y - 0.1*x", "sin(t) - x")
        + f"  now: {{type: time}}\n  block: {{{use(block)}}}\n"
    )
    outputs = [block.outputs[0].name] if len(block.outputs) == 1 else []
    record = ("block",) if outputs else tuple(f"block.{output.name}" for output in block.outputs)
    agree(text, range(5), record)


@given(f=JUMPING, g=SMOOTH, seed=st.integers(0, 1000))
@settings(max_examples=40, deadline=None)
def test_any_formula_is_the_same_in_both_back_ends(f: str, g: str, seed: int) -> None:
    agree(PLANE.format(f, g), range(seed, seed + 3), ("f",))


CORNERS = [
    ("1/x", 0.0, math.inf),
    ("1/x", -0.0, -math.inf),
    ("x/x", 0.0, math.nan),
    ("-1/(x*x)", 0.0, -math.inf),
    ("log(x)", 0.0, -math.inf),
    ("log(x)", -1.0, math.nan),
    ("sqrt(x)", -1.0, math.nan),
    ("exp(x)", 1000.0, math.inf),
    ("sinh(x)", -1000.0, -math.inf),
    ("cosh(x)", -1000.0, math.inf),
    ("asin(x)", 1.5, math.nan),
    ("acos(x)", -1.5, math.nan),
    ("sin(x)", math.inf, math.nan),
    ("sin(x) + cos(x)", math.inf, math.nan),
    ("tan(x)", -math.inf, math.nan),
    ("x**(1/3)", -8.0, math.nan),
    ("x**309", -10.0, -math.inf),
    ("x**(-1)", 0.0, math.inf),
    ("0**x", -1.0, math.inf),
    ("1**x", math.nan, 1.0),
    ("x**x", 0.0, 1.0),
    ("x*10", 1e308, math.inf),
    ("x - x", math.inf, 0.0),  # folded: the tape knows no infinity
    ("(x - 1) - x", math.inf, math.nan),
    ("atan2(x, -1)", 0.0, math.pi),
    ("atan2(0, x)", -0.0, math.pi),
    ("atan(x)", math.inf, math.pi / 2),
    ("tanh(x)", -math.inf, -1.0),
]


@pytest.mark.parametrize(("formula", "x", "exact"), CORNERS)
def test_corners_are_those_of_c(formula: str, x: float, exact: float) -> None:
    for model in both(one(formula)):
        at = Point(0.0, [x], [], [], [])
        assert bits(values(model, "rhs", at)) == bits([exact])


@pytest.mark.parametrize("x", [-2.0, -1.0, 0.0, 0.5, 1.0, 1.5, 3.0, 4.0])
def test_tables_are_straight_lines_and_held_outside(x: float) -> None:
    text = PLANE.format("table", "x") + "  table: {type: table, of: x, points: [[0, 1], [1, 3]]}\n"
    lines = [(0.0, 1.0, 0.0), (1.0, 1.0 + 2 * x, 2.0), (2.0, 3.0, 0.0)]
    table = [1.0, 2.0, 0.0, 1.0, 1.0, 3.0, 2.0]
    for model in both(text):
        for piece, value, slope in lines:
            at = Point(0.0, [x, 0.0], [piece, 0.0], [], table)
            assert values(model, "rhs", at) == [value, x]
            assert values(model, "jacobian", at) == [slope, 0.0, 0.0, 1.0, 0.0, 0.0]


def test_a_product_is_rounded_before_it_is_added() -> None:
    odd = 1 + 2.0**-30
    for model in both(PLANE.format("x*x - y", "0")):
        assert values(model, "rhs", Point(0.0, [odd, odd * odd], [], [], []))[0] == 0.0


def test_a_sine_beside_its_cosine_has_the_bits_of_the_sine_alone() -> None:
    pair, _ = both(one("sin(x) + 0*t", 0.0, "  c: {type: cos, of: x}"), ("rate", "c"))
    draw = random.Random(1)
    sizes = [10.0**power for power in range(-8, 23)]
    for x in [draw.uniform(-size, size) for size in sizes for _ in range(100)]:
        found = values(pair, "outputs", Point(0.0, [x], [], [], []))
        assert bits(found[-2:]) == bits([math.sin(x), math.cos(x)])


def chain(length: int) -> str:
    """A chain of masses with springs, sines and switches."""
    blocks = []
    for i in range(length):
        near = f"x{(i - 1) % length} + x{(i + 1) % length} - 2*x{i}"
        force = f"{near} - sin(x{i})*cos(x{i}) + (k*exp(-x{i}) if x{i} >= 0.1 else k/3)"
        blocks += [
            f"  x{i}: {{type: integrator, of: v{i}, start: 0.{i}}}",
            f"  v{i}: {{type: integrator, of: a{i}}}",
            f'  a{i}: {{type: expression, formula: "{force}"}}',
        ]
    return "\n".join(["span: [0, 1]", "parameters: {k: 0.5}", "blocks:", *blocks, ""])


@pytest.mark.parametrize("large", [10**9, 0])
def test_long_functions_are_compiled_in_parts(large: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native.CODE, "large", large)
    monkeypatch.setattr(native.CODE, "kept", 0)
    native._kept.clear()
    agree(chain(60), range(2))


# derivatives


@given(f=SMOOTH, g=SMOOTH, seed=st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_the_jacobian_is_that_of_central_differences(f: str, g: str, seed: int) -> None:
    model, _ = both(PLANE.format(f, g))
    at = random_point(model, seed, 2.0)
    found = values(model, "jacobian", at)
    for column, index in enumerate((0, 1, -1)):
        tried = [differences(model, at, index, step) for step in (1e-4, 1e-5, 1e-6)]
        for row in range(2):
            slope = found[3 * row + column]
            assert any(
                slope == pytest.approx(exact[row], rel=1e-6, abs=1e-6 + error[row])
                for exact, error in tried
            ), (slope, tried)


def differences(
    model: Model, at: Point, index: int, step: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Richardson's derivatives of the rates by one of the arguments, and how sure they are: a sine
    of t**9 turns within a long step, and a short one has few digits left."""
    high, low, wide, narrow = (
        np.array(values(model, "rhs", moved(at, index, s)))
        for s in (step, -step, 2 * step, -2 * step)
    )
    first, second = (high - low) / (2 * step), (wide - narrow) / (4 * step)
    exact, resolved = (4 * first - second) / 3, 1e-12 / step * np.abs(high)
    return exact, np.minimum(np.abs(first - second), 1e-3 * np.abs(exact)) + resolved


def test_derivatives_of_a_guard_are_those_of_the_oscillator() -> None:
    """x'' = -4*x and the guard x*t - 1: its derivatives along the flow in closed form."""
    for model in both(PLANE.format("y", "-4*x + (1 if x*t >= 1 else 0)")):
        t, x, v = 0.7, 0.3, 1.1
        at = Point(t, [x, v], [0.0, 0.0], [], [])
        assert values(model, "guards", at) == pytest.approx([x * t - 1])
        assert values(model, "guard_rates", at) == pytest.approx([v * t + x])
        assert values(model, "guard_second", at) == pytest.approx([-4 * x * t + 2 * v])
        assert values(model, "guard_third", at) == pytest.approx([-4 * v * t - 12 * x])
        assert values(model, "guard_fourth", at) == pytest.approx([16 * x * t - 16 * v])
        assert values(model, "guard_gradients", at) == pytest.approx([t, 0.0])
        assert values(model, "guard_curves", at) == pytest.approx([1.0, t, v])


@pytest.mark.parametrize(
    ("of", "exact"),
    [
        ("rhs", [[0.0, 1.0, 0.0, 0.0], [-3.0, 0.0, -0.3, 0.0]]),
        ("guards", [[0.0, 0.0, -2.0, 1.0], [1.0, 0.0, 0.0, 0.0]]),
        ("guard_rates", [[0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
        ("resets", [[0.0, -3.0, -1.1, 0.0]]),
        ("outputs", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
        ("starts", [[0.0, 0.0, 6.0, 0.0], [0.0, 0.0, 0.0, 0.0]]),
        ("timed", [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -2.0, 0.0]]),
    ],
)
def test_every_function_has_derivatives_in_states_parameters_and_time(
    of: str, exact: list[list[float]]
) -> None:
    text = """
parameters: {k: 3}
blocks:
  x: {type: integrator, of: v, start: k*k}
  v: {type: integrator, of: a}
  a: {type: expression, formula: "-k*x + (1 if t - 2*k >= 0 else 0)"}
events:
  - {when: x, crosses: down, set: {v: -k*v}}
"""
    for model in both(text):
        name = model.derivative(of, ["x", "v", "k", "t"])
        assert model.derivative(of, ["x", "v", "k", "t"]) == name
        at = Point(0.5, [0.3, 1.1], [0.0] * 4, [3.0], [])
        c = called(model.routines.address("prepare"), model.routines.sizes.constants, x=at.p)
        size = 4 * len(exact)
        found = called(model.routines.address(name), size, at.t, at.x, at.m, c, at.k)
        assert found == pytest.approx([number for row in exact for number in row])


def test_a_jacobian_costs_what_it_has() -> None:
    model = compile(read_text(chain(150)))
    routine = model.routines.routine("jacobian")
    assert routine.size == 300 * 301
    assert len(routine.roots) == 150 + 150 * 3
    assert len(model.routines.machine_ir(["jacobian"])) < 300_000


# the addresses


def test_sizes_are_those_of_the_arrays() -> None:
    model = compile(read_text(BALL), backend="python")
    sizes = model.routines.sizes
    assert (sizes.states, sizes.modes, sizes.parameters) == (2, 1, 1)
    assert (sizes.outputs, sizes.timed, sizes.resets) == (2, 0, 1)


def test_constants_are_the_parameters_and_behind_them_what_is_made_of_them() -> None:
    text = one("-x*sqrt(k)/(1 + j)").replace("blocks:", "parameters: {k: 4, j: 1}\nblocks:")
    for model in both(text):
        c = values(model, "prepare", Point(0.0, [], [], [9.0, 2.0], []))
        assert c[:2] == [9.0, 2.0]
        assert sorted(c[2:]) == [3.0, 3.0]
        assert values(model, "rhs", Point(0.0, [1.0], [], [9.0, 2.0], [])) == [-1.0]


@pytest.mark.parametrize("backend", ["llvm", "quick", "python"])
def test_a_lazy_function_is_compiled_by_its_first_call(backend: str) -> None:
    model = compile(read_text(one("x*x*t")), backend=backend)  # type: ignore[arg-type]
    first = model.routines.address("jacobian")
    assert model.routines.address("jacobian") == first
    assert called(first, 2, 2.0, [3.0]) == [12.0, 9.0]
    direct = model.routines.address("jacobian")
    assert direct != first
    assert called(direct, 2, 2.0, [3.0]) == called(first, 2, 2.0, [3.0]) == [12.0, 9.0]
    assert model.routines.compiled_address("jacobian") == direct


def test_a_lazy_function_may_be_compiled_without_a_call() -> None:
    model = compile(read_text(one("x*x*t")))
    direct = model.routines.compiled_address("jacobian")
    assert model.routines.address("jacobian") == direct
    assert called(direct, 2, 2.0, [3.0]) == [12.0, 9.0]


def test_functions_that_are_compiled_together_are_those_that_are_compiled_alone() -> None:
    alone, together = (compile(read_text(one("x*x*t")), backend="quick") for _ in range(2))
    names = ["jacobian", "rhs", "guard_second", "jacobian"]
    found = together.routines.compiled_addresses(names)
    assert found == [together.routines.compiled_address(name) for name in names]
    assert called(found[0], 2, 2.0, [3.0]) == values_of(alone, "jacobian")
    assert called(found[1], 1, 2.0, [3.0]) == values_of(alone, "rhs") == [18.0]


def values_of(model: Model, name: str) -> list[float]:
    return called(model.routines.compiled_address(name), 2 if name == "jacobian" else 1, 2.0, [3.0])


def test_threads_may_ask_and_call_at_once() -> None:
    model = compile(read_text(chain(8)))
    at = random_point(model, 3)
    with ThreadPoolExecutor(8) as pool:
        names = ["rhs", "jacobian", "guard_second", "guard_curves"] * 4
        found = list(pool.map(lambda name: (name, tuple(values(model, name, at))), names))
    assert len(set(found)) == 4


def test_code_lives_as_long_as_its_model() -> None:
    model = compile(read_text(one("3*x")))
    address = model.routines.address("rhs")
    for number in range(native.CODE.kept + 3):
        compile(read_text(one(f"{number} + x"))).routines.address("rhs")
    assert called(address, 1, x=[2.0]) == [6.0]


def test_the_same_code_is_compiled_once() -> None:
    first, second = (compile(read_text(one("x*0.123 + t"))) for _ in range(2))
    assert first.routines.address("rhs") == second.routines.address("rhs")


def test_a_back_end_that_does_not_exist() -> None:
    with pytest.raises(OptionError, match=r"unknown backend 'lvm'.*Did you mean 'llvm'\?"):
        compile(read_text(BALL), backend="lvm")  # type: ignore[arg-type]


def test_a_derivative_that_many_places_share_is_written_by_a_loop() -> None:
    names = [f"x{i}" for i in range(12)]
    states = [f"  {name}: {{type: integrator, of: pull}}" for name in names]
    total = f"  s: {{type: sum, of: [{', '.join(names)}]}}"
    pull = "  pull: {type: expression, formula: sin(s)}"
    text = "\n".join(["span: [0, 1]", "blocks:", *states, total, pull, ""])
    machine, python = both(text)
    assert "@fill(" in machine.routines.machine_ir(["jacobian"])
    at = random_point(machine, 5)
    found = values(machine, "jacobian", at)
    assert bits(found) == bits(values(python, "jacobian", at))
    slope = pytest.approx(math.cos(sum(at.x)))
    assert found == [0.0 if i % 13 == 12 else slope for i in range(12 * 13)]


def test_a_sum_may_have_more_wires_than_python_nests() -> None:
    wires = ", ".join(["x", "-y"] * 1000)
    text = PLANE.format("s", "0") + f"  s: {{type: sum, of: [{wires}]}}\n"
    for model in both(text):
        at = Point(0.0, [3.0, 1.0], [], [], [])
        assert values(model, "rhs", at)[0] == 2000.0


@pytest.mark.parametrize("backend", ["llvm", "python"])
def test_all_signals_are_told_by_name_even_where_they_have_no_value(backend: str) -> None:
    text = PLANE.format("x/y", "table").replace("blocks:", "parameters: {k: 2}\nblocks:")
    text += "  table: {type: table, of: x, points: [[0, 1], [1, 3]]}\n"
    text += "  low: {type: expression, formula: log(k*x)}\n"
    model = compile(read_text(text), backend=backend)  # type: ignore[arg-type]
    table = np.array([1.0, 2.0, 0.0, 1.0, 1.0, 3.0, 2.0])
    names, found = model.all_signals(0.0, np.zeros(2), np.ones(2), np.array([2.0]), table)
    told = dict(zip(names, found, strict=True))
    assert told["low"] == -math.inf
    assert math.isnan(told["f"])
    assert math.isnan(told["x'"])
    assert told["y'"] == told["table"] == 1.0
