"""Every shipped block with random legal parameters runs to finite values, or is refused in words.

EXPLORE=300 make test ARGS=tests/library/test_any_parameters.py tries so many settings of each.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from library.values import library
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import TracewireError
from tracewire.library import Block, Parameter
from tracewire.solve import Limits, simulate

LIMITS = Limits(steps=20_000, events=5_000, seconds=20.0)
EXPLORED = int(os.environ.get("EXPLORE", "0"))
SETTINGS = settings(
    max_examples=EXPLORED or 2,
    derandomize=not EXPLORED,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
WIRES = ("wave", "jumps", "nothing", "x", "v", "t_now")
DIAGRAM = """
span: [0, 2]
record: [x, v, force]
blocks:
  t_now: {{type: time}}
  wave: {{type: sine, amplitude: {size}, omega: {frequency}}}
  jumps: {{type: square, amplitude: {size}, frequency: {frequency}, phase: 1}}
  nothing: {{type: constant, value: 0}}
  x: {{type: integrator, of: v, start: {start}}}
  v: {{type: integrator, of: force, start: {rate}}}
  force: {{type: sum, of: [wave, {first}]}}
  block: {{type: {name}, {settings}}}
"""
Draw = Callable[[st.SearchStrategy[Any]], Any]


def sizes(low: float = 1e-6, high: float = 1e6) -> st.SearchStrategy[float]:
    """Sizes of all orders alike."""
    orders = st.floats(np.log10(low), np.log10(high))
    return orders.map(lambda order: float(f"{10.0**order:.6g}"))


def numbers(parameter: Parameter) -> st.SearchStrategy[float]:
    """The legal values of a parameter: of usual sizes, at its bounds, and extreme."""
    low = -np.inf if parameter.low is None else parameter.low
    low = low if parameter.above is None else max(low, parameter.above)
    high = np.inf if parameter.high is None else parameter.high
    odd = [0.0, 1.0, -1.0, 1e-300, 1e300, 1e-12, 1e12, low, high]
    legal = [x for x in odd if low <= x <= high and np.isfinite(x) and x != parameter.above]
    plain = sizes() | sizes().map(lambda x: -x)
    if np.isfinite(low) and np.isfinite(high):
        plain = st.floats(low, high, exclude_min=parameter.above is not None)
    elif np.isfinite(low):
        plain = sizes().map(lambda x: low + x)
    return st.one_of(plain, plain, plain, st.sampled_from(legal))


def lists(count: int) -> st.SearchStrategy[str]:
    """Numbers as a list of a diagram."""
    plain = sizes(1e-2, 1e2) | sizes(1e-2, 1e2).map(lambda x: -x)
    return st.lists(plain, min_size=count, max_size=count).map(str)


def matrices(rows: int, columns: int) -> st.SearchStrategy[str]:
    return st.lists(lists(columns), min_size=rows, max_size=rows).map(lambda x: f"[{', '.join(x)}]")


def ascending(count: int) -> st.SearchStrategy[list[float]]:
    steps = st.lists(sizes(1e-2, 1e2), min_size=count, max_size=count)
    return steps.map(lambda x: [float(f"{total:.6g}") for total in np.cumsum(x)])


def pairs(low: float) -> st.SearchStrategy[str]:
    """A table of points."""
    values = st.lists(sizes(1e-2, 1e2), min_size=4, max_size=4)
    both = st.tuples(ascending(4), values)
    return both.map(lambda xy: str([[x, y + low] for x, y in zip(*xy, strict=True)]))


STATE_SPACE = {"A": matrices(2, 2), "B": matrices(2, 1), "C": matrices(1, 2)}
LISTS: dict[str, dict[str, st.SearchStrategy[str]]] = {
    "transfer_function": {"numerator": lists(2), "denominator": lists(3)},
    "discrete_transfer_function": {"numerator": lists(2), "denominator": lists(3)},
    "state_space": STATE_SPACE,
    "discrete_state_space": STATE_SPACE,
    "multisine": {"frequencies": lists(3), "phases": lists(3), "amplitude": lists(3)},
    "maxwell_slip": {
        "k": st.lists(sizes(), min_size=3, max_size=3).map(str),
        "level": st.lists(sizes(), min_size=3, max_size=3).map(str),
    },
    "signal_builder": {"times": ascending(4).map(str), "values": lists(4)},
    "lookup_table_2d": {
        "rows": ascending(2).map(str), "columns": ascending(3).map(str), "values": matrices(2, 3)
    },
    "prbs": {"register": st.just("[1, 0, 0, 1]"), "tap": st.just("1")},
    "matrix_gain": {"matrix": matrices(2, 2)},
    "expression": {"formula": st.sampled_from(["x/v", "sqrt(x)", "log(wave)", "v**x"])},
    "demux": {"index": st.just("1")},
    "solve": {
        "matrix": lists(2).map(lambda row: f"[{row}, [x, v]]"), "right": lists(2)
    },
}  # fmt: skip
VECTORS = ("demux", "total", "dot", "matrix_gain")


@st.composite
def diagrams(draw: Draw, block: Block) -> str:
    """A diagram with a block between waves, jumps and a body that the block moves."""
    parts = []
    for port in block.inputs:
        wire = draw(st.sampled_from(WIRES))
        if block.name in VECTORS:
            wire = "pair"
        if port.default is None or draw(st.booleans()):
            parts.append(f"{port.name}: [{wire}, wave]" if port.many else f"{port.name}: {wire}")
    special = LISTS.get(block.name, {})
    for parameter in block.parameters:
        if parameter.name in special:
            parts.append(f"{parameter.name}: {draw(special[parameter.name])}")
        elif parameter.kind == "points":
            parts.append(f"{parameter.name}: {draw(pairs(parameter.low or 0.0))}")
        elif parameter.default is None or draw(st.booleans()):
            parts.append(f"{parameter.name}: {draw(numbers(parameter))!r}")
    first = f"block.{block.outputs[0].name}" if len(block.outputs) > 1 else "block"
    text = DIAGRAM.format(
        name=block.name, settings=", ".join(parts), first=first,
        size=draw(sizes(1e-3, 1e3)), frequency=draw(sizes(1e-2, 1e2)),
        start=draw(st.sampled_from([0.0, 1.0, -3.0])), rate=draw(st.sampled_from([0.0, 2.0, -1.0])),
    )  # fmt: skip
    if block.name in VECTORS:
        text += "  pair: {type: mux, of: [x, wave]}\n"
    if block.name in ("mux", "matrix_gain", "solve"):
        text = text.replace("of: [wave, block]", "of: [wave, 'block[1]']")
    return text


@pytest.mark.parametrize("name", library().families)
def test_a_block_with_any_legal_parameters_runs_or_is_refused(name: str) -> None:
    @SETTINGS
    @given(diagrams(library()[name]))
    def tried(text: str) -> None:
        try:
            run = simulate(compile(read_text(text), backend="quick"), limits=LIMITS)
        except TracewireError:
            return
        for signal in run.signals:
            assert np.isfinite(run[signal]).all()

    tried()
