"""The method fminsearch: Scilab's simplex on the values as the user knows them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.fit.fminsearch import fminsearch
from tracewire.fit.optimset import OptimValues, OutputFunction
from tracewire.fit.search import Ended, Search

Vector = NDArray[np.float64]


def by_simplex(search: Search) -> Ended:
    """The minimum by `fminsearch`, reflected at bounds.

    The unknowns are in SI, or in units of `scale` where that is given, so that TolX is too. With
    no bound in reach, moves and evaluations are those of Scilab.
    """
    criterion, options = search.criterion, search.options
    units = search.units

    def inside(x: Vector) -> Vector:
        return search.folded(x * units / criterion.scales)

    def fun(x: Vector) -> float:
        return search.value(inside(x))

    def report(x: Vector, values: OptimValues, state: str) -> bool:
        if state == "iter":
            search.iterations = values.iteration
            share = max(
                values.funccount / options.evaluations(search.size),
                values.iteration / options.iterations(search.size),
            )
            search.tell(share, values.procedure)
        return False

    def told(function: OutputFunction) -> OutputFunction:
        return lambda x, values, state: function(x, search.with_comparisons(values), state)

    watched = replace(
        options,
        OutputFcn=[*map(told, options.output_functions()), report],
        PlotFcns=[*map(told, options.plot_functions())],
    )
    first = search.begin * criterion.scales / units
    found = fminsearch(fun, first, watched, resumed=search.resumed, keep=search.keep)
    return Ended(
        inside(np.asarray(found.x)), found.output.iterations, found.exitflag, found.output.message
    )
