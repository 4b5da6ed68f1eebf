"""The options of a run, which `simulate` names one by one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypedDict, cast

from numpy.typing import ArrayLike

from tracewire.compile import Model
from tracewire.errors import OptionError, unknown
from tracewire.solve.limits import Limits

START = "start."
"""Before the name of a state: its start value."""


class AnySpan(TypedDict, total=False):
    """The options of `simulate`, by name, that do not say where a run begins and ends."""

    parameters: Mapping[str, float] | None
    method: str
    rtol: float
    atol: float | Mapping[str, float] | None
    step: float | None
    preset: str
    inputs: Mapping[str, tuple[ArrayLike, ArrayLike]] | None
    past: Mapping[str, tuple[ArrayLike, ArrayLike]] | None
    limits: Limits | Mapping[str, float] | None


class Options(AnySpan, total=False):
    """The options of `simulate`, by name."""

    start: Mapping[str, float] | None
    span: tuple[float, float] | None
    times: ArrayLike | None
    every: float | None


def refuse_unknown_options(given: Mapping[str, object]) -> None:
    """Raises OptionError with every option that `simulate` does not have."""
    known = Options.__optional_keys__
    problems = [unknown("option", name, sorted(known)) for name in given if name not in known]
    if problems:
        raise OptionError(problems)


def with_row(model: Model, options: Options, row: Mapping[str, float]) -> Options:
    """The options with the values of a row over those that they have: of parameters, and
    `start.NAME` of start values. Raises OptionError for a name that is neither."""
    flat = model.flat
    wrong = [name for name in row if name not in flat.parameters and not name.startswith(START)]
    if wrong:
        known = [*flat.parameters, *(START + name for name in model.states)]
        raise OptionError([unknown("parameter or start", name, known) for name in wrong])
    parameters = {name: float(row[name]) for name in row if name in model.flat.parameters}
    start = {n.removeprefix(START): float(row[n]) for n in row if n not in parameters}
    return with_options(options, Options(parameters=parameters, start=start))


def with_options(options: Options, more: Options) -> Options:
    """The options with others over them: values of parameters and states by name, all else as a
    whole, where it is given."""
    said = {name: value for name, value in more.items() if value is not None}
    if not more.get("preset"):
        said.pop("preset", None)
    given = Options(**options)
    given |= cast(Options, said)
    given["parameters"] = {**(options.get("parameters") or {}), **(more.get("parameters") or {})}
    given["start"] = {**(options.get("start") or {}), **(more.get("start") or {})}
    return given
