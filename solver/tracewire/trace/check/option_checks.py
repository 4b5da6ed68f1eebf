"""Whether what a user asks of a trace exists on the diagram that is traced."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tracewire.compile import Model
from tracewire.diagram import effects_of
from tracewire.errors import OptionError, Problem, unknown
from tracewire.library import SENSOR_TERMS
from tracewire.trace.candidates.places import find_places
from tracewire.trace.options import TraceOptions


def check_options(options: TraceOptions, model: Model) -> None:
    """Refuse places and effects that the model does not have, and sizes without a meaning.

    Raises OptionError with all that is wrong.
    """
    places = [place.name for place in find_places(model)]
    problems = [*_places(options, places), *_effects(options, model, places), *_sizes(options)]
    if problems:
        raise OptionError(problems)


def _places(options: TraceOptions, places: list[str]) -> Iterator[Problem]:
    hint = "`tracewire show DIAGRAM` lists the sums; `check` lists drives and measured signals."
    for name in options.only:
        if name not in places:
            yield unknown("place", name, places, hint=hint)


def _effects(options: TraceOptions, model: Model, places: list[str]) -> Iterator[Problem]:
    names = [kind.name for kind in effects_of(model.diagram)]
    names += [f"sensor_{kind}" for kind in SENSOR_TERMS]
    hint = "`tracewire blocks` lists the effects."
    for text in options.without:
        name, at, place = (part.strip() for part in text.partition("@"))
        if name not in names:
            yield unknown("effect", name, names, hint=hint)
        elif at and place not in places:
            yield unknown("place", place, places, hint=f"It stands in '{text}'.")


def _sizes(options: TraceOptions) -> Iterator[Problem]:
    if options.effects < 0:
        what = f"a trace cannot add {options.effects} effects"
        yield Problem(what, hint="Give the most effects that it may add: 0, 1, 2 ...")
    if options.horizon is not None and not 0 < options.horizon < math.inf:
        what = f"the horizon must be longer than 0 s, got {options.horizon:g} s"
        yield Problem(what, hint="Give a time in s, such as one period of the slowest motion.")
    if not options.budget > 0:
        what = f"the budget must be more than 0 s, got {options.budget:g} s"
        yield Problem(what, hint="Give the seconds after which the search ends.")
