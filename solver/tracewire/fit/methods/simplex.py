"""The method fminsearch: Scilab's simplex on the values as the user knows them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit.fminsearch import fminsearch
from tracewire.fit.optimset import OptimValues, OutputFunction
from tracewire.fit.search import MethodResult, Search


def by_simplex(search: Search) -> MethodResult:
    """The minimum by `fminsearch`, reflected at bounds.

    The unknowns are in SI, or in units of `scale` where that is given, so that TolX is too. With
    no bound in reach, moves and evaluations are those of Scilab.
    """
    criterion, options = search.criterion, search.options
    units = search.units

    def inside(x: Vector) -> Vector:
        return search.reflect(x * units / criterion.scales)

    def fun(x: Vector) -> float:
        return search.value(inside(x))

    def report(x: Vector, values: OptimValues, state: str) -> bool:
        if state == "iter":
            search.iterations = values.iteration
            share = max(
                values.funccount / options.evaluations(search.size),
                values.iteration / options.iterations(search.size),
            )
            search.set_stage(share, values.procedure)
        return False

    def with_comparisons(function: OutputFunction) -> OutputFunction:
        return lambda x, values, state: function(x, search.with_comparisons(values), state)

    watched = replace(
        options,
        OutputFcn=[*map(with_comparisons, options.output_functions()), report],
        PlotFcns=[*map(with_comparisons, options.plot_functions())],
    )
    first = search.begin * criterion.scales / units
    found = fminsearch(fun, first, watched, resumed=search.resumed, keep=search.checkpoint)
    return MethodResult(
        inside(np.asarray(found.x)), found.output.iterations, found.exitflag, found.output.message
    )
