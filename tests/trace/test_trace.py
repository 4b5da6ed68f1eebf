"""From a record with a hidden effect to its name, its size, and the edited diagram."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from oracles.swing import write_pendulum
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError, FitError, TracewireError
from tracewire.fit import fit
from tracewire.show import paragraph_of
from tracewire.solve import simulate
from tracewire.trace import Found, trace
from tracewire.trace.found import Curve


def traced(path: Path) -> Found:
    return trace(compile(read(path)))


@pytest.fixture(scope="module")
def swing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pendulum with dry friction that its diagram lacks."""
    return write_pendulum(tmp_path_factory.mktemp("swing"), f_c=0.3)


@pytest.fixture(scope="module")
def found(swing: Path) -> Found:
    return traced(swing)


def test_a_hidden_coulomb_friction_is_named_with_its_size(found: Found) -> None:
    assert found.verdict == "effect"
    assert [(e.name, e.place) for e in found.effects] == [("coulomb", "acceleration")]
    (effect,) = found.effects
    low, high = effect.intervals["level"]
    assert effect.params["level"] == pytest.approx(0.3, rel=0.05)
    assert low < 0.3 < high and high - low < 0.03
    assert found.values["c"] == pytest.approx(0.06, abs=0.02)
    assert found.values["w0_squared"] == pytest.approx(63.7, rel=1e-3)
    assert found.s2_after == pytest.approx(0.83, abs=0.05), "the mean square of this noise"
    assert found.rmse_after < 1.2e-3 < found.rmse_before


def test_free_parameters_that_the_record_cannot_separate_are_told(swing: Path) -> None:
    text = (swing.parent / "pendulum.yaml").read_text()
    text = text.replace("k: -w0_squared}", "k: -share*w0_squared}")
    text = text.replace("parameters:", "parameters:\n  share: {value: 1, fit: [0.5, 2]}")
    (swing.parent / "shared.yaml").write_text(text)
    only = {"only": ["acceleration"], "effects": 1}
    found = trace(compile(read(swing.parent / "shared.yaml")), options=only)
    assert found.verdict == "effect"
    assert any(word.startswith("only share*w0_squared is determined") for word in found.words)


@pytest.mark.parametrize("rtol", [1e-2, 1e-3])
def test_a_solver_as_coarse_as_the_noise_is_made_more_precise(swing: Path, rtol: float) -> None:
    only = {"only": ["acceleration"], "effects": 1}  # what else may be missing is not asked
    coarse = trace(compile(read(swing)), options=only, rtol=rtol)
    assert any(f"rtol is {0.1 * rtol:.0e} now" in words for words in coarse.words)
    assert coarse.verdict == "effect"
    (effect,) = coarse.effects
    assert effect.name == "coulomb" and effect.params["level"] == pytest.approx(0.3, rel=0.02)


def test_it_tells_what_was_tried_and_what_the_declared_parameters_did(found: Found) -> None:
    first = found.steps[0]
    assert first.chance < 1e-3 and first.words == "accepted: coulomb @ acceleration"
    assert len(first.tried) > 5
    assert "coulomb" in paragraph_of(found)
    moved = {m.name: m for m in found.moved}
    assert moved["c"].before > moved["c"].after + 2 * moved["c"].error, "friction was taken for it"
    assert {(e.use, e.kind) for e in found.errors} >= {
        ("train", "windowed"), ("validate", "windowed"), ("validate", "free run")
    }  # fmt: skip


def test_the_curves_are_free_runs_of_both_models(found: Found) -> None:
    last = next(curve for curve in found.curves if curve.use == "validate")

    def error(curve: Curve, values: np.ndarray) -> float:
        return float(np.sqrt(np.mean((values - curve.measured) ** 2)))

    assert error(last, last.before) == pytest.approx(found.rmse_before)
    assert error(last, last.after) == pytest.approx(found.rmse_after)


def test_the_needed_torque_looks_like_dry_friction(found: Found) -> None:
    (force,) = found.forces
    assert (force.place, force.names) == ("acceleration", ("theta", "omega"))
    fast = np.abs(force.v) > 1.0
    # at single samples it is full of noise; over all of them it is the friction
    share = np.mean((force.needed * force.fitted)[fast]) / np.mean(force.fitted[fast] ** 2)
    assert share == pytest.approx(1.0, abs=0.3)
    np.testing.assert_allclose(np.abs(force.fitted[fast]), found.effects[0].params["level"])


def test_the_means_of_the_needed_torque_are_those_of_dry_friction(found: Found) -> None:
    over_q, over_v = found.forces[0].means
    clear = np.abs(over_v.at) > 0.5  # a bin around rest has both signs
    off = (np.abs(over_v.mean + 0.3 * np.sign(over_v.at)) / over_v.error)[clear]
    assert np.sqrt(np.mean(off**2)) < 1.5
    assert np.median(over_v.error) < 0.1, "they tell friction from nothing"
    assert np.sqrt(np.mean((over_q.mean / over_q.error) ** 2)) < 2, "it depends on no coordinate"


