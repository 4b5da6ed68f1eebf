"""A port that must not get a jump: what is certain to jump is refused, and nothing else."""

from __future__ import annotations

import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DiagramError

TEXT = """\
span: [0, 2]
parameters: {{none: 0, one: 1}}
blocks:
  wave: {{type: square, amplitude: 1, frequency: 2}}
  flat: {{type: constant, value: 1}}
  sine: {{type: sine, amplitude: 1, omega: 3}}
  u: {{{}}}
  after: {{type: sum, of: [sine, -u]}}
  play: {{type: play_operator, of: after, rate: sine, width: 0.1}}
"""
JUMPS = [
    "type: step, at: 1, height: 3",
    "type: step, at: 1, height: one",
    "type: gain, of: wave, k: 2",
    "type: gain, of: wave, k: {value: 2, fit: free}",
    "type: pulse, amplitude: 1, period: 1",
    "type: sawtooth, amplitude: 1, period: 1",
    "type: compare, of: sine",
    "type: relay, of: sine, on_at: 0.5, off_at: -0.5",
    "type: quantizer, of: sine, interval: 0.1",
    "type: zero_order_hold, of: sine, period: 0.1",
    "type: noise, period: 0.1, seed: 1, sigma: 1",
    "type: counter, of: sine",
    "type: delay, of: wave, time: 0.3",
]
CONTINUOUS = [
    "type: step, at: 1, height: none",
    "type: ramp, slope: 1, at: 0.5",
    "type: triangle, amplitude: 1, period: 1",
    "type: saturation, of: sine, low: -0.5, high: 0.5",
    "type: dead_zone, of: sine, low: -0.5, high: 0.5",
    "type: abs, of: sine",
    "type: first_order, of: wave, lag: 0.1",
    "type: integrator, of: wave",
    "type: rate_limiter, of: wave, rising: 2",
    "type: gain, of: wave, k: none",
    "type: play_operator, of: sine, rate: sine, width: 0.3",
    "type: mod, of: sine, by: flat",
]


@pytest.mark.parametrize("line", JUMPS)
def test_what_jumps_is_refused_with_the_signal_that_does(line: str) -> None:
    with pytest.raises(DiagramError) as refused:
        compile(read_text(TEXT.format(line)))
    (problem,) = refused.value.problems
    name = "wave" if "wave" in line else "u"
    assert str(problem) == (
        f"<text>:9:3: block 'play': input 'of' of a play_operator gets '{name}', which jumps. What "
        "moves this block has no jumps: put a rate_limiter or a first_order before."
    )


@pytest.mark.parametrize("line", CONTINUOUS)
def test_what_may_be_continuous_is_not(line: str) -> None:
    compile(read_text(TEXT.format(line)), backend="quick")


def test_a_jump_is_found_through_the_port_of_a_subsystem_and_in_a_vector() -> None:
    text = """
blocks:
  wave: {type: square, amplitude: 1, frequency: 2}
  both: {type: mux, of: [t_now, wave]}
  t_now: {type: time}
  inside: {type: part, u: "both[1]"}
subsystems:
  part:
    inputs: [u]
    outputs: {y: play}
    blocks: {play: {type: play_operator, of: u, rate: u, width: 1}}
"""
    with pytest.raises(DiagramError, match=r"block 'inside.play': .* gets 'wave', which jumps"):
        compile(read_text(text))


def test_a_long_chain_of_doubled_signals_is_looked_through_once() -> None:
    """Back along each wire it would be 2**2000 ways, and too deep for a recursion."""
    chain = "".join(f"  u{n}: {{type: sum, of: [u{n - 1}, u{n - 1}]}}\n" for n in range(1, 2000))
    text = f"""
blocks:
  u0: {{type: square, amplitude: 1, frequency: 2}}
{chain}
  sine: {{type: sine, amplitude: 1, omega: 3}}
  play: {{type: play_operator, of: u1999, rate: sine, width: 0.1}}
"""
    with pytest.raises(DiagramError, match="gets 'u0', which jumps"):
        compile(read_text(text))
