"""Which part of the data does what: fit (train), accept (gate), the final claim (validate)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracewire.compile import Model
from tracewire.data import usual_range
from tracewire.errors import DataError, Problem
from tracewire.residual import Measured, Section, Segment, cut_windows, noise_of_signal
from tracewire.trace.data_thresholds import SplitOptions
from tracewire.trace.options import TraceOptions
from tracewire.trace.trials.period import passing_period


@dataclass(frozen=True, eq=False)
class DataSplit:
    """Sections of series by use, and how they came about in words.

    Train and gate are cut into windows; validation is run as a whole.
    """

    train: tuple[Section, ...]
    gate: tuple[Section, ...]
    validate: tuple[Section, ...]
    words: tuple[str, ...]

    def windows(
        self, model: Model, sections: Sequence[Section], length: int, free: Sequence[str]
    ) -> list[Segment]:
        """The windows of some sections."""
        return [
            window for section in sections for window in cut_windows(model, section, length, free)
        ]

    @property
    def longest(self) -> int:
        """The samples of the longest train section."""
        return max(section.count for section in self.train)

    @property
    def unseen(self) -> list[Section]:
        """What no fit and no choice of an effect sees: the last part of a run, or other runs."""
        return [*self.validate, *(s for s in self.gate if s.measured.use == "gate")]

    @property
    def other_runs(self) -> list[Section]:
        """The unseen sections of runs of which no part is fitted."""
        return [section for section in self.unseen if section.measured.use != "train"]

    def whole(self) -> list[Section]:
        """Each train series over all that is not held back for the final claim."""
        ends: dict[str, Section] = {}
        for section in (*self.train, *self.gate):
            measured = section.measured
            if measured.use == "train":
                known = ends.get(measured.name)
                end = max(section.end, known.end if known else 0)
                ends[measured.name] = Section(measured, 0, end)
        return list(ends.values())


def split_data(measured: Sequence[Measured], options: SplitOptions) -> DataSplit:
    """The sections of the measured series.

    Without a series for it, every third ninth of the train series is the gate (the last third where
    a ninth is too short for a window), and the last sixth is held back for the final claim. Of a
    run that ends at rest these are parts of its moving part, and the claim goes on into the rest
    for as long again: that a model comes to rest counts, how long it lies there does not.

    Raises DataError where a gate or validate series measures what no train series does.
    """
    by_use = {use: [m for m in measured if m.use == use] for use in ("train", "gate", "validate")}
    fitted = {signal for m in by_use["train"] for signal in m.values}
    for m in (*by_use["gate"], *by_use["validate"]):
        for signal in sorted(set(m.values) - fitted):
            what = f"the series '{m.name}' measures '{signal}', which no train series measures"
            raise DataError([Problem(what, hint="Leave it out, or train with it.")])
    train: list[Section] = []
    gate = [Section(m, 0, len(m.t)) for m in by_use["gate"]]
    validate = [Section(m, 0, len(m.t)) for m in by_use["validate"]]
    words = []
    for m in by_use["train"]:
        end = len(m.t)
        if not by_use["validate"]:
            share, moving, claimed = 1 - options.validated, _moving_samples(m, options), len(m.t)
            end, rests = int(share * claimed), moving <= share * claimed
            enough = share * moving >= options.few_blocks * options.shortest
            last = f"the last {_part(options.validated)} of '{m.name}'"
            if rests and enough:
                last += f" before it settles, at {m.t[moving]:.4g} s,"
                end = int(share * moving)
                claimed = min(2 * moving - end, claimed)
            words.append(f"{last} is held back for the final claim")
            if rests and not enough:
                words.append(
                    f"nothing moves in {last}, so that the free runs there tell little: name"
                    " another run under `measured:`, with `use: validate`"
                )
            validate.append(Section(m, end, claimed))
        if by_use["gate"]:
            train.append(Section(m, 0, end))
            continue
        enough = end >= options.blocks * options.shortest
        blocks = options.blocks if enough else options.few_blocks
        parts = f"every third of {blocks} equal parts" if blocks > 3 else "the last third"
        rest = f"the rest of '{m.name}'" if not by_use["validate"] else f"'{m.name}'"
        words.append(f"{parts} of {rest} is not fitted: there an effect must help, too (the gate)")
        edges = np.linspace(0, end, blocks + 1).astype(int).tolist()
        for n in range(0, blocks, 3):
            train.append(Section(m, edges[n], edges[n + 2]))
            gate.append(Section(m, edges[n + 2], edges[n + 3]))
    return DataSplit(tuple(train), tuple(gate), tuple(validate), tuple(words))


def shortest_window(model: Model, data_split: DataSplit, options: TraceOptions) -> int:
    """The samples of the shortest window: about a fifth of the slowest series' period, at least 16.

    A series without a period, as of a falling body, has no phase that a long run could lose: it is
    one window. What goes round many times has a turn for its period, and a body on a spring that
    sticks and slips the time between its moves.
    """
    split, lengths = options.split, list[float]()
    for section in data_split.train:
        for name in section.measured.values:
            period = passing_period(model, name, section, options)
            lengths.append(min(period, split.in_a_period * section.count))
    longest = max(data_split.longest, split.shortest)
    return int(np.clip(np.median(lengths) / split.in_a_period, split.shortest, longest))


def _moving_samples(measured: Measured, options: SplitOptions) -> int:
    """The samples before all signals settle: from there on each moves through no more than a part
    of its range and what white noise does, sigma 2 sqrt(2 ln n) for n samples."""
    last = 0
    for name, y in measured.values.items():
        low, high = usual_range(y)
        noise = measured.sigma.get(name) or noise_of_signal(y, measured.t).level
        behind = y[::-1]
        ranges = (np.maximum.accumulate(behind) - np.minimum.accumulate(behind))[::-1]
        by_noise = 2 * noise * np.sqrt(2 * np.log(np.arange(len(y), 0, -1)))
        last = max(last, int(np.count_nonzero(ranges > options.moving * (high - low) + by_noise)))
    return last


def _part(part: float) -> str:
    """A part in words: `sixth`, else `12 %`."""
    names = {3: "third", 4: "quarter", 5: "fifth", 6: "sixth", 9: "ninth", 10: "tenth"}
    return next((n for k, n in names.items() if abs(part * k - 1) < 1e-9), f"{part:.0%}")
