"""What there is to know of a method beside its functions: one record, in the method's file."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    """A method by its name, and what the core must know of it.

    stages, inner: the rows that it needs of these arrays of a trial step. bent: the first row of
    `inner` that bends its polynomial away from the straight line between the ends of the step; from
    there on each has a factor of theta*(1 - theta) and others of at most 1. exponent: how the step
    follows from the error, h is multiplied with `safety` times the error to this power. edge:
    |h*eigenvalue| at the edge of its stability, inf where it has no edge or does not estimate it.
    nearby: the part of a step by which its end may be moved by the trapezoidal rule, 0 where it may
    not; over 1e-5 of an explicit step that rule is wrong by less than the step's rounding.
    implicit: it takes the Jacobian, counts as a step of a stiff method, and leaves no rate of the
    field at its end. fixed: its steps have the length that the user gives.
    """

    name: str
    stages: int
    inner: int
    bent: int = 0
    exponent: float = -0.2
    safety: float = 0.9
    edge: float = math.inf
    nearby: float = 0.0
    implicit: bool = False
    fixed: bool = False
