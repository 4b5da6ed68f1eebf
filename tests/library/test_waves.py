"""Waves and noise: exact values at each sample, and jumps at exactly their times."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from library.values import output
from numpy.typing import NDArray
from scipy import signal
from scipy.interpolate import CubicSpline, PchipInterpolator
from solve.models import made, run
from tracewire.compile import compile
from tracewire.compile.draws import BLOCK, ROUNDS, STRIDE, P
from tracewire.diagram import read_text
from tracewire.errors import DiagramError
from tracewire.library import load_library
from tracewire.solve import Run, simulate

Vector = NDArray[np.float64]
TIME = st.floats(-50, 50)
PERIOD = st.floats(0.1, 5)


def source(block: str, more: str = "") -> Run:
    """A run of 3 s of a source `y` and of its integral `x`."""
    return run(f"""
span: [0, 3]
every: 0.1
blocks:
  y: {block}
  x: {{type: integrator, of: y}}
record: [y, x]
{more}""")


def phase(t: float, period: float) -> float:
    """The part of a period that has passed."""
    return (t / period) % 1.0


@given(t=TIME, period=PERIOD, duty=st.floats(0.05, 0.95))
def test_pulse_is_on_for_the_first_part_of_each_period(
    t: float, period: float, duty: float
) -> None:
    level = output("pulse", t=t, amplitude=2, period=period, duty=duty, offset=1)
    part = phase(t, period)
    if t < 0:
        assert level == 1
    elif min(part, abs(part - duty), 1 - part) > 1e-9:
        assert level == (3 if part < duty else 1)


@given(t=TIME, period=PERIOD)
def test_sawtooth_and_triangle_are_those_of_scipy(t: float, period: float) -> None:
    angle, part = 2 * math.pi * t / period, phase(t, period)
    if min(part, 1 - part) > 1e-6:
        rising = (signal.sawtooth(angle) + 1) / 2
        assert output("sawtooth", t=t, amplitude=1, period=period) == pytest.approx(rising)
    corners = signal.sawtooth(angle + math.pi / 2, 0.5)
    assert output("triangle", t=t, amplitude=1, period=period) == pytest.approx(corners, abs=1e-6)


def test_pulse_jumps_at_its_times_and_its_integral_is_exact() -> None:
    result = source("{type: pulse, amplitude: 2, period: 0.7, duty: 0.3, at: 0.25}")
    begins = 0.25 + 0.7 * np.arange(4)
    jumps = sorted([*begins, *(begins + 0.21)])
    times = sorted({event.time for event in result.events})
    assert times == pytest.approx([jump for jump in jumps if jump <= 3], abs=1e-12)
    area = [2 * float(np.clip(t - begins, 0, 0.21).sum()) for t in result.t]
    assert result["x"] == pytest.approx(np.array(area), abs=1e-9)


def test_sawtooth_and_triangle_have_integrals_of_parabolas() -> None:
    saw = source("{type: sawtooth, amplitude: 1, period: 0.5}")
    part = (saw.t / 0.5) % 1
    assert saw["x"] == pytest.approx(0.5 * (saw.t - part * 0.5) / 1 + part**2 / 4, abs=1e-9)
    wave = source("{type: triangle, amplitude: 1, period: 4}")
    t = wave.t
    area = np.where(t < 1, t**2 / 2, 0.5 + (t - 1) - (t - 1) ** 2 / 2)
    assert wave["x"] == pytest.approx(area, abs=1e-9)


def test_chirp_is_that_of_scipy() -> None:
    block = "{type: chirp, amplitude: 2, first: 1, last: 9, duration: 2, offset: 3, phase: 0.5}"
    result = source(block)
    # scipy begins with a cosine, and counts the phase in degrees
    exact = signal.chirp(result.t, 1, 2, 9, phi=math.degrees(0.5) - 90)
    assert result["y"] == pytest.approx(3 + 2 * exact, abs=1e-9)


def test_a_slow_body_that_a_chirp_drives_has_the_fresnel_integral() -> None:
    from scipy.special import fresnel

    result = source("{type: chirp, amplitude: 1, first: 0, last: 40, duration: 2}")
    # sin(pi*c*t^2) with c = 20/s^2
    scale = math.sqrt(2 * 20)
    exact = fresnel(scale * result.t)[0] / scale
    assert result["x"] == pytest.approx(exact, abs=1e-5)


def test_multisine_is_the_sum_of_its_sines() -> None:
    result = source(
        "{type: multisine, frequencies: [1, 2.5], amplitudes: [2, 3], phases: [0, 0.5], offset: 1}"
    )
    exact = 1 + 2 * np.sin(2 * np.pi * result.t) + 3 * np.sin(5 * np.pi * result.t + 0.5)
    assert result["y"] == pytest.approx(exact, abs=1e-12)
    one = source("{type: multisine, frequencies: 2}")
    assert one["y"] == pytest.approx(np.sin(4 * np.pi * one.t), abs=1e-12)


CURVES = {
    "spline_table": lambda x, y: CubicSpline(x, y, bc_type="natural"),
    "monotone_table": PchipInterpolator,
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("count", [2, 3, 7])
def test_spline_table_and_monotone_table_are_those_of_scipy(name: str, count: int) -> None:
    x = np.array([0.2, 0.5, 1.1, 1.3, 2.0, 2.2, 2.9])[:count]
    y = np.array([1.0, 3.0, 2.5, 2.5, -1.0, 4.0, 4.5])[:count]
    points = [[float(a), float(b)] for a, b in zip(x, y, strict=True)]
    result = source(f"{{type: {name}, points: {points}}}")
    curve = CURVES[name](x, y)
    inside = np.clip(result.t, x[0], x[-1])
    assert result["y"] == pytest.approx(curve(inside), abs=1e-12)
    area = np.array([curve.integrate(x[0], end) for end in inside])
    area += y[0] * np.minimum(result.t, x[0]) + y[-1] * np.maximum(result.t - x[-1], 0)
    assert result["x"] == pytest.approx(area, abs=1e-7)


def test_the_slope_of_a_spline_table_is_followed_by_sensitivities() -> None:
    text = """
