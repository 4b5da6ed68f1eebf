"""A wrong argument of a public function is told in words, before the function runs."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
import pytest
import tracewire as tw
from tracewire.errors import OptionError

TEXT = """
title: Mass
span: [0, 1]
parameters: {k: 4, c: 0.1}
record: [x]
inputs: {u: {default: 0}}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  a: {type: expression, formula: u - k*x - c*v}
"""
DIAGRAM = tw.read_text(TEXT)
MODEL = tw.compile(DIAGRAM)
RUN = tw.simulate(MODEL)
loose: Any = tw  # to give what the annotations do not allow
UNCHECKED = {"fminsearch", "optimset"}
"""Functions with the manners of another tool."""


def test_all_public_functions_look_at_their_arguments() -> None:
    functions = {name: f for name in tw.__all__ if inspect.isroutine(f := getattr(tw, name))}
    assert {name for name, f in functions.items() if not hasattr(f, "__wrapped__")} == UNCHECKED
    for function in functions.values():
        assert get_type_hints(function)  # all names in it are known when it runs


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"parameters": {"k": "x"}}, "parameters['k'] is 'x', and not a number. Write parameters={"),
    ({"parameters": {"k": np.array([1, 2])}}, "parameters['k'] is array([1, 2]), and not a number"),
    ({"parameters": {"k": None}}, "parameters['k'] is None, and not a number"),
    ({"parameters": {"k": 1j}}, "parameters['k'] is 1j, and not a number"),
    ({"parameters": {1: 2.0}}, "parameters has 1, and not a text, for a name"),
    ({"parameters": 3}, "parameters is 3, and not a dictionary of numbers. Write parameters={"),
    ({"parameters": [("k", 1)]}, "parameters is [('k', 1)], and not a dictionary of numbers"),
    ({"start": {"x": "a"}}, "start['x'] is 'a', and not a number"),
    ({"span": 5}, "span is 5, and not two numbers. Write span=(0, 10)"),
    ({"span": (0, 1, 2)}, "span is (0, 1, 2), and not two numbers"),
    ({"span": "ab"}, "span is 'ab', and not two numbers"),
    ({"times": "x"}, "times is 'x', and not an array of numbers"),
    ({"times": [[1, 2], [3]]}, "times is [[1, 2], [3]], and not an array of numbers"),
    ({"every": "x"}, "every is 'x', and not a number"),
    ({"rtol": None}, "rtol is None, and not a number"),
    ({"atol": {"x": "a"}}, "atol['x'] is 'a', and not a number"),
    ({"method": 3}, "method is 3, and not a text"),
    ({"preset": ["a"]}, "preset is ['a'], and not a text"),
    ({"inputs": {"u": 1}}, "inputs['u'] is 1, and not 2 values. Write inputs={"),
    ({"limits": {"seconds": "x"}}, "limits['seconds'] is 'x', and not a number"),
    ({"progress": 3}, "progress is 3, and not a function"),
    ({"sensitivities": "k"}, "sensitivities is 'k', and not a list of texts. Write sensit"),
]


@pytest.mark.parametrize(("given", "said"), WRONG)
def test_an_option_of_a_run_of_another_kind(given: dict[str, Any], said: str) -> None:
    with pytest.raises(OptionError) as caught:
        tw.simulate(MODEL, **given)
    assert f"simulate: {said}" in str(caught.value)
    if "progress" not in given and "sensitivities" not in given:
        with pytest.raises(OptionError) as caught:
            tw.simulate_many(MODEL, [{"k": 1}], **given)
        assert f"simulate_many: {said}" in str(caught.value)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: loose.compile("a.yaml"), "diagram is 'a.yaml', and not a diagram. Read it first:"),
        (lambda: tw.compile(DIAGRAM, record="x"), "record is 'x', and not a list of texts"),
        (lambda: loose.save(RUN, "a.json"), "found is a Run, and not a trace. Make one: tracewire"),
        (lambda: loose.simulate(DIAGRAM), "model is a Diagram, and not a model. Make one: trace"),
        (lambda: loose.fit(None), "model is None, and not a model"),
        (lambda: loose.fit(MODEL, 3), "measured is 3, and not a list of measured series. Load"),
        (lambda: loose.trace(RUN), "subject is a Run, and not a model or a fit"),
        (lambda: tw.sweep(MODEL, {"k": "x"}, ["end(x)"]), "grid['k'] is 'x', and not an array of"),
        (lambda: tw.sweep(MODEL, {"k": [1]}, "end(x)"), "outputs is 'end(x)', and not a list of"),
        (lambda: loose.simulate_many(MODEL, 3), "rows is 3, and not a list of values or a dict"),
        (lambda: loose.simulate_many(MODEL, [{"k": "x"}]), "rows[0]['k'] is 'x', and not a number"),
        (lambda: loose.floquet(MODEL, None), "period is None, and not a number or a text"),
        (lambda: loose.steady_state(MODEL, guess=3), "guess is 3, and not a dictionary of numbers"),
        (lambda: loose.growth_rate(MODEL, "x"), "run is a Model, and not a run. Make one: trace"),
        (lambda: loose.spectrum(RUN, 3), "signal is 3, and not a text"),
        (lambda: loose.read(3), "path is 3, and not a path"),
        (lambda: loose.report(MODEL), "subject is a Model, and not a run or a fit or a trace"),
        (lambda: loose.present(3), "result is 3, and not a result. Give what"),
    ],
)  # fmt: skip
def test_an_argument_of_another_kind(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(OptionError) as caught:
        call()
    assert said in str(caught.value)


def test_values_of_options_are_told_also_inside() -> None:
    for options, said in (
        ({"only": 3}, "trace: only is 3, and not a list of texts"),
        ({"search": 3}, "trace: search is 3, and not SearchOptions(...)"),
    ):
        with pytest.raises(OptionError) as caught:
            tw.trace(MODEL, options=options)
        assert said in str(caught.value)


def test_all_that_is_a_number_or_a_list_is_taken() -> None:
    for one in (2, 2.0, True, np.float32(2), np.int64(2), np.array(2.0), Fraction(2)):
        assert tw.simulate(MODEL, parameters={"k": one}).parameters["k"] == float(one)
    for times in ([0, 1], (0.0, 1.0), np.arange(2), range(2)):
        assert len(tw.simulate(MODEL, times=times).t) == 2
    assert loose.simulate(MODEL, span=np.array([0, 2])).t[-1] == 2
    held = tw.Held(np.array([0.0, 1.0]), np.array([1.0, 2.0]))
    for given in (held, ([0, 1], [1, 2]), [np.arange(2), np.arange(2)]):
        loose.simulate(MODEL, inputs={"u": given})
    for record in (["v"], ("v",), {"v"}, {"v": 1}.keys(), (name for name in ["v"])):
        assert "v" in loose.compile(DIAGRAM, record=record).recorded


def test_what_is_missing_or_too_much_is_told_by_python() -> None:
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'model'"):
        loose.simulate()
    with pytest.raises(TypeError, match="unexpected keyword argument 'spam'"):
        loose.fit(MODEL, spam=3)


def test_the_function_keeps_its_signature_and_its_words(tmp_path: Path) -> None:
    assert "parameters" in inspect.signature(tw.simulate).parameters
    assert (tw.simulate.__doc__ or "").startswith("Simulate a model")
    assert tw.write(DIAGRAM, tmp_path / "a.yaml") == tmp_path / "a.yaml"
