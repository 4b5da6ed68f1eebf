"""What a page asks to run: values, preset and measured series, and the run that they give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from tracewire.compile import Model
from tracewire.formula import Name, evaluate
from tracewire.solve import Limits, Run, parameter_values, simulate
from tracewire.view.comparison import SeriesConditions
from tracewire.view.limits import VIEW


@dataclass(frozen=True, eq=False)
class Setting:
    """A model with `given` values in SI that differ from its file, and all `values` that follow.

    `series`: the measured series whose conditions the run has; it has a preset of its own.
    """

    model: Model
    given: Mapping[str, float]
    values: Mapping[str, float]
    preset: str
    series: SeriesConditions | None

    @property
    def span(self) -> tuple[float, float]:
        """From and to, in s."""
        if self.series is not None and self.series.measured.start:
            return self.series.span
        begin, end = (float(evaluate(f, self.values)) for f in self.model.flat.span)
        return begin, end

    @property
    def overruled(self) -> list[str]:
        """The start values of blocks in whose place the measured series has its own."""
        own = {} if self.series is None else self.series.segment.start
        starts = [state.start for state in self.model.flat.states if state.name in own]
        named = [start.name for start in starts if isinstance(start, Name)]
        return [name for name in named if name.rpartition(".")[2].startswith("start")]

    def run(self, limits: Limits, progress: Callable[[float, float], object] | None = None) -> Run:
        """The run of the setting. Raises OptionError, SimulationError."""
        begin, end = self.span
        known = self.series
        return simulate(
            self.model,
            parameters=self.given,
            preset=self.preset,
            start=None if known is None else known.segment.start,
            inputs=None if known is None else known.measured.inputs,
            span=(begin, end),
            times=np.linspace(begin, end, VIEW.samples) if begin < end else None,
            limits=limits,
            progress=progress,
        )


def setting_of(
    model: Model, given: Mapping[str, float], preset: str, series: SeriesConditions | None
) -> Setting:
    """A setting with the values of all parameters. Raises OptionError, SimulationError."""
    if series is not None:
        given, preset = {**series.measured.parameters, **given}, series.measured.preset
    return Setting(model, given, parameter_values(model, given, preset), preset, series)
