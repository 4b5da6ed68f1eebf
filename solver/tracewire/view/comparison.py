"""A measured series beside a run: the conditions of the run, the residual, and the criterion.

What reads and compares measured data is imported when a page asks for it: a page opens sooner.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tracewire.compile import Model
from tracewire.solve import Limits
from tracewire.view.frame import Arrays
from tracewire.view.limits import VIEW

if TYPE_CHECKING:
    from tracewire.residual import Measured, Segment


@dataclass(frozen=True, eq=False)
class SeriesConditions:
    """A measured series and the segment that is run for it: its begin, start and inputs."""

    measured: Measured
    segment: Segment

    @property
    def span(self) -> tuple[float, float]:
        """From the begin of the run to the last sample, in s."""
        return self.segment.begin, float(self.measured.t[-1])


def conditions_of(model: Model, series: str, limits: Limits) -> SeriesConditions:
    """The conditions of a series of the diagram, with a free start fitted to its data.

    It is fitted with the values of the diagram, so that the criterion of a fitted diagram is that
    of its fit. Where a run fails or takes long, the start is read off the data.
    Raises OptionError: no such series; DataError: a file that cannot be used.
    """
    from tracewire.residual import Criterion, measured_series, solve_least_squares, whole_segment

    measured = measured_series(model, series)
    segment = whole_segment(model, measured)
    quick = replace(limits, seconds=min(limits.seconds, VIEW.quick))
    alone = Criterion(model, [segment], (), measured.parameters, limits=quick)
    begin = alone.initial_unknowns()
    alone.residuals(begin)
    if segment.free and alone.failure is None:
        _, (start,) = alone.unpack(solve_least_squares(alone, begin).z)
        segment = replace(segment, start={**segment.start, **start})
    return SeriesConditions(measured, segment)


def comparison_of(
    model: Model,
    known: SeriesConditions,
    values: Mapping[str, float],
    limits: Limits,
    arrays: Arrays,
) -> dict[str, Any]:
    """The samples of a series, the residual of each signal, and the criterion, as a head of JSON.

    values: those of parameters in SI that are not the file's. The criterion is that of a fit with
    this series alone. Raises SimulationError, DataError.
    """
    from tracewire.residual import Criterion, half_square, wrap_to_period

    measured = known.measured
    signals = list(measured.values)
    head: dict[str, Any] = {"name": measured.name, "signals": {}}
    if not signals:  # a series of inputs alone
        return head
    criterion = Criterion(model, [known.segment], (), values, limits=limits)
    (start,) = criterion.unpack(criterion.initial_unknowns())[1]
    rows = known.segment.rows
    shown = criterion.outputs(known.segment, {}, start)
    weighed = criterion.residuals(criterion.initial_unknowns())
    if criterion.failure is not None:
        raise criterion.failure
    head["criterion"] = half_square(criterion.weigh(weighed))
    chosen = np.unique(np.linspace(0, len(rows) - 1, min(len(rows), VIEW.most_dots)).astype(int))
    t = arrays.keep(measured.t[rows][chosen], exact=True)
    for n, name in enumerate(signals):
        look = model.flat.shown.get(name)
        factor = look.factor if look is not None else 1.0
        samples = measured.values[name][rows]
        residual = wrap_to_period(samples - shown[:, n], measured.periods.get(name, 0.0))
        head["signals"][name] = {
            "t": t,
            "values": arrays.keep(samples[chosen] / factor),
            "residual": arrays.keep(residual[chosen] / factor),
            "rms": float(np.sqrt(np.mean(residual**2))) / factor,
        }
    return head
