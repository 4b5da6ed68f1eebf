"""`Plane`: when a point of a Poincaré section is taken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tracewire.analyse.drive import number, period_of, rising_edges
from tracewire.analyse.limits import SECTION
from tracewire.array_types import Matrix, Vector
from tracewire.compile import Model
from tracewire.errors import AnalysisError, OptionError, Problem, unknown
from tracewire.formula import evaluate
from tracewire.solve import Passage, guard_crossings, parameter_values
from tracewire.solve.core.codes import LOG_HEAD


@dataclass(frozen=True)
class Plane:
    """When the points of a section are taken: one of `period`, `edge`, `guard`.

    `period` in s, or a formula of the parameters ("2*pi/omega"): once a period, at the time
    `phase`, in s or such a formula ("0.5/f"), and its multiples on. `edge`: where a source that
    jumps periodically rises, such as a square wave. `guard`: where a guard crosses zero in
    `direction`, by its text as the log of events has it, or by its block; the states x⁻ there.
    """

    period: float | str | None = None
    edge: str = ""
    guard: str = ""
    phase: float | str = 0.0
    direction: Literal["up", "down", "both"] = "up"

    def check(self, model: Model) -> None:
        """Raises OptionError where it does not fit the model."""
        given = [self.period is not None, bool(self.edge), bool(self.guard)]
        if sum(given) != 1:
            what = "a section needs one of a period, an edge and a guard"
            hint = "Write period='2*pi/omega', edge='torque' or guard='x - 1'."
            raise OptionError([Problem(what, hint=hint)])
        if self.direction not in ("up", "down", "both"):
            raise OptionError([unknown("direction", self.direction, ("up", "down", "both"))])
        guards = {text for mode in model.modes for text in (mode.text, mode.signal) if text}
        if self.guard and self.guard not in guards:
            raise OptionError([unknown("guard", self.guard, guards)])

    def rhythm(
        self, model: Model, parameters: Mapping[str, float], preset: str
    ) -> tuple[float, float] | None:
        """The first instant and the period in s; None for a guard. Raises OptionError."""
        if self.guard:
            return None
        if self.edge:
            return rising_edges(model, self.edge, parameters, preset)
        assert self.period is not None
        values = parameter_values(model, parameters, preset)
        return (
            number(model, self.phase, values, "phase"),
            period_of(model, self.period, values),
        )


def span_of(model: Model, values: Mapping[str, float]) -> tuple[float, float]:
    """The diagram's span in s."""
    begin, end = (float(evaluate(formula, values)) for formula in model.flat.span)
    return begin, end


def crossings(passage: Passage, plane: Plane, skip: int, keep: int) -> tuple[Vector, Matrix]:
    """Go on until a guard has crossed skip + keep times: the last `keep` times and states x⁻.

    Raises AnalysisError where it does not cross as often within a hundred spans of the diagram.
    """
    model, n = passage.model, len(passage.model.states)
    low, high = span_of(model, passage.parameters)
    begin, length = passage.t, abs(high - low) or 1.0
    chunk, count = SECTION.first_chunk * length, 0
    kept: list[Matrix] = []
    while count < skip + keep:
        passage.go_to(passage.t + chunk)
        rows = guard_crossings(model, plane.guard, plane.direction, passage.log)
        kept.append(rows[:, : LOG_HEAD + n])
        count += len(kept[-1])
        gone = passage.t - begin
        if count < skip + keep and gone > SECTION.longest * length:
            what = (
                f"'{plane.guard}' crosses {count} times in {gone:g} s, and {skip + keep} points "
                "are asked for"
            )
            hint = "Ask for fewer points (skip, keep), or look where the motion goes."
            raise AnalysisError([Problem(what, hint=hint)])
        mean = gone / count if count else 2 * chunk
        chunk = min(max((skip + keep - count) * mean, SECTION.first_chunk * length), length)
    rows = np.concatenate(kept)[skip : skip + keep]
    return rows[:, 0], rows[:, LOG_HEAD:]
