"""The methods: each fills a trial step and knows what lies inside it."""

from __future__ import annotations

from tracewire.solve.core.arrays import Vector, copy, trial_of
from tracewire.solve.core.methods import dop853, dormand_prince, rosenbrock, runge_kutta
from tracewire.solve.core.methods.trial import move_end, norm
from tracewire.solve.core.units import unit

METHODS = (dormand_prince.METHOD, rosenbrock.METHOD, dop853.METHOD, runge_kutta.METHOD)
DORMAND_PRINCE, ROSENBROCK, DOP853, RK4 = range(len(METHODS))
NAMES = tuple(method.name for method in METHODS)
STEPPED = tuple(method.name for method in METHODS if method.fixed)
"""The methods that take steps of a given length."""
# what the core reads of a method by its number
INNER = tuple(method.inner for method in METHODS)
BENT = tuple(method.bent for method in METHODS)
EXPONENT = tuple(method.exponent for method in METHODS)
SAFETY = tuple(method.safety for method in METHODS)
EDGE = tuple(method.edge for method in METHODS)
NEARBY = tuple(method.nearby for method in METHODS)
IMPLICIT = tuple(method.implicit for method in METHODS)
FIXED_STEP = tuple(method.fixed for method in METHODS)
LONGER = 1.2  # the error of a step grows by this to the power of 6 or 9, 3 or 5 times
# A step is refused whose defect is larger than both. DOP853: of the accepted steps of seven smooth
# problems, at tolerances from 1e-6 to 1e-13, none with a defect above 30 tolerances was above 2.7
# times the error of order 5. Two steps of random systems, 160 and 2500 tolerances wrong, had
# defects of 31600 and 12400 tolerances, 133 and 85 times that error; a third, at 1.34 times the
# length of the last one and 170 tolerances wrong inside, 664 tolerances and 10.7 times.
# Dormand-Prince: the largest defect of a step that was right, and more than 1.5 times as long as
# the last one, was 44 tolerances, on eight smooth problems at tolerances from 1e-4 to 1e-12; that
# of a step of a random system, 60 tolerances wrong, was 5500.
MOST_DEFECT = 100.0  # tolerances
# The polynomial of DOP853 is of order 7, and the estimate is that of the end of a step: a step of a
# random system whose end was 10 tolerances wrong was 70 wrong inside, with a defect of 700.
MOST_INSIDE = 300.0  # tolerances
TIMES_ERROR = 5.0  # times the estimate, for DOP853 that of order 5


@unit
def step(core: int, method: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """A trial step with a method; entries may be NaN where the field is undefined."""
    into = trial_of(core)
    into.ends[0] = t
    into.ends[1] = h
    copy(x, into.x)
    if method == ROSENBROCK:
        rosenbrock.step(core, t, x, rate, h)
    elif method == DOP853:
        dop853.step(core, t, x, rate, h)
    elif method == RK4:
        runge_kutta.step(core, t, x, rate, h)
    else:
        dormand_prince.step(core, t, x, rate, h)


@unit
def end_at(core: int, method: int, t: float, x: Vector, rate: Vector, h: float) -> None:
    """Let the trial step from here end at t + h: from its end on where that is nearby, else anew.

    An event is located with one whole step, and an evaluation for each of its corrections.
    """
    trial = trial_of(core)
    whole = trial.ends[1]
    if not abs(h - whole) < NEARBY[method] * whole:
        step(core, method, t, x, rate, h)
        return
    move_end(core, h - whole)
    if method == DOP853:
        dop853.bend(core, h / whole)
    else:
        dormand_prince.bend(core, h / whole)


@unit
def inside(core: int, method: int, theta: float, out: Vector) -> None:
    """The states at t + theta*h, theta in [0, 1]."""
    if method == ROSENBROCK:
        rosenbrock.inside(core, theta, out)
    elif method == DOP853:
        dop853.inside(core, theta, out)
    else:
        dormand_prince.inside(core, theta, out)


@unit
def error_of(core: int, method: int, rtol: float, atol: Vector, last: float) -> float:
    """The error of a trial over its tolerance; NaN where it is not finite.

    `last` is the length of the last step. The estimate of an explicit method alone accepts no step
    that is longer: where it vanishes by accident, the defect of the polynomial does not.
    """
    trial = trial_of(core)
    estimate = norm(trial.error, trial.x, trial.x_end, rtol, atol)
    size = estimate
    if method == DOP853:
        size *= dop853.correction(core, rtol, atol)
    if not size <= 1.0 or method not in (DORMAND_PRINCE, DOP853):
        return size
    longer = trial.ends[1] > LONGER * last
    if method == DOP853:
        defect = dop853.defect(core, rtol, atol)
        if defect > MOST_INSIDE:
            return defect / MOST_INSIDE
    elif longer:
        defect = dormand_prince.defect(core, rtol, atol)
    else:
        return size
    if longer and defect > max(MOST_DEFECT, TIMES_ERROR * estimate):
        return defect / MOST_DEFECT
    return size


__all__ = [
    "BENT",
    "DOP853",
    "DORMAND_PRINCE",
    "EDGE",
    "EXPONENT",
    "FIXED_STEP",
    "IMPLICIT",
    "INNER",
    "METHODS",
    "NAMES",
    "ROSENBROCK",
    "SAFETY",
    "STEPPED",
    "end_at",
    "error_of",
    "inside",
    "step",
]
