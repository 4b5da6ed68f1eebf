"""Real records, where they are at hand: how they read, and what is said of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.data import Record, read_columns, read_record, signal_remarks, time_remarks
from tracewire.errors import DataError

DATA = Path(__file__).parents[3] / "shared/data"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the measured series are not here")


def told(record: Record) -> list[str]:
    found = [*record.remarks, *time_remarks(record.t)]
    for name, column in record.columns.items():
        found += signal_remarks(name, record.t, column, record.unit(name).text)
    return found


def test_a_tribometer_log_says_its_units() -> None:
    columns = {"normal": "Normal", "x": "Position", "friction": "Friction"}
    record = read_record(DATA / "tribometer_presliding/test_data_2.txt", columns, "Time")
    derived = read_record(
        DATA / "tribometer_presliding/derived_20-60s.csv",
        {"normal": "normal_N", "x": "position_mm", "friction": "friction_N"},
        "t_s",
        units={"x": "mm"},
    )
    part = record.trim(20.0, 59.9999)
    assert len(part.t) == len(derived.t)
    for name in columns:
        moved = 0.10991 if name == "x" else 0.0
        assert part.columns[name] + moved == pytest.approx(derived.columns[name], abs=2e-6)
    assert [step for step in record.steps if "header" in step] == [
        "normal: from uN to N, as the header says",
        "x: from mm to m, as the header says",
        "friction: from uN to N, as the header says",
    ]
    (remark,) = told(record)
    assert remark.startswith("the time step is not regular: 0.005 to 0.01 s, median 0.005 s")


def test_one_drop_of_one_ball() -> None:
    path = DATA / "falling_balls/derived_drops.csv"
    record = read_record(path, {"h": "height_m"}, "t_s", where={"ball": "Golf Ball", "drop": 2})
    assert 30 < len(record.t) < 60
    assert 40 < record.columns["h"][0] < 60
    with pytest.raises(DataError, match="time goes back to 0"):
        read_columns(path, {"h": "height_m"}, "t_s")


def test_a_workbook_under_another_name() -> None:
    """Its first bytes say what it is; each ball has a sheet with two drops."""
    pytest.importorskip("openpyxl")
    file = DATA / "falling_balls/Ball_drops_data.xls"
    with pytest.raises(DataError, match=r"\(Volleyball\):49: time goes back to 0"):
        read_columns(file, {"h": "Volleyball/Height (m)"}, "Volleyball/Time (s)")


@pytest.mark.parametrize("run", ["4.1", "4.2", "4.4"])
def test_columns_of_a_matrix_and_their_export(run: str) -> None:
    columns = {"x": "x_F[1]", "force": "x_F[3]"}
    raw = read_columns(DATA / f"mr_damper/data_simulation_{run}_MRdamper.mat", columns, every=0.01)
    named = {"x": "displacement_mm", "force": "force_N"}
    derived = read_columns(DATA / f"mr_damper/derived_{run}.csv", named, "t_s")
    assert np.allclose(raw.time, derived.time)
    for name in columns:
        assert np.allclose(raw.values[name], derived.values[name], atol=1e-3)
    assert told(Record(raw.time, raw.values)) == []


def test_a_record_that_was_interpolated_is_found_out() -> None:
    columns = {"x": "x_F[1]", "force": "x_F[3]"}
    path = DATA / "mr_damper/data_simulation_4.3_MRdamper.mat"
    remarks = told(read_record(path, columns, every=0.001))
    assert [remark.partition(" lies on straight lines")[0] for remark in remarks] == ["x", "force"]
    assert all(remark.endswith("it was taken at 100 Hz") for remark in remarks)


def test_cells_and_structs_of_the_pendulum() -> None:
    folder = DATA / "multiarm_pendulum"
    columns = {"theta": "Y_id[1][1]", "omega": "Y_id[1][2]"}
    path = folder / "SinglePendulumDataForParameterEstimation.mat"
    record = read_record(path, columns, "Time_id[1]")
    assert told(record) == []
    derived = folder / "derived_freeswing_large_200Hz.csv"
    theta = read_columns(derived, {"theta": "theta_from_hanging_rad"}, "t_s").values["theta"]
    assert np.min(np.abs(record.columns["theta"][::5][:100] - np.pi - theta[:100])) < 1e-3
    struct = {"theta": "Theta1.signals.values"}
    small = read_record(folder / "SingleDataFreeSwing_1_Dt_0_0001.mat", struct, "Theta1.time")
    assert len(small.t) == 231757
    assert told(small) == []


@pytest.mark.parametrize("wheel", ["axial", "radial"])
def test_a_rate_gyro_is_in_order(wheel: str) -> None:
    name = f"bicycle-wheel-{wheel}-inertia-rate-gyro-measurement.csv"
    path = DATA / "bicycle_wheel_pendulum" / name
    assert told(read_record(path, {"omega": "angular_velocity"}, "time")) == []
