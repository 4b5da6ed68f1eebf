"""The setting of a statement in numbers: what a run, and what an analysis, is given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

from tracewire.analyse.limits import QUANTITY
from tracewire.analyse.plane import span_of
from tracewire.compile import Model
from tracewire.diagram import Setting, Value
from tracewire.errors import OptionError, unknown
from tracewire.formula import evaluate
from tracewire.residual import measured_series
from tracewire.solve import Options, parameter_values


@dataclass(frozen=True)
class Conditions:
    """What a run is given, `options` of `simulate`, and which of its samples count.

    `samples` evenly spaced ones from `since` in s to the end, or those that the diagram has.
    `study` holds what analyses need: numbers in SI, and words. `modulo` and `over` are in SI.
    """

    options: Options = field(default_factory=lambda: Options())
    since: float | None = None
    samples: int | None = None
    study: Mapping[str, float | str] = field(default_factory=dict)
    modulo: Mapping[str, float] = field(default_factory=dict)
    over: Mapping[str, tuple[float, ...]] = field(default_factory=dict)


def conditions_of(model: Model, setting: Setting, full: bool = False) -> Conditions:
    """The numbers of a setting; with `full` those of the longest runs.

    Raises OptionError, FormulaError and SimulationError: a preset, parameter or state that is not
    there, a value that is not finite or that the diagram does not allow.
    """
    given = with_full(setting) if full else setting
    options = Options(rtol=QUANTITY.rtol)
    if given.series:
        options |= measured_series(model, given.series).conditions
    preset = given.preset or options.get("preset", "")
    before = parameter_values(model, options.get("parameters") or {}, preset)
    own = {name: _number(value, before) for name, value in given.values.items()}
    parameters = {**(options.get("parameters") or {}), **own}
    values = parameter_values(model, parameters, preset)
    start = {name: _number(value, values) for name, value in given.start.items()}
    wrong = [unknown("state", name, model.states) for name in start if name not in model.states]
    if wrong:
        raise OptionError(wrong)
    options["preset"], options["parameters"] = preset, parameters
    options["start"] = {**(options.get("start") or {}), **start}
    if given.begin is not None or given.until is not None:
        first, last = options.get("span") or span_of(model, values)
        first = first if given.begin is None else _number(given.begin, values)
        options["span"] = (first, last if given.until is None else _number(given.until, values))
    study = {
        key: value if isinstance(value, str) else _number(value, values)
        for key, value in given.options.items()
    }
    if "rtol" in study:
        options["rtol"] = float(study["rtol"])
    since = None if given.since is None else _number(given.since, values)
    modulo = {name: _number(value, values) for name, value in given.modulo.items()}
    return Conditions(options, since, given.samples, study, modulo, given.over)


def with_full(setting: Setting) -> Setting:
    """The setting with what it has for the longest runs."""
    if setting.full is None:
        return setting
    more, usual = setting.full, Setting()
    changed = {
        f.name: getattr(more, f.name)
        for f in fields(Setting)
        if f.name not in ("place", "options") and getattr(more, f.name) != getattr(usual, f.name)
    }
    options = {**setting.options, **more.options}
    return replace(replace(setting, full=None), **changed, options=options)


def _number(value: Value, values: Mapping[str, float]) -> float:
    return evaluate(value.formula, values, value.place) * value.factor
