"""CSV files that are made of the files of a set, where no diagram can read those as they are."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tracewire.data.read import read_columns
from tracewire.errors import DownloadError
from tracewire.extras import import_extra

SEGMENTS = (*(f"id[{n}]" for n in (1, 2, 3, 4)), *(f"vad[{n}]" for n in (1, 2)))
LARGE, SMALL = 5, 50  # every fifth of 1 kHz, every fiftieth of 10 kHz: 200 Hz
SMALL_ENDS = 10.0  # s; it stands still from 5.5 s on
COUNTS = 8192  # of the motor's encoder, on a turn
PERIOD = 2500  # samples of a period of the two-mass bench, which takes 1 s
DROPS = ("ball", "drop", "t_s", "height_m", "velocity_m_s")


def swing_large(folder: Path) -> str:
    """The large swing of the multi-arm pendulum: 11001 rows, 0 to 55 s.

    The authors' four segments for estimation and two for validation, which follow each other within
    a sample; every fifth sample; the angle from hanging, theirs is from upright.
    """
    path = folder / "SinglePendulumDataForParameterEstimation.mat"
    parts = [read_columns(path, {"theta": f"Y_{part}[1]"}, f"Time_{part}") for part in SEGMENTS]
    t = np.concatenate([part.time for part in parts])[::LARGE]
    theta = np.concatenate([part.values["theta"] for part in parts])[::LARGE]
    return _swing(t, theta)


def swing_small(folder: Path) -> str:
    """The small swing of the multi-arm pendulum: 2001 rows, 0 to 10 s, t = 0 at 60 s of theirs."""
    path = folder / "SingleDataFreeSwing_1_Dt_0_0001.mat"
    whole = read_columns(path, {"theta": "Theta1.signals.values"}, "Theta1.time")
    t = (whole.time - whole.time[0])[::SMALL]
    kept = t <= SMALL_ENDS + 1e-9
    return _swing(t[kept], whole.values["theta"][::SMALL][kept])


def _swing(t: NDArray[np.float64], theta: NDArray[np.float64]) -> str:
    rows = zip(t, theta - math.pi, strict=True)
    return "t [s],theta [rad]\n" + "".join(f"{a:.3f},{b:.8f}\n" for a, b in rows)


def balls_dropped(folder: Path) -> str:
    """All sheets of the workbook of falling balls in one table, nothing dropped: 1064 rows.

    The file ends in .xls and is an .xlsx. Raises DownloadError where openpyxl is missing.
    """
    purpose = "to read the workbook of the falling balls"
    openpyxl = import_extra("openpyxl", "data", purpose, error=DownloadError)
    lines = [",".join(DROPS)]
    with (folder / "Ball_drops_data.xls").open("rb") as file:  # by its name it would be refused
        book = openpyxl.load_workbook(file, read_only=True, data_only=True)
        for sheet in book.worksheets:
            for drop, *numbers in sheet.iter_rows(min_row=2, max_col=4, values_only=True):
                if drop is not None:
                    lines.append(f"{sheet.title},{drop:g}," + ",".join(f"{x:.6f}" for x in numbers))
    return "\n".join(lines) + "\n"


def motor_turn(folder: Path, name: str) -> str:
    """A record of the motor, an array 3 x N of numpy, as a table: time, angle, current.

    A turn has 8192 counts. Nothing is dropped.
    """
    t, counts, current = np.load(folder / name, allow_pickle=False)
    rows = zip(t, counts * (2 * math.pi / COUNTS), current, strict=True)
    lines = (f"{a:.6f},{b:.7f},{c:.6f}\n" for a, b, c in rows)
    return "t [s],angle [rad],current [A]\n" + "".join(lines)


def bench_period(folder: Path, first: int, last: int) -> str:
    """The mean of periods of the two-mass bench, `first` to `last`, as a table: 2500 rows, 1 s.

    Time, current without its mean, and the speeds of motor and load, which are the derivatives of
    the mean angles as Fourier series of the period (the bench turns nowhere, and the excitation has
    whole periods). The load turns the other way in the file; here it turns with the motor.
    """
    columns = {"current": "iq_adx", "motor": "theta_mx", "load": "theta_my"}
    record = read_columns(folder / "MultisineTypeA.mat", columns, every=1 / PERIOD)
    mean = {
        name: values.reshape(-1, PERIOD)[first - 1 : last].mean(axis=0)
        for name, values in record.values.items()
    }
    omega = 2j * math.pi * np.arange(PERIOD // 2 + 1)  # rad/s: the period is 1 s
    motor, load = (
        np.fft.irfft(omega * np.fft.rfft(sign * mean[name]), PERIOD)
        for name, sign in (("motor", 1), ("load", -1))
    )
    rows = zip(range(PERIOD), mean["current"] - mean["current"].mean(), motor, load, strict=True)
    lines = (f"{n / PERIOD:.4f},{i:.6f},{a:.6f},{b:.6f}\n" for n, i, a, b in rows)
    return "t [s],current [A],motor [rad/s],load [rad/s]\n" + "".join(lines)
