"""Every threshold of a trace is a field of its options: documented, read, and settable."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from show.traces import FOUND, TEXT
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DataError
from tracewire.residual import Measured
from tracewire.trace import CheckOptions, SearchOptions, SplitOptions, TraceOptions, trace
from tracewire.trace.limits import ROUNDING as ROUNDING_LIMITS
from tracewire.trace.saved import from_data, to_data
from tracewire.trace.trials.data_split import split_data

ROOM = Path(__file__).parents[2] / "solver/tracewire/trace"
OPTIONS = TraceOptions()
HOMES = ("options.py", "data_thresholds.py", "thresholds.py")
ROUNDING = 1e-6
"""A number that is not larger than this, or that near to 1, guards against rounding."""
# the other numbers with a name, none of which a physicist could want to be another one
FORMATS = {
    "saved.py": "the version of a file",
    "choose/horizons.py:REST": "a label",
    "units.py:SYMBOL_UNITS": "exponents of units",
    "units.py:RATE_OF_COORDINATE": "the same",
    "units.py:SECOND": "the same",
    "check/refusals.py:FACTORS": "between units",
    "check/outliers.py:BESIDE": "which samples a filter takes",
    "screen/screening.py:QUADRATURE": "0 and a quarter of a turn",
    "trials/phase_fit.py:TURN": "the angles of a turn",
}


def named_numbers(source: str) -> Iterator[tuple[str, bool]]:
    """The upper-case names of a module that are set to something with a number in it, and whether
    all of these only guard against rounding."""
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign):
            targets, value = node.targets, node.value
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            targets, value = [node.target], node.value
        else:
            continue
        inside = {id(n) for f in ast.walk(value) if isinstance(f, ast.Lambda) for n in ast.walk(f)}
        numbers = [
            n.value
            for n in ast.walk(value)
            if isinstance(n, ast.Constant) and type(n.value) in (int, float) and id(n) not in inside
        ]
        tiny = [0 < n <= ROUNDING for n in numbers]
        guards = any(tiny) and all(t or n == 1 for n, t in zip(numbers, tiny, strict=True))
        names = [n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)]
        yield from ((n, guards) for n in names if numbers and n.isupper())


def sources() -> dict[str, str]:
    return {
        file.relative_to(ROOM).as_posix(): file.read_text(encoding="utf-8")
        for file in sorted(ROOM.rglob("*.py"))
    }


def groups() -> list[type]:
    nested = (getattr(OPTIONS, field.name) for field in fields(OPTIONS))
    return [TraceOptions, *(type(value) for value in nested if is_dataclass(value))]


def test_no_threshold_stands_outside_of_the_options() -> None:
    found = {
        f"{file}:{name}"
        for file, source in sources().items()
        for name, guards in named_numbers(source)
        if file not in HOMES and not guards
    }
    allowed = {name for name in found if name in FORMATS or name.partition(":")[0] in FORMATS}
    assert found - allowed == set()
    met = allowed | {name.partition(":")[0] for name in allowed}
    assert set(FORMATS) - met == set(), "what is gone needs no exception"


def test_limits_of_rounding_are_no_thresholds() -> None:
    values = [value for name, value in vars(type(ROUNDING_LIMITS)).items() if name[0] != "_"]
    assert values
    assert [v for v in values if not (0 < v <= ROUNDING or 0 <= 1 - v <= 1.01 * ROUNDING)] == []


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("FAR = 30.0", [("FAR", False)]),
        ("NEAR, FAR = 3, (8, 9)", [("NEAR", False), ("FAR", False)]),
        ("FAR: float = 30.0", [("FAR", False)]),
        ("CLEAR = 1.0", [("CLEAR", False)]),
        ("SEEN = 1e-10", [("SEEN", True)]),
        ("COPY = 1 - 1e-6", [("COPY", True)]),
        ("LAW = lambda y: y**2", []),
        ("KIND = 'a trace'\nlower = 3\ndef f():\n    FAR = 3", []),
    ],
)
def test_a_named_number_is_found(source: str, found: list[tuple[str, bool]]) -> None:
    assert list(named_numbers(source)) == found


def test_every_threshold_says_what_it_is() -> None:
    silent = []
    for file in HOMES:
        for record in ast.parse((ROOM / file).read_text(encoding="utf-8")).body:
            body = record.body if isinstance(record, ast.ClassDef) else []
            for node, after in zip(body, [*body[1:], None], strict=False):
                told = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
                is_group = "field(" in ast.unparse(node)
                if isinstance(node, ast.AnnAssign) and not told and not is_group:
                    silent.append(ast.unparse(node.target))
    assert silent == []


def test_every_threshold_is_read() -> None:
    read = {
        node.attr
        for file, source in sources().items()
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Attribute) and file not in HOMES
    }
    assert {field.name for group in groups() for field in fields(group)} - read == set()


def test_thresholds_are_kept_in_a_saved_trace() -> None:
    asked = TraceOptions(search=SearchOptions(rivals=8))
    assert from_data(to_data(replace(FOUND, options=asked))).options == asked


def test_thresholds_that_are_set_are_those_of_the_trace() -> None:
    model = compile(read_text(TEXT))
    t = np.linspace(0.0, 6.0, 200)
    swing = Measured("swing", "train", t, {"theta": 0.3 * np.cos(3 * t)}, start={"theta": None})
    asked = TraceOptions(check=CheckOptions(least_samples=1000), split=SplitOptions(validated=0.5))
    with pytest.raises(DataError, match="At least 1000 are needed"):
        trace(model, [swing], options=asked)
    (section,) = split_data([swing], asked.split).validate
    assert (section.first, section.end) == (100, 200)
