"""How a case is driven and measured: drawn for every case and draw, from its own stream."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.unmodelled import KINDS
from benchmarks.tracing.plants import PLANTS

ALONE = 1 / 3  # share of cases with one series, which the trace splits itself
OPEN = ("sine", "sine", "multisine", "multisine", "steps")
CLOSED = ("output", "output", "reference")
NOISES = ("white", "ar1", "ar1", "lowpass")
MARKS = ("plain", "plain", "quantised", "quantised", "filtered", "interpolated", "jitter")
TONE = ("drive_2nd_harm", "drive_3rd_harm")  # effects that need the sine
OPEN_ONLY = ("drive_gain", "drive_lag", "sensor_delay", *TONE)


@dataclass(frozen=True)
class Scenario:
    """What differs between rigs. `drive`: sine, multisine, steps, output (of a controller, which is
    recorded), reference (of a controller, which the diagram has), or free."""

    drive: str
    noise: str
    mark: str
    floor: tuple[str, ...]  # what it is made of
    trains: int
    alone: bool
    every: float  # s
    seconds: float
    rates: bool  # whether the rate is measured, too
    stated: bool  # whether the diagram states sigma
    rest: bool  # whether a free decay ends at rest
    share: float  # of the excess that is the floor's

    @property
    def continued(self) -> bool:
        """Whether the unseen record goes on where the only series ends: what a drive or a wave has
        of its own in a series could not be known of another."""
        return self.alone and self.drive != "free"


def stream(case: Case, what: str, attempt: int = 0) -> np.random.Generator:
    """Random numbers of a case for one purpose; draws and purposes share nothing."""
    text = f"{case.name} / draw {case.draw} / {what} / {attempt}"
    return np.random.default_rng(int.from_bytes(hashlib.sha256(text.encode()).digest()))


def draw_scenario(case: Case, again: int = 0) -> Scenario:
    """The rig of a case; `again` where no numbers made a case of the first ones."""
    rng = stream(case, "scenario", again)
    names = {h.name for h in case.hidden}
    if not PLANTS[case.system].drive:
        drive = "free"
    elif names & set(TONE):
        drive = "sine"
    elif names & set(OPEN_ONLY) or rng.random() < 0.72:
        drive = str(rng.choice(OPEN))
    else:
        drive = str(rng.choice(CLOSED))
    alone = bool(rng.random() < ALONE)
    trains = 1 if alone else int(rng.choice([1, 2, 2, 3, 3]))
    samples = int(rng.integers(1500, 3001) if alone else rng.integers(800, 1501))
    every = float(rng.choice([0.005, 0.01, 0.01]))
    seconds = float(np.clip(samples * every, 7.0, 24.0))
    mark = str(rng.choice(MARKS))
    return Scenario(
        drive,
        str(rng.choice(NOISES)),
        "filtered" if mark == "interpolated" and drive == "steps" else mark,
        ("bumps", *map(str, rng.permutation(KINDS)[: int(rng.integers(1, 3))])),
        trains,
        alone,
        every,
        round(seconds, 2),
        bool(rng.random() < 0.2),
        bool(rng.random() < 0.3),
        bool(rng.random() < 0.6),
        float(np.exp(rng.uniform(np.log(0.012), np.log(0.09)))),
    )
