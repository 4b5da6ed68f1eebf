"""Generate the measured records that the diagrams ship with, the same to the byte every time.

python tests/oracles/make_records.py           writes the files and prints their criteria
python tests/oracles/make_records.py --check   compares instead; exit code 1 where one differs
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from oracles import double_torsion, pendulum

Array = NDArray[np.float64]

DIAGRAMS = Path(__file__).resolve().parents[2] / "diagrams"
MADE_BY = "generated; see tests/oracles/make_records.py"

# Paper A, appendix: the start of the fit. The record comes from each value times its factor.
TORSION_START = {
    "alpha": 0.15,
    "beta": 2.2,
    "T_s2_l": 0.025,
    "T_02_l": 0.5,
    "T_s2_r": 0.045,
    "T_02_r": 0.5,
    "k2": 0.7,
    "c2_l": 0.018,
    "c2_r": 0.02,
}
# Signs chosen among those with 3 to 6 increases: far from the start, and yet the column and the
# disk touch both of their barriers in every period of the drive, so that each parameter acts.
TORSION_FACTORS = {
    "alpha": 1.36,
    "beta": 0.69,
    "T_s2_l": 0.62,
    "T_02_l": 1.33,
    "T_s2_r": 1.35,
    "T_02_r": 0.60,
    "k2": 0.68,
    "c2_l": 1.37,
    "c2_r": 0.66,
}
TORSION_NOISE = np.radians(0.02)
TORSION_STEP = np.radians(0.044)
TORSION_TIMES = np.arange(401) / 100.0

PENDULUM_TIMES = np.arange(2001) / 100.0
PENDULUM = {"w0_squared": 63.7, "c": 0.052, "f_c": 0.148}
PENDULUM_NOISE = 1e-3


def torsion_parameters() -> dict[str, float]:
    """The nine parameters behind the record of paper A."""
    return {name: value * TORSION_FACTORS[name] for name, value in TORSION_START.items()}


def torsion_angles(rng: np.random.Generator) -> tuple[Array, Array]:
    """phi1 and phi2 [rad] with noise, then in the steps of the sensors' converter."""
    states = double_torsion.solve(torsion_parameters(), TORSION_TIMES).states
    noisy = states[[0, 2]] + TORSION_NOISE * rng.standard_normal((2, TORSION_TIMES.size))
    phi1, phi2 = np.round(noisy / TORSION_STEP) * TORSION_STEP + 0.0  # + 0.0: no -0.0
    return phi1, phi2


def criterion(measured: Array, parameters: dict[str, float]) -> float:
    """mean((phi2_exp - phi2_num)^2)/2 [rad2], the objective in paper A's appendix."""
    numeric = double_torsion.solve(parameters, TORSION_TIMES).states[2]
    return float(np.mean((measured - numeric) ** 2) / 2.0)


def torsion_record() -> str:
    """The text of papers/a_torsion/measured.csv: 401 rows, 0 to 4 s every 0.01 s."""
    phi1, phi2 = torsion_angles(np.random.default_rng(4100))
    head = (
        "Double torsion pendulum (paper A): a stand-in for the authors' series, not a measurement",
        MADE_BY,
        "the final model, the nine parameters of the fit changed by 30 to 40 %, others as given",
        "gaussian noise of 0.02 deg on both angles, then steps of 0.044 deg; 401 rows, 0 to 4 s",
        "t: time in s; phi1: column against base, phi2: disk against column, both in rad",
    )
    columns = ("t [s]", "phi1 [rad]", "phi2 [rad]")
    return _text(head, columns, "{:.2f},{:.7f},{:.7f}", TORSION_TIMES, phi1, phi2)


def pendulum_record(theta_degrees: float, seed: int) -> str:
    """The text of one free swing from rest at theta: 2001 rows, 0 to 20 s every 0.01 s."""
    swing = pendulum.solve(PENDULUM_TIMES, float(np.radians(theta_degrees)), **PENDULUM)
    noise = PENDULUM_NOISE * np.random.default_rng(seed).standard_normal(PENDULUM_TIMES.size)
    theta = np.round(swing.theta + noise, 4) + 0.0  # + 0.0: no -0.0
    head = (
        f"A pendulum let go from rest at about {theta_degrees:.0f} degrees, swinging freely",
        MADE_BY,
        "sensor noise about 0.001 rad; 2001 rows, 0 to 20 s",
        "t: time in s; theta: angle from the downward vertical in rad",
    )
    columns = ("t [s]", "theta [rad]")
    return _text(head, columns, "{:.2f},{:.4f}", PENDULUM_TIMES, theta)


def _text(head: tuple[str, ...], columns: tuple[str, ...], row: str, *series: Array) -> str:
    lines = [f"# {line}" for line in head]
    lines.append(",".join(columns))
    lines.extend(row.format(*values) for values in zip(*series, strict=True))
    return "\n".join(lines) + "\n"


RECORDS: dict[str, Callable[[], str]] = {
    "papers/a_torsion/measured.csv": torsion_record,
    "lessons/pendulum_swing.csv": lambda: pendulum_record(80.0, 8100),
    "lessons/pendulum_swing_2.csv": lambda: pendulum_record(30.0, 8200),
}


def differing() -> list[str]:
    """The records whose files are missing or are not what this script makes."""
    return [
        name
        for name, make in RECORDS.items()
        if not (DIAGRAMS / name).is_file() or (DIAGRAMS / name).read_bytes() != make().encode()
    ]


def main() -> int:
    """Write or check all records."""
    parser = argparse.ArgumentParser(description="Generate the shipped measured records.")
    parser.add_argument("--check", action="store_true", help="compare, and write nothing")
    if parser.parse_args().check:
        wrong = differing()
        sys.stdout.writelines(f"differs: diagrams/{name}\n" for name in wrong)
        return 1 if wrong else 0
    for name, make in RECORDS.items():
        path = DIAGRAMS / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(make().encode())
        sys.stdout.write(f"wrote diagrams/{name}\n")
    measured = torsion_angles(np.random.default_rng(4100))[1]
    floor = criterion(measured, torsion_parameters())
    start = criterion(measured, TORSION_START)
    sys.stdout.write(
        f"criterion of phi2 [rad2]: {floor:.4e} at the true parameters, {start:.4e} at the start, "
        f"ratio {start / floor:.1f}\n"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
