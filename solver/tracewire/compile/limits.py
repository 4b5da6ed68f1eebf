"""How large models may be, and from when on a model is compiled in another way.

Where no source stands, a number was found by timing, or is a judgement.
"""

from __future__ import annotations

from typing import Final


class ModelLimits:
    """Of what is solved in each evaluation."""

    most_unknowns: Final[int] = 60
    """Signals of algebraic loops that depend on each other."""
    most_full: Final[int] = 60
    """Unknowns of a linear system without zeros, as a message says it."""
    most_work: Final[int] = 300_000
    """Entries of the elimination of a linear system."""
    most_periods: Final[float] = 1e9
    """The offset of a clock in its periods: beyond, offset + k*period is the same for many k."""


MODEL = ModelLimits()


class SearchLimits:
    """Of Newton's method on a loop that is solved by search; see `tape`."""

    most_steps: Final[int] = 100
    """After which the result is NaN."""
    least_share: Final[float] = 2.0**-10
    """Of a step that went too far."""
    close: Final[float] = 1e-10
    """Of the size of each unknown: a step that is shorter is the last one."""


SEARCH = SearchLimits()


class CodeLimits:
    """Of the texts that are compiled."""

    large: Final[int] = 1_000_000
    """Characters of IR, about 6000 blocks, from which on a quick compiler is better: it takes a
    tenth of the time, and what it makes is 20 % slower."""
    kept: Final[int] = 256
    """Compiled models that a process keeps."""
    longest_run: Final[int] = 8
    """Stores of one value to neighbours, beyond which a loop does them."""
    part: Final[int] = 400
    """Lines of IR in a part of a function."""
    longest_inline: Final[int] = 60
    """Characters of an expression that stands where it is used, once."""
    near: Final[float] = 0.7
    """The size of an argument of sinh, cosh, tanh and sech below which exp(u) - 1 loses digits: at
    log(2) it is right to a unit in its last place."""
    far: Final[float] = 22.0
    """The size of an argument of these from which on exp(-2u) is less than half a digit of 1."""
    longest_fold: Final[int] = 100
    """Terms in a row; more are added by halves, as a formula may not nest as deep as that."""


CODE = CodeLimits()


class RemarkLimits:
    """From when on a number or a sign of a model is remarked upon."""

    large: Final[float] = 360.0
    """In degrees, mm and so on: of a number in SI that shows as more another unit may be meant."""
    small: Final[float] = 1e-2
    """In bar, kN and so on: of a number in SI that shows as less another unit may be meant."""
    most_values: Final[int] = 300_000
    """Signals times evaluations, a second of work; larger models are not looked at."""
    step: Final[float] = 1e-2
    """Of a state to each side, in its SI unit, by which its force is looked at."""
    bent: Final[float] = 1e-6
    """Of the values of a function: what a straight line is not off by."""


REMARK = RemarkLimits()
