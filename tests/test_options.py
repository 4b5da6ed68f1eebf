"""Options as dictionaries: wherever a record of options is taken, and what is said of others."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pytest
import tracewire as tw
from solve.models import BALL
from tracewire.errors import OptionError
from tracewire.options import options_of
from tracewire.trace.thresholds import SearchOptions


@dataclass(frozen=True)
class Inner:
    size: float = 1.0


@dataclass(frozen=True)
class Outer:
    names: tuple[str, ...] = ()
    Count: int = 3
    inner: Inner = field(default_factory=Inner)


def test_a_dictionary_is_a_record() -> None:
    given = {"names": ["a", "b"], "Count": 5, "inner": {"size": 2.0}}
    assert options_of(Outer, given, "x") == Outer(("a", "b"), 5, Inner(2.0))
    assert options_of(Outer, None, "x") == Outer()
    assert options_of(Outer, {"inner": Inner(4)}, "x") == Outer(inner=Inner(4))
    record = Outer()
    assert options_of(Outer, record, "x") is record


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"nams": []}, "unknown option of a search 'nams'; there are: Count, inner, names. Did you "
         "mean 'names'?"),
        ({"count": 5}, "Write 'Count'."),
        ({"inner": {"siz": 5}}, "unknown option of a search, inner 'siz'; there are: size."),
        ({"limit": 5}, "'limit' is no option of a search. It is an argument: limit=..."),
        ([1], "the options of a search are a list. Give a dictionary, or Outer(...)."),
        ({1: 5}, "unknown option of a search '1'"),
    ],
)  # fmt: skip
def test_what_is_no_option_is_told(given: Any, message: str) -> None:
    with pytest.raises(OptionError) as caught:
        options_of(Outer, given, "a search", ("limit",))
    assert message in str(caught.value)


def test_all_wrong_names_are_told_at_once() -> None:
    with pytest.raises(OptionError) as caught:
        options_of(Outer, {"a": 1, "limit": 2, "inner": {"b": 1}}, "a search", ("limit",))
    assert len(caught.value.problems) == 3


def test_each_function_takes_a_dictionary() -> None:
    model = tw.compile(tw.read_text(BALL))
    with pytest.raises(OptionError, match=r"unknown option of a trace 'efects'.*'effects'"):
        tw.trace(model, options={"efects": 2})
    with pytest.raises(OptionError, match=r"'method' is no option of a fit\. It is an argument"):
        tw.fit(model, measured(), options={"method": "least_squares"})
    with pytest.raises(OptionError, match=r"unknown option of limits of a run 'second'"):
        tw.simulate(model, limits={"second": 2})
    with pytest.raises(OptionError, match=r"unknown option of a section 'perod'.*'period'"):
        tw.section(model, {"perod": 2})
    assert tw.simulate(model, limits={"seconds": 60}, span=(0, 0.1)).t[-1] == 0.1
    assert options_of(tw.TraceOptions, {"search": {"rivals": 8}}, "a trace") == tw.TraceOptions(
        search=SearchOptions(rivals=8)
    )


def measured() -> list[tw.Measured]:
    return [tw.Measured("bench", "train", [0, 0.1, 0.2], {"x": [1, 1, 1]})]
