"""The records of diagrams/demo, generated from its full diagram; the same every time.

python tests/papers/demo_records.py           writes the files
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import tracewire as tw

FOLDER = Path(__file__).parents[2] / "diagrams" / "demo"
SERIES = ("as_in_the_paper", "slow", "fast", "weak", "strong")
STARTS = (-13.0, 8.0, -5.0, 11.0, 2.0)  # deg, of the column, at rest
SIGMA = np.radians(0.05)
SEED = 2100


def record(name: str) -> str:
    """The text of a record: 801 rows, 0 to 8 s, phi1 and phi2 in rad with noise of 0.05 deg."""
    number = SERIES.index(name)
    model = tw.compile(tw.read(FOLDER / "full.yaml"))
    start = {"phi1": float(np.radians(STARTS[number]))}
    run = tw.simulate(model, preset=name, start=start, rtol=1e-9)
    rng = np.random.default_rng(SEED + number)
    phi1, phi2 = (
        run[signal] + SIGMA * rng.standard_normal(run.t.size) for signal in ("phi1", "phi2")
    )
    lines = [
        "# generated from full.yaml, not a measurement; noise of 0.05 deg on both angles",
        "t [s],phi1 [rad],phi2 [rad]",
        *(f"{t:.2f},{a:.6f},{b:.6f}" for t, a, b in zip(run.t, phi1, phi2, strict=True)),
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the records."""
    for name in SERIES:
        (FOLDER / f"{name}.csv").write_text(record(name), encoding="utf-8")
        sys.stdout.write(f"wrote diagrams/demo/{name}.csv\n")


if __name__ == "__main__":
    main()
