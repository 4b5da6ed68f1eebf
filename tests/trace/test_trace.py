"""From a record with a hidden effect to its name, its size, and the edited diagram."""

from __future__ import annotations

from pathlib import Path

import pytest
from oracles.swing import write_pendulum
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError, FitError, TracewireError
from tracewire.trace import Found, trace


def traced(path: Path) -> Found:
    return trace(compile(read(path)))


@pytest.mark.slow
def test_a_hidden_coulomb_friction_is_named_with_its_size(tmp_path: Path) -> None:
    found = traced(write_pendulum(tmp_path, f_c=0.3))
    assert found.verdict == "effect"
    assert [(e.name, e.place) for e in found.effects] == [("coulomb", "acceleration")]
    assert found.effects[0].params["level"] == pytest.approx(0.3, rel=0.05)
    assert found.values["c"] == pytest.approx(0.06, abs=0.02)
    assert found.s2_after == pytest.approx(0.83, abs=0.05), "the mean square of this noise"
    assert found.rmse_after < 1.2e-3 < found.rmse_before


@pytest.mark.slow
def test_nothing_is_found_where_nothing_is_missing(tmp_path: Path) -> None:
    found = traced(write_pendulum(tmp_path))
    assert found.verdict == "null"
    assert found.effects == ()
    assert found.patch == ""
    assert found.rmse_after == found.rmse_before


@pytest.mark.slow
def test_an_offset_of_the_sensor_is_named_as_such(tmp_path: Path) -> None:
    path = write_pendulum(tmp_path, offset=0.02)
    found = traced(path)
    assert found.verdict == "effect"
    named = found.effects[0]
    assert named.place in ("sensor.theta", "acceleration")
    everything = {f"{named.name} @ {named.place}", *named.ties}
    assert "sensor_offset @ sensor.theta" in everything
    if named.name == "sensor_offset":
        assert named.params["offset"] == pytest.approx(0.02, rel=0.05)


@pytest.mark.slow
def test_the_edited_diagram_keeps_comments_and_says_what_was_found(tmp_path: Path) -> None:
    path = write_pendulum(tmp_path, f_c=0.3)
    before = path.read_text()
    found = traced(path)
    edited = found.apply()
    assert path.read_text() == before, "nothing is written unless it is asked for"
    assert "# a comment that must survive" in edited.text
    assert "coulomb" in edited.blocks
    assert edited.blocks["acceleration"].inputs["of"][-1].signal == "coulomb"
    unchanged = set(before.splitlines()) & set(edited.text.splitlines())
    assert len(before.splitlines()) - len(unchanged) <= 4
    again = trace(compile(edited))
    assert again.verdict == "null"
    assert again.rmse_after == pytest.approx(found.rmse_after, rel=0.1)


def test_the_json_has_the_agreed_keys(tmp_path: Path) -> None:
    found = traced(write_pendulum(tmp_path, end=6.0))
    data = found.as_json()
    assert {"verdict", "effects", "rmse_before", "rmse_after", "sigma"} <= set(data)
    assert data["verdict"] in ("null", "effect", "unexplained")


def test_a_series_that_is_too_short_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="51 samples, too few to trace anything"):
        traced(write_pendulum(tmp_path, end=1.0))


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
