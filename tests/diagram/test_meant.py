"""What a newcomer writes first is taken as it is meant, or answered with what to write instead."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import TracewireError
from tracewire.formula import to_text
from tracewire.solve import simulate

BALL = """\
span: [0, 10]
parameters: {limit: 1}
blocks:
  phi: {type: integrator, of: w, start: 2}
  w: {type: integrator, of: a}
  a: {type: gain, of: phi, k: -1}
"""


def refused(text: str) -> list[str]:
    with pytest.raises(TracewireError) as caught:
        compile(read_text(text, Path("a.yaml")))
    return str(caught.value).splitlines()


@pytest.mark.parametrize(
    ("when", "formula", "times"),
    [
        ("phi > limit", "phi - limit", [5.2360]),
        ("phi >= limit", "phi - limit", [5.2360]),
        ("phi < limit", "limit - phi", [1.0472, 7.3304]),
        ("limit > phi", "limit - phi", [1.0472, 7.3304]),
    ],
)
def test_a_comparison_happens_where_it_becomes_true(
    when: str, formula: str, times: list[float]
) -> None:
    """phi = 2 cos(t) passes 1 at pi/3, 5 pi/3 and 7 pi/3: down, up, down."""
    text = f"{BALL}  n: {{type: integrator, of: zero}}\n  zero: {{type: constant, value: 0}}\n"
    diagram = read_text(f"{text}events:\n  - {{when: {when}, set: {{n: n + 1}}}}\n", Path("a.yaml"))
    (event,) = diagram.events
    assert event.when is not None
    assert (to_text(event.when), event.crosses) == (formula, "up")
    run = simulate(compile(diagram))
    assert run.final["n"] == len(times)
    for number, time in enumerate(times):
        assert list(run["n"][abs(run.t - time) < 0.05][[0, -1]]) == [number, number + 1]


@pytest.mark.parametrize(
    ("when", "said"),
    [
        ("{when: phi > 1 and w > 0, set: {w: 0}}", "an event happens where one comparison"),
        ("{when: 0 < phi < 1, set: {w: 0}}", "an event happens where one comparison"),
        ("{when: phi > 1, crosses: down, set: {w: 0}}", "has no 'crosses'. Leave 'crosses' out"),
        ("{when: phi > psi, set: {w: 0}}", "unknown"),
    ],
)
def test_other_conditions_of_an_event_are_refused(when: str, said: str) -> None:
    (line,) = refused(f"{BALL}events:\n  - {when}\n")
    assert said in line


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("k: -1", "k: 30 deg", "a number in a formula has no unit. Write it as a value: "
         "{value: 30, unit: deg}."),
        ("k: -1", "k: 2*1.5mm", "{value: 1.5, unit: mm}"),
        ("k: -1", "k: max(limit, 2)", "between braces a comma ends the value of 'k'. "
         'Write k: "max(limit, 2)".'),
        ("k: -1", "k: max(min(limit, 2), 3), unit: m", 'Write k: "max(min(limit, 2), 3)".'),
        ("{limit: 1}", "{limit: 1}\nrequire: [max(limit, 2) > 1]", "between brackets a comma ends "
         'an entry. Write "max(limit, 2) > 1".'),
        ("limit: 1", "limit: .nan", "'limit' is .nan, and a value is a finite number. Write a "
         "number for 'limit'."),
        ("k: -1", "k: -.INF", "'k' is -.INF, and a value is a finite number. Write a number"),
        ("[0, 10]", "[0, .inf]", "an entry of this list is .inf, and a value is a finite number."),
        ("limit: 1", "limit: {value: 1, fit: [0, .inf]}", "a bound of a fit may be inf or -inf."),
        ("limit: 1", "limit: nan", "unknown parameter 'nan'; there are: limit. A value is a finite "
         "number: write one."),
        ("limit: 1", "limit: yes", "unknown parameter 'yes'; there are: limit. A value is a "
         "number: write 1."),
        ("limit: 1", "limit: Off", "A value is a number: write 0."),
        ("limit: 1", "limit: ~", "'limit' has no value. Write a value behind the colon"),
        ("limit: 1", "limit: {value: 1, fit: [0, 010]}", "must be a number, not '010'. Write 10."),
        ("limit: 1", "limit: {value: 1, fit: [0, yes]}", "must be a number, not 'yes'. A value is"),
        ("limit: 1", "limit: {value: 1, fit: [0, '1,5']}", "Write 1.5: a point stands before"),
        ("limit: 1", "limit: {value: 1, fit: [0, 1,5]}", "the bounds of a fit are two numbers. "
         "Write fit: [low, high] in the unit of the value, or fit: free. A decimal has a point"),
        ("[0, 10]", "[0, 1,5]", "Write it like [0, 40]. A decimal has a point: 1.5."),
        ("  phi:", "\tphi:", "a.yaml:4:1: a tab stands where YAML needs blanks. Indent with"),
        ("start: 2", "start: 1,5", "of 'start'. Write start: 1.5: a point stands before"),
        ("limit: 1", "limit: '1,5'", "a comma is no decimal point. Write 1.5"),
        ("limit: 1", "limit: 010", "a number has zeros in front. Write 10."),
        ("limit: 1", "limit: {value: 20, unit: degC}", "A temperature is in K: 20 degC are"),
        ("limit: 1", "limit: {value: 20, unit: °C}", "A temperature is in K: 20 degC are"),
        ("{limit: 1}", "{limit: 1, def: 2}", "'def' is a word of formulas: choose another one, "
         "such as def_1."),
        ("{limit: 1}", "{limit: 1, __a: 2}", "Use the letters a to z, digits and _"),
    ],
)  # fmt: skip
def test_what_is_meant_is_said_in_one_line(old: str, new: str, said: str) -> None:
    (line,) = refused(BALL.replace(old, new))
    assert said in line


@pytest.mark.parametrize("name", ["φ", "Größe", "my angle"])
def test_a_name_that_cannot_be_is_told_once(name: str) -> None:
    text = BALL.replace("phi:", f"{name}:").replace("of: phi", f"of: {name}")
    (line,) = refused(text)
    assert f"'{name}' cannot be the name of a block. Use the letters a to z" in line
    assert ("'label: " in line) == (" " not in name)


def test_a_number_that_is_no_unit_s_is_no_unit() -> None:
    (line,) = refused(BALL.replace("k: -1", "k: 2 limit"))
    assert "it does not parse" in line


def test_formulas_that_commas_have_cut_are_all_told_with_what_else_is_wrong() -> None:
    text = """\
blocks:
  x: {type: integrator, of: y, start: 1}
  y: {type: expression, formula: max(x, 0)}
  z: {type: expression, formula: min(x, max(1, q)), unit: m}
  s: {type: sum, of: [y, nobody]}
require: [max(1, 2) > 1]
"""
    lines = refused(text)
    assert [line.split(": ", 1)[0].split(":")[-2] for line in lines] == ["3", "4", "4", "5", "6"]
    assert "unknown signal or parameter 'q'" in lines[2], "the whole formula is read"
    assert "unknown signal 'nobody'" in lines[3]
