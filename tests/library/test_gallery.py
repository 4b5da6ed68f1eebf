"""The diagrams of the gallery that are machines, against closed formulas of their fields."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracles import dead_time
from solve.models import LIMITS
from tracewire.compile import compile
from tracewire.diagram import read, read_text
from tracewire.errors import SimulationError
from tracewire.solve import Run, simulate

GALLERY = Path(__file__).parents[2] / "diagrams" / "gallery"


def ran(name: str, *record: str) -> Run:
    return simulate(compile(read(GALLERY / f"{name}.yaml"), record=record), limits=LIMITS)


def test_a_tuned_damper_has_peaks_of_the_height_of_den_hartog() -> None:
    """sqrt(1 + 2/ratio) times the deflection at rest; the body has a little damping of its own."""
    result = ran("tuned_damper", "body.x", "alone.x")
    height = np.sqrt(1 + 2 / 0.1) * 10 / (20 * (2 * np.pi * 2) ** 2)
    x = np.abs(result["body.x"])
    assert 0.97 * height < x.max() < height
    # two peaks, at about 1.78 and 2.05 Hz, that are equally high
    first, second = x[result.t < 27].max(), x[result.t > 27].max()
    assert first == pytest.approx(second, rel=0.05)
    assert np.abs(result["alone.x"]).max() > 5 * height


def test_the_rotor_swings_most_just_beyond_its_critical_speed() -> None:
    result = ran("unbalanced_rotor")
    swing = np.hypot(result["rotor.across"], result["rotor.up"])
    up = result.t < 6
    largest = result["rotor.rate"][up][swing[up].argmax()]
    assert 100 < largest < 110  # sqrt(k/m), passed a little late
    far = (result.t > 5.9) & up
    ratio = np.mean(result["rotor.rate"][far]) / 100
    assert np.mean(swing[far]) == pytest.approx(1e-4 * ratio**2 / (ratio**2 - 1), rel=0.05)


def test_the_tank_runs_out_as_torricelli_says() -> None:
    result = ran("tank")
    off = result["pump"] == 0
    begin = off.argmax()
    end = begin + (~off[begin:]).argmax() - 1
    duration = result.t[end] - result.t[begin]
    fall = np.sqrt(result["tank.level"][begin]) - np.sqrt(result["tank.level"][end])
    assert fall == pytest.approx(0.62 * 4e-4 * np.sqrt(2 * 9.81) / (2 * 0.5) * duration, rel=1e-6)


def test_the_dc_motor_is_in_balance_at_the_end() -> None:
    result = ran("dc_motor", "motor.rate1", "current", "voltage", "braking")
    rate, current = result["motor.rate1"][-1], result["current"][-1]
    assert rate == pytest.approx(500, rel=1e-3)
    assert result["voltage"][-1] == pytest.approx(0.299 * current + 0.0302 * rate, rel=1e-4)
    load = 2 * 0.8 * 60 * (rate / 12) / (60**2 + (rate / 12) ** 2) / 12 + 4e-3
    assert 0.0302 * current == pytest.approx(load, rel=1e-3)
    pressed = (result.t > 1.4) & (result.t < 1.8)
    assert result["braking"][pressed] == pytest.approx(-0.35 * 40 * 0.05 * 2)


def test_the_servo_ends_within_half_of_its_play() -> None:
    result = ran("servo_with_play", "target", "turned", "load.angle")
    apart = result["turned"] - result["load.angle"]
    assert np.abs(apart).max() < np.deg2rad(1.5) + 0.05
    assert abs(result["load.angle"][-1]) < 0.06


def test_the_car_and_its_trailer_take_up_what_the_clutch_passes() -> None:
    """Momentum of car, wheels and trailer is the impulse of the clutch less the resistances."""
    names = ("geared.rate1", "speed", "trailer.v", "plates", "rolling", "air", "small_rolling")
    result = ran("car_with_trailer", *names)
    pushed = 10 * result["plates"] / 0.3 + sum(result[name] for name in names[-3:])
    steps = np.diff(result.t) * (pushed[1:] + pushed[:-1]) / 2
    momentum = (1200 + 0.02 * 100 / 0.3**2) * result["speed"] + 300 * result["trailer.v"]
    assert momentum[-1] == pytest.approx(steps.sum(), rel=1e-3)


def test_a_mode_of_the_chain_swings_as_one() -> None:
    """x_i = a*sin(pi*i/(n + 1))*cos(w*t), w^2 = w2 + 4*k*sin(pi/(2*(n + 1)))^2 for a small a."""
    text = """
extends: chain.yaml
remove: [chain.replicate.first.start]
span: [0, 5]
parameters: {n: 40}
blocks: {chain: {start: 1e-4*sin(pi*index/(n + 1))}}
"""
    model = compile(read_text(text, GALLERY / "mode.yaml"))
    result = simulate(model, limits=LIMITS, rtol=1e-9, atol=1e-14)
    rate = np.sqrt(9.81 + 4 * 4 * np.sin(np.pi / 82) ** 2)
    for i in (1, 2, 20, 40):
        exact = 1e-4 * np.sin(np.pi * i / 41) * np.cos(rate * result.t)
        assert result[f"chain_{i}.phi"] == pytest.approx(exact, abs=1e-11)


def test_the_count_of_a_row_is_no_setting_of_a_run() -> None:
    model = compile(read(GALLERY / "chain.yaml"))
    with pytest.raises(SimulationError, match=r"'n' says how many blocks there are: change it"):
        simulate(model, parameters={"n": 11})


def test_each_variant_of_the_friction_brakes_the_cart_as_its_law_says() -> None:
    """Dry friction takes 4*slip/k off each full swing; viscous friction exp(-c*T/(2*m)) of it."""
    diagram = read(GALLERY / "cart_with_variants.yaml")
    period = 2 * np.pi * np.sqrt(0.5 / 20)
    dry = simulate(compile(diagram), span=(0, period), limits=LIMITS)
    back = (period / 2 < dry.t) & (dry.t < period)  # it swings about -slip/k
    exact = 0.155 * np.cos(np.sqrt(20 / 0.5) * (dry.t[back] - period)) - 0.3 / 20
    assert dry["x"][back] == pytest.approx(exact, abs=2e-6)
    viscous = simulate(compile(diagram), parameters={"law": 1}, limits=LIMITS)
    decay, rate = 0.4 / (2 * 0.5), np.sqrt(20 / 0.5 - 0.4**2)
    t = viscous.t
    exact = 0.2 * np.exp(-decay * t) * (np.cos(rate * t) + decay / rate * np.sin(rate * t))
    assert viscous["x"] == pytest.approx(exact, abs=1e-6)


def test_a_sampled_controller_with_a_dead_time_is_exact() -> None:
    """Limits, teeth with play and two dry frictions: against scipy, restarted at each switch."""
    model = compile(read(GALLERY / "motor_with_dead_time.yaml"))
    run = simulate(model, times=np.arange(1001) / 1000, limits=LIMITS)
    exact = dead_time.integrated(1.0, 1e-3)
    assert {event.kind for event in run.events} >= {"stick", "slip", "crossing"}
    assert run["motor_angle"] == pytest.approx(exact[:, dead_time.MOTOR_ANGLE], abs=1e-6)
    assert run["load_angle"] == pytest.approx(exact[:, dead_time.LOAD_ANGLE], abs=1e-6)
    near = simulate(model, times=run.t, rtol=1e-9, limits=LIMITS)
    assert near["load_angle"] == pytest.approx(exact[:, dead_time.LOAD_ANGLE], abs=1e-9)
