"""What an editor proposes at a cursor, from the reader's keys and the names of the diagram."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagram.whole import WHOLE
from tracewire.diagram import complete, read_text, word_before
from tracewire.library import load_library
from tracewire.shipped import shipped

LIBRARY = load_library()
DIAGRAM = read_text(WHOLE, Path("a.yaml"))


def proposed(before: str) -> list[str]:
    return [one.text for one in complete(before, LIBRARY, DIAGRAM)]


def test_sections() -> None:
    assert proposed("")[:3] == ["title", "extends", "remove"]
    assert proposed("title: a\nre") == ["remove", "record", "require", "presets", "measured"]
    assert "title" not in proposed("title: a\n")
    (span,) = complete("sp", LIBRARY)[:1]
    assert (span.insert, span.doc) == ("span: ", "Begin and end of a run in s: [0, 40].")


@pytest.mark.parametrize(
    ("before", "first"),
    [
        ("blocks:\n  a: {type: integ", ["integrator"]),
        ("blocks:\n  a:\n    type: hin", ["hinge"]),
        ("blocks:\n  a: {type: gain, ", ["of", "k", "unit", "label", "guess"]),
        ("blocks:\n  a: {type: hinge, ", ["rate", "slip", "width", "unit"]),
        ("blocks:\n  a:\n    type: sum\n    ", ["of", "unit", "label", "place", "guess"]),
        ("blocks:\n  a: {", ["type", "unit", "label", "guess"]),
        ("blocks:\n  theta: {s", ["start"]),
        ("blocks:\n  a: {type: gain, of: th", ["theta"]),
        ("blocks:\n  a: {type: sum, of: [theta, -co", ["column"]),
        ("blocks:\n  a:\n    type: sum\n    of:\n      - theta\n      - to", ["torque"]),
        ("blocks:\n  a: {type: gain, k: ha", ["half"]),
        ("blocks:\n  a: {type: gain, k: -2*ha", ["half"]),
        ('blocks:\n  a: {type: expression, formula: "min(theta, om', ["omega"]),
        ("blocks:\n  a: {type: gain, k: 1}\n  b: {type: gain, of: hinge.", ["hinge.torque"]),
        ("blocks:\n  a: {type: integrator, start: {value: 1, ", ["unit", "fit"]),
        ("blocks:\n  a: {type: integrator,   # why\n    of: om", ["omega"]),
        ("parameters:\n  k: {value: 1, f", ["fit"]),
        ("parameters:\n  k:\n    ", ["value", "unit", "fit"]),
        ("parameters:\n  k: {value: 1, fit: f", ["free"]),
        ("record: [theta, hi", ["hinge", "hinge.slide"]),
        ("record:\n  - om", ["omega"]),
        ("record: [hinge.t", ["hinge.torque", "hinge.total"]),
        ("events:\n  - {when: theta, cr", ["crosses"]),
        ("events:\n  - when: theta\n    crosses: u", ["up"]),
        ("events:\n  - when: theta\n    set: {om", ["omega"]),
        ("presets:\n  a: {ha", ["half"]),
        ("presets:\n  a: {hinge.s", ["hinge.slip"]),
        ("measured:\n  r:\n    sig", ["signals"]),
        ("measured:\n  r:\n    signals: {th", ["theta"]),
        ("measured:\n  r:\n    signals:\n      theta: {column: a, si", ["sigma"]),
        ("measured:\n  r: {use: g", ["gate"]),
        ("measured:\n  r: {clean: [{lo", ["lowpass"]),
        ("measured:\n  r: {clean: [{lowpass: {cut", ["cutoff"]),
        ("measured:\n  r: {preset: p", ["printed"]),
        ("measured:\n  r: {inputs: {dr", ["drive"]),
        ("scene:\n  - ", ["rod", "spring", "disc"]),
        ("scene:\n  - rod: {from: [0, 0], ", ["to", "color"]),
        ("scene:\n  - rod: {from: [sin(th", ["theta"]),
        ("scene:\n  - rod: {color: o", ["orange"]),
        ("subsystems:\n  hinge:\n    eff", ["effect"]),
        ("subsystems:\n  hinge:\n    blocks:\n      total: {formula: sl", ["slide", "slip"]),
        ("subsystems:\n  hinge:\n    effect:\n      coefficient: w", ["width"]),
        ("span: [0, ha", ["half"]),
    ],
)  # fmt: skip
def test_what_comes_first(before: str, first: list[str]) -> None:
    found = proposed(before)
    assert sorted(found[: len(first)]) == sorted(first)


CART = """
parameters: {law: 1}
subsystems:
  friction:
    inputs: [rate]
    outputs: {force: drag}
    variants:
      viscous: {blocks: {drag: {type: viscous, rate: rate, c: 1}}}
      dry: {blocks: {drag: {type: coulomb, rate: rate, level: 1}}}
blocks:
  v: {type: integrator, of: drag}
  drag: {type: friction, rate: v, variant: dry}
"""


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("drag: {type: friction, variant: ", ["viscous", "dry", "law"]),
        ("drag: {variant: d", ["dry"]),
        ("other: {type: friction, rate: v, variant: v", ["viscous"]),
        ("v: {type: integrator, variant: ", []),
    ],
)
def test_the_bodies_of_a_subsystem_are_proposed(line: str, names: list[str]) -> None:
    before = CART[: CART.index("  v: {type")] + "  " + line
    assert [one.text for one in complete(before, LIBRARY, read_text(CART))] == names


@pytest.mark.parametrize(
    "before",
    [
        "# of",
        "title: a  # sp",
        "title: th",
        "blocks:\n  # ty",
        "title: |\n  sp",
        "parameters: {th",
        "blocks:\n  a: {type: gain, off: th",
        "unknown:\n  th",
    ],
)
def test_nothing_is_proposed_where_a_text_is_free(before: str) -> None:
    assert proposed(before) == []


def test_a_section_behind_a_text_block() -> None:
    assert proposed("title: |\n  one\nsp") == ["span"]


def test_the_word_that_is_replaced() -> None:
    assert word_before("blocks: {a: {type: gain, k: -2*hinge.sl") == "hinge.sl"
    assert word_before("record: [theta, ") == ""


def test_blocks_and_keys_need_no_diagram() -> None:
    names = [one.text for one in complete("blocks: {a: {type: vis", LIBRARY)]
    assert names[0] == "viscous"
    assert complete("blocks: {a: {type: gain, of: th", LIBRARY) == []


def test_every_place_of_every_line_can_be_asked() -> None:
    """At each character of diagrams, and where one is missing, an answer comes."""
    text = (shipped("diagrams") / "demo" / "full.yaml").read_text("utf-8")
    for source in (WHOLE, text.replace("}", "").replace('"', "")):
        for at in range(0, len(source), 3):
            complete(source[:at], LIBRARY, DIAGRAM)


def test_what_the_text_goes_on_with_is_among_what_is_proposed() -> None:
    """Keys and signals of the whole diagram are proposed where they stand."""
    for at, name in (
        (WHOLE.index("require:"), "require"),
        (WHOLE.index("rate: omega, slip"), "rate"),
        (WHOLE.index("slip: 2*k"), "slip"),
        (WHOLE.index('hinge.torque, "q[0]'), "hinge.torque"),
        (WHOLE.index("coefficient"), "coefficient"),
        (WHOLE.index("detrend: theta"), "detrend"),
    ):
        assert name in [p.text for p in complete(WHOLE[:at], LIBRARY, DIAGRAM)], name
