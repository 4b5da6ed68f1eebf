"""Remarks on models: forces that push on are told, and what is wired well has none."""

from __future__ import annotations

from pathlib import Path

import pytest
from solve.models import made
from tracewire.compile import compile
from tracewire.compile.remarks import remarks_of
from tracewire.diagram import read, read_text
from tracewire.shipped import shipped
from tracewire.solve import parameter_values

PAIR = """
span: [0, 10]
parameters: {{k: {k}, gear: -3, m: 2}}
blocks:
  x: {{type: integrator, of: v, start: 1}}
  v: {{type: integrator, of: a}}
  y: {{type: integrator, of: w}}
  w: {{type: integrator, of: b}}
  apart: {{type: sum, of: [x, -y]}}
  turned: {{type: gain, of: y, k: gear}}
  tie: {{type: stiffness, of: apart, k: k}}
  hold: {{type: {hold}}}
  pull: {{type: stiffness, of: turned, k: 5}}
  on_x: {{type: sum, of: [{on_x}]}}
  on_y: {{type: sum, of: [{on_y}]}}
  geared: {{type: gain, of: pull, k: gear}}
  a: {{type: gain, of: on_x, k: 1/m}}
  b: {{type: expression, formula: "{b}"}}
"""
WELL = {
    "k": "4",
    "hold": "viscous, rate: v, c: 1",
    "on_x": "tie, hold",
    "on_y": "-tie, geared",
    "b": "on_y/m",
}


def told(**changes: str) -> list[str]:
    model = made(PAIR.format(**(WELL | changes)))
    return remarks_of(model, parameter_values(model, {}))


def test_two_bodies_on_springs_and_a_gear_are_in_order() -> None:
    """The spring between them acts on the second with a minus; the gear turns two signs round."""
    assert told() == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"on_x": "-tie, hold"}, "'tie' pushes 'v' on: a stiffness acts against 'x' by itself"),
        ({"on_y": "tie, geared"}, "'tie' pushes 'w' on: a stiffness acts against 'y' by itself"),
        ({"on_x": "tie, -hold"}, "'hold' pushes 'v' on: a viscous acts against 'v' by itself"),
        ({"on_y": "-tie, -geared"}, "'pull' pushes 'w' on: a stiffness acts against 'y'"),
        ({"b": "-on_y/m"}, "'tie' pushes 'w' on"),
        ({"hold": "dry_friction, rate: v, slip: 1, stick: 2", "on_x": "tie, -hold"},
         "'hold' pushes 'v' on: a dry_friction acts against 'v' by itself"),
    ],
)  # fmt: skip
def test_a_force_with_the_wrong_sign_is_told(changes: dict[str, str], said: str) -> None:
    assert said in told(**changes)[0]


def test_a_spring_that_is_meant_to_push_is_not_told() -> None:
    """A negative stiffness is given as such, that of a buckled beam."""
    assert told(k="-4") == []


@pytest.mark.parametrize(
    ("read", "is_told"),
    [("hold**2", True), ("sin(hold)", True), ("hold*v", False), ("3*hold - x**2", False),
     ("abs(hold)", False), ("min(hold, 0.4)", False), ("tie**2", False)],
)  # fmt: skip
def test_what_a_held_friction_bends_is_told(read: str, is_told: bool) -> None:
    heat = f"coulomb, rate: v, level: 1}}\n  heat: {{type: expression, formula: '{read}'"
    found = told(hold=heat)
    assert [text[:41] for text in found] == is_told * ["'heat' is a nonlinear function of 'hold':"]


SHIPPED = [
    file
    for folder in ("demo", "papers")
    for file in sorted((shipped("diagrams") / folder).rglob("*.yaml"))
    if "\nblocks:" in file.read_text(encoding="utf-8")
]


def test_a_free_parameter_that_nothing_reads_is_told() -> None:
    text = """
    parameters:
      k: {value: 1, fit: [0, 9]}
      own: {value: 2, fit: [0, 9]}
      dead: {value: 3, fit: [0, 9]}
      half: own/2
    blocks:
      x: {type: integrator, of: v, start: half}
      v: {type: gain, of: x, k: -k}
    """
    model = compile(read_text(text))
    assert remarks_of(model, parameter_values(model, {})) == [
        "'dead' is free in a fit, and nothing reads it: use it, or remove it"
    ]


@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: f"{file.parent.name}-{file.stem}")
def test_no_shipped_diagram_has_a_remark(file: Path) -> None:
    model = compile(read(file))
    assert remarks_of(model, parameter_values(model, {})) == []


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "{type: drive_quantiser, of: u, share: 1, step: 0.45}",
            "'u' is shown in bar, and the step 0.45 of 'a' counts in SI, as 4.5e-06 bar: write "
            "{value: 0.45, unit: bar}, if that is meant",
        ),
        ("{type: drive_saturation, of: u, share: 1, limit: most}", "and the limit 2 of 'a' counts"),
        ("{type: barrier, of: x, k: 10, gap: 20}", "'x' is shown in mm, and the gap 20 of 'a'"),
        ("{type: drive_quantiser, of: u, share: 1, step: {value: 0.45, unit: bar}}", ""),
        ("{type: drive_quantiser, of: u, share: 1, step: 45000}", ""),
        ("{type: drive_quantiser, of: u, share: 1, step: 0}", ""),
        ("{type: barrier, of: x, k: 10, gap: 0.02}", ""),
        ("{type: barrier, of: v, k: 10, gap: 20}", ""),
    ],
)
def test_a_number_in_si_that_is_compared_with_a_signal_in_another_unit_is_told(
    line: str, said: str
) -> None:
    model = made(
        "inputs: {u: {unit: bar, default: 0}}\nparameters: {most: 2}\nblocks:\n"
        "  x: {type: integrator, of: v, unit: mm}\n  v: {type: integrator, of: a}\n"
        f"  a: {line}\n"
    )
    found = remarks_of(model, parameter_values(model, {}))
    assert len(found) == bool(said)
    assert said in "".join(found)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("{type: constant, value: 5, unit: bar}", "its value 5 counts in SI, as 5e-05 bar"),
        (
            "{type: constant, value: 30, unit: deg}",
            "'a' is shown in deg, and its value 30 counts in SI, as 1718.87 deg: write "
            "{value: 30, unit: deg}, if that is meant",
        ),
        ("{type: step, at: 1, height: 5, unit: mm}", "'a' is shown in mm, and its height 5 counts"),
        ("{type: constant, value: {value: 30, unit: deg}, unit: deg}", ""),
        ("{type: constant, value: 0, unit: deg}", ""),
        ("{type: constant, value: 0.5, unit: deg}", ""),
        ("{type: constant, value: 30, unit: rad}", ""),
        ("{type: constant, value: pi/6, unit: deg}", ""),
        ("{type: step, at: 1, height: {value: 5, unit: mm}, unit: mm}", ""),
    ],
)
def test_a_number_in_si_beside_a_unit_that_is_not_is_told(line: str, said: str) -> None:
    model = made(f"blocks:\n  a: {line}\n")
    found = remarks_of(model, parameter_values(model, {}))
    assert len(found) == bool(said)
    assert said in "".join(found)