span: [0, 1]
parameters: {a: 0.7}
blocks:
  u: {type: expression, formula: a}
  y: {type: spline_table, of: u, points: [[0, 0], [0.5, 1], [1, 0], [2, 3]]}
record: [y]
"""
    result = simulate(made(text), sensitivities=["a"])
    curve = CubicSpline([0, 0.5, 1, 2], [0, 1, 0, 3], bc_type="natural")
    assert result["y"][-1] == pytest.approx(curve(0.7))
    assert result.sensitivities["a"]["y"][-1] == pytest.approx(curve(0.7, 1))


# noise


def drawn(seed: int, k: int) -> float:
    """Random number k of a stream, in whole numbers of any size."""
    prime = int(P)
    key = (int(STRIDE) * seed + int(BLOCK) * (k // prime)) % prime
    x = k % prime
    for constant in map(int, ROUNDS):
        x = pow(x + key + constant, 3, prime)
    return (x + 0.5) / prime


@given(seed=st.integers(0, 10**6))
@settings(max_examples=10, deadline=None)
def test_random_steps_are_whole_numbers_divided_whatever_the_steps(seed: int) -> None:
    levels = np.array([drawn(seed, k) for k in range(30)])
    for rtol in (1e-3, 1e-9):
        text = f"{{type: random_steps, period: 0.1, seed: {seed}, low: -1, high: 3}}"
        result = run(
            f"span: [0, 2.9]\nevery: 0.1\nblocks:\n  y: {text}\n  z: {{type: sine, amplitude: 1,"
            " omega: 9}\n  x: {type: integrator, of: z}\nrecord: [y]",
            rtol=rtol,
        )
        assert result["y"].tolist() == (-1 + 4 * levels).tolist()


def test_a_stream_goes_on_beyond_the_prime_and_before_zero() -> None:
    k = 2**26 + 5
    text = "{type: random_steps, period: 1, seed: 4}"
    head = f"span: [SPAN]\nevery: 1\nblocks:\n  y: {text}\nrecord: [y]"
    result = run(head.replace("SPAN", f"{k}, {k + 2}"))
    assert result["y"].tolist() == [drawn(4, n) for n in range(k, k + 3)]
    before = run(head.replace("SPAN", "-3, -1"))
    assert before["y"].tolist() == [drawn(4, n) for n in (-3, -2, -1)]


def test_noise_is_normal_white_and_the_same_for_a_seed() -> None:
    text = "span: [0, 400]\nevery: 0.1\nblocks:\n  y: {type: noise, period: 0.1, seed: SEED,"
    text += " sigma: 2, mean: 1}\nrecord: [y]"
    result = run(text.replace("SEED", "5"))
    y = (result["y"] - 1) / 2
    first = math.sqrt(-2 * math.log(drawn(5, 0))) * math.cos(2 * math.pi * drawn(5, 1))
    assert y[0] == pytest.approx(first, rel=1e-14)
    share = 4 / math.sqrt(len(y))  # four standard errors
    assert abs(np.mean(y)) < share
    assert abs(np.mean(y**2) - 1) < share * math.sqrt(2)
    assert abs(np.mean(y**4) - 3) < share * math.sqrt(96)
    for lag in (1, 2, 3, 10):
        assert abs(np.mean(y[lag:] * y[:-lag])) < share
    other = run(text.replace("SEED", "6"))["y"]
    assert abs(np.mean(y * (other - 1) / 2)) < share


@pytest.mark.parametrize(("bits", "tap"), [(2, 1), (3, 1), (4, 1), (5, 2), (6, 1), (7, 1), (9, 4)])
def test_prbs_has_all_words_but_zero_once_in_a_period(bits: int, tap: int) -> None:
    length = 2**bits - 1
    register = [1] + [0] * (bits - 1)
    result = run(f"""
