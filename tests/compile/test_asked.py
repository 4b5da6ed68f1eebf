"""The units of times, presets and values of a series: each is that of what takes it."""

from __future__ import annotations

import pytest
from tracewire.compile import compile, unit_problems
from tracewire.diagram import read_text

BODY = """\
span: [0, 2]
parameters: {{k: {{value: 4, unit: 1/s^2}}, period: {{value: 3, unit: Hz}}}}
blocks:
  x: {{type: integrator, of: v, start: 1, unit: m}}
  v: {{type: integrator, of: a, unit: m/s}}
  a: {{type: gain, of: x, k: -k, unit: m/s^2}}
{}
"""
SERIES = "measured: {{s: {{file: s.csv, time: t, signals: {{x: x}}, {}}}}}"


def told(text: str) -> list[str]:
    return [str(p) for p in unit_problems(compile(read_text(text), backend="quick").flat)]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("every: {value: 0.5, unit: Hz}", "7:8: 'every' is in Hz, and a run takes it in s."),
        ("every: period", "7:8: 'period' (line 2) is in Hz, and a run takes it in s."),
        ("max_step: {value: 1, unit: kg}", "7:11: 'max_step' is in kg, and a run takes it in s."),
        (
            "events: [{every: {value: 10, unit: Hz}, set: {x: 1}}]",
            "7:18: 'every' is in Hz, and a clock takes it in s.",
        ),
        (
            "events: [{every: 1, offset: {value: 1, unit: g}, set: {x: 1}}]",
            "7:29: 'offset' is in g, and a clock takes it in s.",
        ),
        (
            "presets: {p: {k: {value: 2, unit: kg}}}",
            "7:18: 'k' is in kg, and the diagram takes it in 1/s^2.",
        ),
        (
            SERIES.format("start: {x: {value: 3, unit: kg}}"),
            "'x' is in kg, and the diagram takes it in m.",
        ),
        (
            SERIES.format("parameters: {k: {value: 3, unit: g}}"),
            "'k' is in g, and the diagram takes it in 1/s^2.",
        ),
    ],
)
def test_a_value_of_another_quantity_is_told(line: str, message: str) -> None:
    found = told(BODY.format(line))
    assert len(found) == 1
    assert message in found[0]


def test_a_span_of_another_quantity_is_told() -> None:
    text = BODY.format("").replace("[0, 2]", "[0, {value: 2, unit: N}]")
    assert told(text)[0].startswith("<text>:1:11: 'span' is in N, and a run takes it in s.")


@pytest.mark.parametrize(
    "line",
    [
        "every: {value: 50, unit: ms}",
        "events: [{every: {value: 1, unit: min}, offset: 2, set: {x: 1}}]",
        "presets: {p: {k: 3}}",
        SERIES.format("start: {x: {value: 3, unit: mm}, v: free}, parameters: {k: 2}"),
    ],
)
def test_a_value_of_its_quantity_is_not_told(line: str) -> None:
    assert told(BODY.format(line)) == []


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (
            "zero_order_hold, of: u, period: {value: 10, unit: Hz}",
            "'b.period' is in Hz, and the block takes it in s.",
        ),
        (
            "sine, amplitude: 1, omega: {value: 1, unit: Hz}",
            "'b.omega' is in Hz, and the block takes it in rad/s. 1 Hz is 2*pi rad/s: write the",
        ),
    ],
)
def test_a_unit_in_a_block_alone_is_checked(block: str, message: str) -> None:
    found = told(f"blocks:\n  u: {{type: ramp, slope: 1}}\n  b: {{type: {block}}}\n")
    assert message in found[0]
