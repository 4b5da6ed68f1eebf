"""Options of `fminsearch`, under the names and with the defaults of Scilab's `optimset`."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import OptionError, Problem, unknown
from tracewire.fit.result import Comparison

DISPLAYS = ("off", "notify", "final", "iter")
PER_VARIABLE = re.compile(r"\s*(\d+)\s*\*\s*numberofvariables\s*", re.IGNORECASE)


@dataclass(frozen=True)
class OptimValues:
    """What an output function is told: evaluations and iterations so far, best value, last move.

    In a fit, `comparisons` simulates every series with the best values so far.
    """

    funccount: int
    iteration: int
    fval: float
    procedure: str
    comparisons: Callable[[], tuple[Comparison, ...]] | None = None


OutputFunction: TypeAlias = Callable[[NDArray[np.float64], OptimValues, str], object]
"""`f(x, values, state)`: x (n,) is the best point, state is "init", "iter" or "done"."""


@dataclass(frozen=True)
class Options:
    """When a search stops and what it tells meanwhile.

    Display: "off"; "notify", only when a limit ended the search; "final", also when it converged;
        "iter", also a table with one line per iteration.
    MaxIter, MaxFunEvals: limits of iterations and of evaluations, a number >= 1 or the text
        "K*numberofvariables". They are looked at once per iteration, so that a search may take a
        few evaluations more.
    TolX: size of the simplex, in the units of x. TolFun: spread of the values, in their unit.
    OutputFcn: an `OutputFunction`, or several; one that returns true stops the search.
    PlotFcns: the same, but what they return is not looked at.

    Raises OptionError, with every value that has no meaning.
    Source: Scilab 6.1, help page of optimset.
    """

    Display: str = "notify"
    MaxIter: float | str = "200*numberofvariables"
    MaxFunEvals: float | str = "200*numberofvariables"
    TolX: float = 1e-4
    TolFun: float = 1e-4
    OutputFcn: OutputFunction | Sequence[OutputFunction] | None = None
    PlotFcns: OutputFunction | Sequence[OutputFunction] | None = None

    def __post_init__(self) -> None:
        problems = []
        if self.Display not in DISPLAYS:
            problems.append(unknown("value of Display", str(self.Display), DISPLAYS))
        for name in ("MaxIter", "MaxFunEvals"):
            value = getattr(self, name)
            if _limit(value, 1) < 1:
                what = f"{name} is {value!r}"
                hint = "Give a number of at least 1, or a text such as '200*numberofvariables'."
                problems.append(Problem(what, hint=hint))
        for name in ("TolX", "TolFun"):
            value = getattr(self, name)
            if not (_is_number(value) and value >= 0):
                hint = "Give a tolerance of at least 0."
                problems.append(Problem(f"{name} is {value!r}", hint=hint))
        for name in ("OutputFcn", "PlotFcns"):
            if not _are_callable(getattr(self, name)):
                what = f"{name} is neither a function nor a list of functions"
                hint = "Give a function of (x, values, state), or a list of such functions."
                problems.append(Problem(what, hint=hint))
        if problems:
            raise OptionError(problems)

    def iterations(self, size: int) -> float:
        """The limit of iterations for `size` variables."""
        return _limit(self.MaxIter, size)

    def evaluations(self, size: int) -> float:
        """The limit of evaluations for `size` variables."""
        return _limit(self.MaxFunEvals, size)

    def stops(self, x: NDArray[np.float64], values: OptimValues, state: str) -> bool:
        """Tell a state to all functions; whether an output function wants to stop."""
        answers = [function(x.copy(), values, state) for function in self.output_functions()]
        for function in self.plot_functions():
            function(x.copy(), values, state)
        return any(map(bool, answers))

    def output_functions(self) -> tuple[OutputFunction, ...]:
        """The output functions as a tuple, empty where there are none."""
        return _as_tuple(self.OutputFcn)

    def plot_functions(self) -> tuple[OutputFunction, ...]:
        """The plot functions as a tuple, empty where there are none."""
        return _as_tuple(self.PlotFcns)


def optimset(*arguments: Any, **options: Any) -> Options:
    """Options by name, in Python's form or in Scilab's.

    `optimset(TolX=1e-3)`, `optimset("TolX", 1e-3, "MaxIter", 50)`, `optimset("fminsearch")` for the
    defaults, and `optimset(old, TolX=1e-3)` for old options with changes; `old` stays as it is.

    Raises OptionError: an option that does not exist (with the nearest that does), a value without
    meaning, a name without a value.
    """
    base = Options()
    if len(arguments) % 2:
        base, arguments = _base(arguments[0]), arguments[1:]
    changes = {str(name): value for name, value in zip(*[iter(arguments)] * 2, strict=True)}
    changes |= options
    names = [item.name for item in dataclasses.fields(Options)]
    problems = [
        unknown("option", name, names, hint=_capitals(name, names))
        for name in changes
        if name not in names
    ]
    if problems:
        raise OptionError(problems)
    return dataclasses.replace(base, **changes)


def _capitals(name: str, names: list[str]) -> str:
    """A hint where only small and capital letters are confused, which difflib may not find near."""
    same = [other for other in names if other.lower() == name.lower()]
    return f"It is written '{same[0]}'." if same else ""


def _base(first: object) -> Options:
    if isinstance(first, Options):
        return first
    if first == "fminsearch":
        return Options()
    raise OptionError.one(
        f"optimset got {first!r} where old options or 'fminsearch' may stand",
        hint="Options come in pairs of a name and a value: optimset('TolX', 1e-3).",
    )


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, Real) and not isinstance(value, bool)


def _limit(value: object, size: int) -> float:
    """The number that a limit means for `size` variables; NaN and what is no limit become 0."""
    if isinstance(value, str) and (match := PER_VARIABLE.fullmatch(value)):
        return int(match[1]) * size
    if not _is_number(value) or math.isnan(value):
        return 0
    return float(value)


def _as_tuple(
    functions: OutputFunction | Sequence[OutputFunction] | None,
) -> tuple[OutputFunction, ...]:
    if functions is None:
        return ()
    return (functions,) if callable(functions) else tuple(functions)


def _are_callable(functions: object) -> bool:
    if functions is None or callable(functions):
        return True
    return isinstance(functions, list | tuple) and all(callable(item) for item in functions)