span: [0, {2 * length - 1}]
every: 1
blocks:
  y: {{type: prbs, period: 1, register: {register}, tap: {tap}}}
record: [y]
""")
    bit = (result["y"] + 1) / 2
    assert set(bit) == {0.0, 1.0}
    assert bit[length:].tolist() == bit[:length].tolist()
    words = {tuple(bit[k : k + bits]) for k in range(length)}
    assert len(words) == length
    sequence = result["y"][:length]
    shifted = {float(np.roll(sequence, k) @ sequence) for k in range(1, length)}
    assert shifted == {-1.0}


def test_a_random_number_of_what_flows_is_refused(tmp_path: Path) -> None:
    (tmp_path / "jitter.py").write_text(
        """
from tracewire.library import Block, Output

jitter = Block(name="jitter", doc="Jitter.", outputs=(Output("y", "random_number(1, t)"),))
""",
        encoding="utf-8",
    )
    text = "span: [0, 1]\nblocks:\n  y: {type: jitter}\n"
    wanted = (
        "<text>:3:3: block 'y': 't' flows, and a random number needs what only jumps."
        " Write random_number(seed, floor(t/period))."
    )
    with pytest.raises(DiagramError, match=re.escape(wanted)):
        compile(read_text(text, library=load_library([tmp_path / "jitter.py"])))


def test_a_guard_that_reads_noise_is_seen_to_cross() -> None:
    """The products inside of the draws are of 15 digits; their rounding is no noise of a guard."""
    result = run("""
span: [0, 2]
every: 0.1
blocks:
  u: {type: random_steps, period: 0.5, seed: 7, low: -1, high: 1}
  e: {type: sum, of: [u, -x]}
  y: {type: saturation, of: e, low: -0.2, high: 0.2}
  x: {type: integrator, of: y}
record: [e, y]
""")
    assert result["y"] == pytest.approx(np.clip(result["e"], -0.2, 0.2), abs=1e-12)
    assert {abs(y) < 0.2 for y in result["y"]} == {True, False}


@pytest.mark.parametrize(
    ("register", "told"),
    [
        ("1", "its register is a number, and it takes two bits or more: write a list, such as [1,"),
        ("[1]", "its register is a vector of 1, and it takes two bits or more: write a list"),
        ("[0, 0]", "the bits of its register are all 0, and would stay so: write a 1 for one."),
        ("[1, 0], tap: 3", "'b.bits' is a vector of 2, and has no element [3]: they are counted"),
    ],
)
def test_prbs_says_what_is_wrong_with_its_register(register: str, told: str) -> None:
    text = f"span: [0, 1]\nblocks:\n  b: {{type: prbs, period: 0.1, register: {register}}}\n"
    with pytest.raises(DiagramError) as caught:
        made(text)
    assert [str(p).removeprefix("<text>:3:3: block 'b': ")[:60] for p in caught.value.problems] == [
        told[:60]
    ]
