"""Candidates: what is tried where, with which unknowns, and as which text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from library.installed import HEAD, install
from oracles.written import with_effects
from tracewire.compile import Model, compile
from tracewire.diagram import Diagram, difference, read_text
from tracewire.solve import simulate
from tracewire.trace.candidates.candidate import Candidate, unknowns_of
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import (
    SignalScale,
    SignalScales,
    Trajectory,
    signal_scales_of,
    signals_at,
)
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

PENDULUM = """\
span: [0, 2]
every: 0.02
blocks:
  theta: {type: integrator, of: omega, start: 1}   # the angle
  omega: {type: integrator, of: torque}
  torque: {type: sum, of: [gravity]}               # the place
  gravity: {type: expression, formula: "-20*sin(theta)"}
"""
TWO_MASSES = """\
span: [0, 2]
every: 0.02
blocks:
  x1: {type: integrator, of: v1, start: 1}
  v1: {type: integrator, of: force1}
  force1: {type: sum, of: [-pull, -x1]}
  x2: {type: integrator, of: v2}
  v2: {type: integrator, of: force2}
  force2: {type: sum, of: [pull]}
  pull: {type: expression, formula: "4*(x1 - x2)"}
"""
DRIVEN = """\
span: [0, 2]
every: 0.02
inputs: {u: {default: 1}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  force: {type: sum, of: [-x, u]}
measured:
  run:
    file: run.csv
    use: train
    time: t
    signals: {x: {column: x, gain: {value: 1, fit: [0.5, 2]}}}
    inputs: {u: {column: u}}
"""
DAMPER = """\
span: [0, 2]
inputs: [v]
parameters: {c: {value: 2, fit: [0, 9]}}
blocks:
  oil: {type: viscous, rate: v, c: c}
  force: {type: sum, of: [oil], place: {v: v}}
"""
LAGGED = SignalScales({"v": SignalScale(1.0, 2.0), "force": SignalScale(2.0, 4.0)}, 10.0, 0.01)
OWN = """
subsystems:
  magnet:
    inputs: [angle]
    outputs: {pull: pull}
    parameters: {strength: {value: 0, unit: N cm}, width: {value: 10, unit: deg}}
    effect:
      coefficient: strength
      inputs: {angle: q}
      sign: positive
      shapes: {width: {at: [0.1, 0.2], of: Q}}
    blocks:
      pull: {type: expression, formula: "-strength*tanh(angle/width)"}
"""


def runs(model: Model) -> list[Trajectory]:
    run = simulate(model)
    return [Trajectory(run.t, run.signals)]


def found_in(diagram: Diagram, taken: Sequence[Candidate] = ()) -> list[Candidate]:
    places = find_places(compile(diagram))
    model = compile(diagram, record=signals_at(places))
    return find_candidates(
        model, places, signal_scales_of(runs(model), OPTIONS.candidate), OPTIONS.candidate, taken
    )


def named(candidates: Sequence[Candidate]) -> dict[str, Candidate]:
    return {str(candidate): candidate for candidate in candidates}


def driven(folder: Path) -> Diagram:
    (folder / "run.csv").write_text("t,x,u\n0,0,0\n1,0,1\n2,0,0\n")
    return read_text(DRIVEN, folder / "driven.yaml")


def test_levels_are_taken_over_all_series() -> None:
    short = Trajectory(np.array([0, 0.5, 1.0]), {"x": np.array([3.0, 0, 0])})
    long = Trajectory(np.array([5.0, 6, 7, 8]), {"x": np.array([0, 0, -4, 0.0])})
    levels = signal_scales_of([short, long], OPTIONS.candidate)
    assert levels.signals["x"] == SignalScale(
        pytest.approx(5 / 7**0.5), 4.0, 4.0, 4.0, slowest=3.01, other_side=3.0
    )
    assert (levels.duration, levels.interval) == (3.0, 1.0)
    assert levels.of("unknown") == SignalScale(0.0, 0.0)


@pytest.mark.parametrize(
    ("rates", "tried"),
    [((3.0, 9.0), False), ((0.5, 9.0), True), ((-3.0, 9.0), True)],
    ids=["far from rest", "near rest", "through rest"],
)
def test_a_dip_near_rest_is_tried_where_the_record_comes_near_rest(
    rates: tuple[float, float], tried: bool
) -> None:
    model = compile(read_text(PENDULUM))
    t = np.linspace(0, 1, 50)
    run = Trajectory(t, {"omega": np.linspace(*rates, 50), "theta": t, "torque": t})
    scales = signal_scales_of([run], OPTIONS.candidate)
    known = named(find_candidates(model, find_places(model), scales, OPTIONS.candidate))
    assert ("stribeck @ torque" in known) is tried
    assert "coulomb @ torque" in known


def test_an_effect_is_wired_to_the_signals_of_its_place() -> None:
    coulomb = named(found_in(read_text(PENDULUM)))["coulomb @ torque"]
    assert (coulomb.block, coulomb.coefficient) == ("coulomb", "coulomb.level")
    assert (coulomb.signals, coulomb.sign) == ({"rate": "omega"}, 1)
    assert coulomb.parameter == "level"


def test_effects_read_a_drive_as_an_effect_at_it_leaves_it_in_any_order() -> None:
    """A damper whose motion is prescribed: a lag of that motion is one of its friction, too."""
    diagram = read_text(DAMPER)
    model = compile(diagram)
    known = named(find_candidates(model, find_places(model), LAGGED, OPTIONS.candidate))
    lag, friction = known["drive_lag @ drive.v"], known["coulomb @ force"]
    chosen = [(lag, {"tau": 0.1}), (friction, {"level": 2.0})]
    texts = [with_effects(diagram, order).text for order in (chosen, chosen[::-1])]
    assert texts[0] == texts[1]
    assert "coulomb: {type: coulomb, rate: v_seen" in texts[0]


def test_shapes_are_sizes_of_the_signals() -> None:
    diagram = read_text(PENDULUM)
    places = find_places(compile(diagram))
    sizes = {
        "omega": SignalScale(2.0, 5.0),
        "theta": SignalScale(0.5, 3.0),
        "torque": SignalScale(7.0, 9.0),
    }
    candidates = find_candidates(
        compile(diagram), places, SignalScales(sizes, 10.0, 0.01), OPTIONS.candidate
    )
    known = named(candidates)
    assert known["coulomb @ torque"].shapes == {"width": (0.0, 0.2)}, (
        "0.04 is less than is resolved"
    )
    assert known["backlash @ torque"].shapes["gap"] == pytest.approx((0.3, 0.75, 1.5))
    assert known["harmonic @ torque"].shapes["period"][:2] == pytest.approx((10 / 3, 2.5))
    assert known["bias @ torque"].scale == pytest.approx(7.0)
    still = find_candidates(
        compile(diagram), places, SignalScales({}, 10.0, 0.01), OPTIONS.candidate
    )
    assert "backlash @ torque" not in named(still) and "bias @ torque" in named(still)


def test_shapes_stay_within_what_the_record_shows() -> None:
    diagram = read_text(PENDULUM)
    sizes = {
        "omega": SignalScale(2.0, 5.0, slowest=0.1),
        "theta": SignalScale(0.5, 3.0, stroke=4.0, step=0.05),
        "torque": SignalScale(7.0, 9.0),
    }
    places = find_places(compile(diagram))
    known = named(
        find_candidates(
            compile(diagram), places, SignalScales(sizes, 10.0, 0.01), OPTIONS.candidate
        )
    )
    stribeck = known["stribeck @ torque"]
    assert stribeck.limits["speed"] == (0.1, 5.0)
    speeds = stribeck.shapes["speed"]
    assert speeds[0] == 0.1 and speeds[-1] < 5.0
    assert np.diff(np.log(speeds[:4])) == pytest.approx([0.25 * np.log(50)] * 3), (
        "evenly in factors"
    )
    assert stribeck.limits["width"][0] == 0.0 and stribeck.resolved["width"] == 0.1
    assert known["hysteresis @ torque"].limits["deflection"] == pytest.approx((0.04, 4.0))
    assert known["cogging @ torque"].limits["pitch"] == pytest.approx((0.2, 4.0)), "four samples"
    assert known["cogging @ torque"].waves == ("pitch",)
    assert known["position_friction @ torque"].limits["pitch"] == pytest.approx((0.2, 8.0))
    assert known["harmonic @ torque"].limits["period"][1] == 4.0, "2.5 waves in the record"
    assert known["backlash @ torque"].limits["gap"] == pytest.approx((0.03, 3.0))
    fast = {**sizes, "theta": SignalScale(0.5, 3.0, stroke=4.0, step=2.0)}
    left = named(
        find_candidates(compile(diagram), places, SignalScales(fast, 10.0, 0.01), OPTIONS.candidate)
    )
    assert "cogging @ torque" not in left, "no wave is four samples long"


def test_levels_know_strokes_steps_and_slow_rates() -> None:
    t = np.linspace(0, 2, 2001)
    there_and_back = Trajectory(t, {"q": np.abs(3 * (1 - t)), "v": np.where(t < 1, -3.0, 0.0)})
    levels = signal_scales_of([there_and_back], OPTIONS.candidate)
    assert levels.of("q").stroke == pytest.approx(3.0)
    assert levels.of("q").step == pytest.approx(0.003)
    assert levels.of("v").slowest == 3.0, "what rests is not slow"


@pytest.mark.parametrize(
    ("back", "tried"), [(1.0, True), (0.1, True), (0.01, False), (-0.5, False)]
)
def test_what_differs_by_direction_is_tried_where_a_body_moves_both_ways(
    back: float, tried: bool
) -> None:
    """Elsewhere it is a friction like any other."""
    t = np.linspace(0.0, 2.0, 200)
    rate = np.where(t < 1, 1.0, -back) * (1 + 0.1 * np.sin(9 * t))
    signals = {"theta": np.sin(t), "omega": rate, "torque": np.cos(t)}
    levels = signal_scales_of([Trajectory(t, signals)], OPTIONS.candidate)
    diagram = read_text(PENDULUM)
    model, places = compile(diagram), find_places(compile(diagram))
    known = named(find_candidates(model, places, levels, OPTIONS.candidate))
    for name in ("asym_coulomb", "asym_viscous"):
        assert (f"{name} @ torque" in known) is tried
    assert "viscous @ torque" in known and "asym_stiffness @ torque" not in known


def test_a_coupling_is_tried_with_each_other_body_and_names_are_unique() -> None:
    candidates = found_in(read_text(TWO_MASSES))
    known = named(candidates)
    coupling = known["coupling_q @ force1 (of force2)"]
    assert coupling.signals == {"other": "x2"}
    assert known["coupling_v @ force2 (of force1)"].signals == {"other": "v1"}
    blocks = [candidate.block for candidate in candidates if candidate.block]
    assert len(set(blocks)) == len(blocks)
    assert known["viscous @ force2"].block == "viscous_force2"
    assert not any(c.effect.startswith("coupling") for c in found_in(read_text(PENDULUM)))


def test_a_block_name_of_the_diagram_is_not_used_again() -> None:
    diagram = read_text(PENDULUM.replace("gravity", "coulomb"))
    assert named(found_in(diagram))["coulomb @ torque"].block == "coulomb_2"


def test_an_effect_of_an_installed_library_keeps_its_type_and_gets_a_plain_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rub = HEAD + (
        'rub = Block("rub", "Rubs.", inputs=(Input("rate"),), parameters=(Parameter("c"),),'
        ' outputs=(Output("force", "-c*rate"),), effect=Effect("c", {"rate": "v"}, sign=1))\n'
    )
    install(tmp_path, {"frictions.py": rub})
    monkeypatch.syspath_prepend(tmp_path)
    diagram = read_text("libraries: [mylab]\n" + PENDULUM)
    candidate = named(found_in(diagram))["mylab.rub @ torque"]
    assert candidate.block == "rub"
    extended = with_effects(diagram, [(candidate, {"c": 0.1})])
    assert extended.blocks["rub"].type == "mylab.rub"


def test_what_a_trace_has_taken_is_no_candidate_any_more() -> None:
    diagram = read_text(PENDULUM)
    candidates = found_in(diagram)
    coulomb = named(candidates)["coulomb @ torque"]
    rest = found_in(with_effects(diagram, [(coulomb, {"level": 0.1})]), [coulomb])
    assert set(named(candidates)) - set(named(rest)) == {"coulomb @ torque"}


def test_effects_at_the_drive_and_the_sensor(tmp_path: Path) -> None:
    known = named(found_in(driven(tmp_path)))
    assert known["drive_gain @ drive.u"].signals == {"of": "u"}
    assert "drive_gain @ force" not in known and "viscous @ drive.u" not in known
    assert known["drive_lag @ drive.u"].at > 0
    sensors = {name for name in known if "sensor." in name}
    assert sensors == {
        f"sensor_{kind} @ sensor.x" for kind in ("offset", "delay", "quad", "drift")
    }  # the gain is free already
    assert known["sensor_delay @ sensor.x"].sign == 1
    assert known["sensor_offset @ sensor.x"].coefficient == "offset.x"


def test_unknowns_are_the_coefficient_and_the_shapes_that_are_on() -> None:
    coulomb = named(found_in(read_text(PENDULUM)))["coulomb @ torque"]
    (level,) = unknowns_of(coulomb, {"level": 0.2, "width": 0.0})
    assert (level.name, level.value, level.low) == ("coulomb.level", 0.2, 0.0)
    level, width = unknowns_of(coulomb, {"level": 0.2, "width": 0.4})
    assert (width.name, width.value, width.low) == ("coulomb.width", 0.4, 0.0)
    assert 0.4 < width.high < np.inf


def test_the_text_of_an_effect_is_what_a_person_would_write() -> None:
    old = read_text(PENDULUM)
    coulomb = named(found_in(old))["coulomb @ torque"]
    new = with_effects(old, [(coulomb, {"level": 0.148, "width": 0.0})])
    assert difference(old, new).splitlines()[3:] == [
        "   omega: {type: integrator, of: torque}",
        "-  torque: {type: sum, of: [gravity]}               # the place",
        "+  torque: {type: sum, of: [gravity, coulomb]}               # the place",
        "+  coulomb: {type: coulomb, rate: omega, level: {value: 0.148, fit: [0, 10]}}",
        '   gravity: {type: expression, formula: "-20*sin(theta)"}',
    ]
    new = with_effects(old, [(coulomb, {"level": 0.148, "width": 0.4})])
    assert "width: {value: 0.4, fit: [0, " in new.text


def test_every_effect_can_be_added_and_vanishes_at_zero(tmp_path: Path) -> None:
    two = read_text(TWO_MASSES)
    couplings = [c for c in found_in(two) if c.effect.startswith("coupling")]
    for diagram, candidates in (
        (driven(tmp_path), found_in(driven(tmp_path))),
        (two, couplings),
    ):
        zeros: list[tuple[Candidate, Mapping[str, float]]] = [
            (c, {c.parameter: c.neutral, **{name: grid[-1] for name, grid in c.shapes.items()}})
            for c in candidates
        ]
        before = simulate(compile(diagram), span=(0, 1))
        after = simulate(compile(with_effects(diagram, zeros)), span=(0, 1))
        for name in before.signals:
            expected = before.signals[name]
            np.testing.assert_allclose(after.signals[name], expected, atol=1e-5, err_msg=name)


def test_effects_of_each_kind_go_together(tmp_path: Path) -> None:
    diagram = driven(tmp_path)
    candidates = found_in(diagram)
    new = with_effects(diagram, [(c, {c.parameter: 0.02}) for c in candidates])
    added = set(new.blocks) - set(diagram.blocks) - {"u_seen"}  # two readers see the drive there
    assert added == {c.block for c in candidates if c.block}
    channel = new.measured["run"].channels["x"]
    assert channel.offset is not None and channel.offset.fit == (-1.0, 1.0)
    free = {name for name, p in compile(new).flat.parameters.items() if p.fit is not None}
    assert free >= {c.coefficient for c in candidates if c.block}


def test_inertia_is_a_loop_that_is_solved() -> None:
    diagram = read_text(PENDULUM)
    inertia = named(found_in(diagram))["inertia @ torque"]
    heavier = simulate(compile(with_effects(diagram, [(inertia, {"m": 0.25})])), rtol=1e-9)
    lighter = read_text(PENDULUM.replace("-20*", "-16*"))  # 1.25 a = -20 sin(theta)
    expected = simulate(compile(lighter), rtol=1e-9).signals["theta"]
    np.testing.assert_allclose(heavier.signals["theta"], expected, atol=1e-7)


def test_a_subsystem_of_the_diagram_is_an_effect_with_its_own_units() -> None:
    diagram = read_text(PENDULUM + OWN)
    magnet = named(found_in(diagram))["magnet @ torque"]
    assert magnet.signals == {"angle": "theta"}
    assert magnet.shapes["width"] == pytest.approx((0.1, 0.2), rel=0.01)
    level = named(found_in(diagram))["bias @ torque"].scale
    assert level < magnet.scale < 1.2 * level  # the tanh is nearly 1 most of the time
    new = with_effects(diagram, [(magnet, {"strength": 0.2, "width": np.pi / 18})])
    values = simulate(compile(new)).parameters
    assert values[magnet.coefficient] == pytest.approx(0.2)
    assert values[f"{magnet.block}.width"] == pytest.approx(np.pi / 18)
    assert "strength: {value: 20, fit: [0, " in new.text
    assert f"torque: {{type: sum, of: [gravity, {magnet.block}]}}" in new.text


def test_an_effect_imitates_what_its_block_says_at_its_own_place() -> None:
    known = named(found_in(read_text(TWO_MASSES)))
    assert "coulomb @ force1" in known["stribeck @ force1"].imitated
    assert not any(name.endswith("force2") for name in known["stribeck @ force1"].imitated)
    assert known["coulomb @ force1"].imitated == frozenset()


def test_a_fixed_shape_is_written_and_not_fitted() -> None:
    diagram = read_text(
        """
span: [0, 2]
every: 0.02
inputs: {u: {default: 1}}
blocks:
  x: {type: sum, of: [pull], place: {q: u}}
  pull: {type: gain, of: u, k: 2}
"""
    )
    play = named(found_in(diagram))["play_q @ x"]
    assert play.fixed == ("lag",)
    names = [u.name for u in unknowns_of(play, {"k": 0.5})]
    assert names == ["play_q.k", "play_q.gap"]
    new = with_effects(diagram, [(play, {"k": 0.5, "gap": 0.3})])
    assert ", lag: 0.006}" in new.text


def test_a_coefficient_is_scaled_by_where_it_begins() -> None:
    coulomb = named(found_in(read_text(PENDULUM)))["coulomb @ torque"]
    assert unknowns_of(coulomb, {"level": 0.2})[0].scale == 0.2
    assert unknowns_of(coulomb, {"level": 0.0})[0].scale == coulomb.scale
