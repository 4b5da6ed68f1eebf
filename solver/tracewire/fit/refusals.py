"""What a fit refuses before it begins."""

from __future__ import annotations

from collections.abc import Sequence

from tracewire.compile import Model
from tracewire.errors import DataError, OptionError, Problem
from tracewire.fit.optimset import Options
from tracewire.residual import Criterion, Measured
from tracewire.solve import parameter_values


def refuse_simplex_tolerances(options: Options, method: str) -> None:
    """Raises OptionError: tolerances of the simplex for a method that has none."""
    usual = Options()
    given = [name for name in ("TolX", "TolFun") if getattr(options, name) != getattr(usual, name)]
    if given and method != "fminsearch":
        what = f"{' and '.join(given)} of a search by {method}: only fminsearch has such tolerances"
        raise OptionError.one(what, hint="Take the method fminsearch, or leave them out.")


def refuse_unusable(series: Sequence[Measured], train: Sequence[Measured]) -> None:
    """Raises DataError: nothing to fit to, sensors that look back beyond their record."""
    if not train:
        what = f"no series is for training: {', '.join(f'{m.name} ({m.use})' for m in series)}"
        raise DataError.one(what, hint="Give one `use: train`, or leave `use:` out.")
    problems = [
        Problem(
            f"the delay of '{signal}' in '{m.name}' is {sensor.delay:g} s, "
            f"and the record is {m.t[-1] - m.t[0]:g} s long",
            hint="Is it in s? Correct `delay:`.",
        )
        for m in series
        for signal, sensor in m.sensors.items()
        if abs(sensor.delay) >= m.t[-1] - m.t[0]
    ]
    if problems:
        raise DataError(problems)


def refuse_presets_of_free(model: Model, train: Sequence[Measured], free: Sequence[str]) -> None:
    """Raises OptionError where presets of several series give a free parameter several values."""
    presets = list(dict.fromkeys(m.preset for m in train))
    if len(presets) < 2:
        return
    known = {preset: parameter_values(model, {}, preset) for preset in presets}
    problems = []
    for name in free:
        values = {preset: known[preset][name] for preset in presets if name in known[preset]}
        if len(set(values.values())) > 1:
            given = ", ".join(
                f"{value:g} ({preset or 'no preset'})" for preset, value in values.items()
            )
            what = f"'{name}' is free and the same for all series, and their presets say {given}"
            problems.append(Problem(what, hint="Fix it, or take it out of the presets."))
    if problems:
        raise OptionError(problems)


def refuse_few_samples(criterion: Criterion) -> None:
    """Raises DataError: no more measured values than unknowns."""
    samples = sum(len(s.rows) * len(s.signals) for s in criterion.segments)
    unknowns = len(criterion.scales)
    if samples <= unknowns:
        what = f"{samples} measured values cannot determine {unknowns} unknowns"
        hint = "Fix some parameters or start values, or measure more."
        raise DataError([Problem(what, hint=hint)])
