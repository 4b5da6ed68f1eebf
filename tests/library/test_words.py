"""Words of other tools for the inputs and parameters of blocks: what is meant is said."""

from __future__ import annotations

import pytest
from tracewire.diagram import read_text
from tracewire.errors import DiagramError


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("transfer_function, of: i, num: [1], denominator: [1, 1]", "Did you mean 'numerator'?"),
        ("transfer_function, of: i, den: [1, 1]", "Did you mean 'denominator'?"),
        (
            "gain, of: i, gain: 2",
            "unknown input or parameter of 'gain' 'gain'; there are",
        ),
        ("gain, input: i, k: 2", "Did you mean 'of'?"),
        ("saturation, of: i, upper: 2, low: 1", "there are: high, low, of. Did you mean 'high'?"),
        ("integrator, of: i, initial: 2", "there are: of, start. Did you mean 'start'?"),
        ("discrete_pid, of: i, kp: 1, T: 0.1", "Did you mean 'period'?"),
        ("delay, of: i, delay: 0.1", "Did you mean 'time'?"),
        ("step, at: 1, final: 2", "Did you mean 'height'?"),
        ("sine, amp: 1, omega: 2", "Did you mean 'amplitude'?"),
        ("sine, amplitude: 1, frequency: 2", "phase. Write omega: 2*pi*..., in rad/s."),
        ("sum, of: [i], signs: +", "there are: of. Write a minus before a signal: of: [a, -b]."),
    ],
)
def test_a_word_of_another_tool_is_told_with_ours(line: str, message: str) -> None:
    text = f"blocks:\n  a: {{type: {line}}}\n  i: {{type: integrator, of: i}}\n"
    with pytest.raises(DiagramError) as refused:
        read_text(text)
    assert message in str(refused.value)
    assert "<text>:2:" in str(refused.value)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("gain, of: i, k: 1/mass", "A new parameter is written parameters: {mass: ...}."),
        ("expression, formula: c*i", "A new parameter is written parameters: {c: ...}."),
        ("gain, of: t, k: 1", "'t' is the time, and not a signal. Use a block of type time or exp"),
    ],
)
def test_a_name_that_is_not_there_is_told_with_where_it_goes(line: str, message: str) -> None:
    with pytest.raises(DiagramError) as refused:
        read_text(f"blocks:\n  a: {{type: {line}}}\n  i: {{type: time}}\n")
    assert message in str(refused.value)


def test_a_word_that_is_spelled_alike_is_proposed_once() -> None:
    with pytest.raises(DiagramError) as refused:
        read_text("blocks:\n  a: {type: pid, of: i, Kp: 2}\n  i: {type: time}\n")
    assert str(refused.value).count("Did you mean") == 1


def test_a_word_whose_meaning_is_given_already_is_not_proposed() -> None:
    with pytest.raises(DiagramError) as refused:
        read_text("blocks:\n  a: {type: gain, of: i, k: 2, gain: 2}\n  i: {type: time}\n")
    assert "Did you mean" not in str(refused.value)