def test_nothing_is_found_where_nothing_is_missing(tmp_path: Path) -> None:
    found = traced(write_pendulum(tmp_path))
    assert found.verdict == "null"
    assert found.effects == () and found.missing is None
    assert all(m.before == m.after and m.error > 0 for m in found.moved)
    fitted = simulate(compile(found.diagram, record=["theta"]))
    same = simulate(compile(found.original, record=["theta"]), parameters=found.declared)
    assert fitted["theta"] == pytest.approx(same["theta"], abs=1e-3)
    assert found.rmse_after == found.rmse_before


def test_an_offset_of_the_sensor_is_named_as_such(tmp_path: Path) -> None:
    found = traced(write_pendulum(tmp_path, offset=0.02))
    assert found.verdict == "effect"
    named = found.effects[0]
    everything = {f"{named.name} @ {named.place}", *map(str, named.ties)}
    assert any("sensor_offset @ sensor.theta" in text for text in everything)
    if named.name == "sensor_offset":
        assert named.params["offset"] == pytest.approx(0.02, rel=0.05)


def test_the_edited_diagram_keeps_comments_and_says_what_was_found(
    swing: Path, found: Found
) -> None:
    before = swing.read_text()
    edited = found.apply()
    assert swing.read_text() == before, "nothing is written unless it is asked for"
    assert "# a comment that must survive" in edited.text
    assert "coulomb" in edited.blocks
    assert edited.blocks["acceleration"].inputs["of"][-1].signal == "coulomb"
    unchanged = set(before.splitlines()) & set(edited.text.splitlines())
    assert len(before.splitlines()) - len(unchanged) <= 4


def test_with_the_effect_in_its_diagram_nothing_is_missing(found: Found) -> None:
    again = trace(compile(found.apply()))
    assert again.verdict == "null"
    assert again.rmse_after == pytest.approx(found.rmse_after, rel=0.1)


def test_a_diagram_that_changed_since_is_not_edited(tmp_path: Path, found: Found) -> None:
    other = read(write_pendulum(tmp_path, end=6.0))
    with pytest.raises(ValueError, match="the diagram has changed since it was traced"):
        found.apply(other)


def test_the_json_has_the_agreed_keys(found: Found) -> None:
    data = json.loads(json.dumps(found.json()))
    assert {"verdict", "effects", "rmse_before", "rmse_after", "sigma"} <= set(data)
    assert data["verdict"] == "effect"
    (effect,) = data["effects"]
    assert {"name", "place", "params", "ties"} <= set(effect)
    assert all(isinstance(tie, str) for tie in effect["ties"])


def test_a_fit_is_traced_from_its_values_on_its_series(swing: Path, found: Found) -> None:
    told: list[str] = []
    again = trace(fit(compile(read(swing))), progress=told.append)
    assert [e.name for e in again.effects] == ["coulomb"]
    assert again.effects[0].params["level"] == pytest.approx(found.effects[0].params["level"], 0.02)
    assert told[0] == "fitting the declared model" and "screening effects" in told


def test_ctrl_c_keeps_what_was_found_so_far(swing: Path) -> None:
    def stop(text: str) -> None:
        if text.startswith("comparing"):
            raise KeyboardInterrupt

    found = trace(compile(read(swing)), progress=stop)
    assert found.interrupted
    assert [e.name for e in found.effects] == ["coulomb"]
    assert found.experiments == ()


def test_ctrl_c_before_anything_is_known_is_ctrl_c(swing: Path) -> None:
    def stop(text: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        trace(compile(read(swing)), progress=stop)


def test_a_series_that_is_too_short_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="'swing' has 26 samples"):
        traced(write_pendulum(tmp_path, end=0.5))


def test_without_measured_data_there_is_nothing_to_trace(tmp_path: Path) -> None:
    path = write_pendulum(tmp_path)
    path.write_text(path.read_text().split("measured:")[0])
    with pytest.raises(TracewireError, match="names no measured series"):
        traced(path)


def test_a_diagram_that_does_not_run_is_told_with_its_block(tmp_path: Path) -> None:
    path = write_pendulum(tmp_path, end=6.0)
    text = path.read_text().replace("k: -w0_squared}", "k: -w0_squared/(c - c)}")
    path.write_text(text)
    with pytest.raises(FitError, match="'gravity' is not finite"):
        traced(path)


def test_a_validate_series_with_another_signal_is_refused_before_the_work(tmp_path: Path) -> None:
    path = write_pendulum(tmp_path, end=6.0)
    other = "  other: {file: swing.csv, use: validate, time: t, signals: {omega: theta}}\n"
    path.write_text(path.read_text() + other)
    with pytest.raises(DataError, match="'omega', which no train series measures"):
        traced(path)
