"""The thresholds of analyses: where a search has closed, what counts as equal, and what is refused.

Where no source stands, a number is a judgement, checked on exact solutions by the tests.
"""

from __future__ import annotations

from typing import Final


class StabilityLimits:
    """Where eigenvalues and multipliers decide nothing."""

    on_axis: Final[float] = 1e-9
    """Of the largest eigenvalue, or of 1/s: a real part that is nearer to zero."""
    on_circle: Final[float] = 1e-4
    """From the unit circle: a multiplier that is nearer. Where two of them meet there an error e of
    the monodromy moves them by sqrt(e)."""


STABILITY = StabilityLimits()


class EquilibriumLimits:
    """Of Newton's method inside the active mode, and of the linear system that is found there."""

    closed: Final[float] = 1e-9
    """Of the size of what adds up to a rate: so much of it is zero."""
    most_steps: Final[int] = 200
    """Newton steps, at most."""
    along: Final[tuple[float, ...]] = (0.13, 0.29, 0.41, 0.53, 0.67, 0.79, 0.91, 1.0)
    """Of a part of a step: where guards are looked at. Uneven, to meet no symmetry."""
    shortest: Final[float] = 1e-10
    """The part of Newton's step below which it is given up."""
    rank: Final[float] = 1e-11
    """Of the largest singular value: what is below it is zero."""
    beyond: Final[float] = 1e-9
    """Of the size of a guard: beyond its level."""
    passed: Final[float] = 1e-6
    """Of a step: how far it goes on where it has reached a guard."""
    halvings: Final[int] = 60
    """Of the part of a step that reaches a guard: to the last bit."""
    most_corrections: Final[int] = 3
    """Newton steps back to the surface of a guard, at most."""
    most_told: Final[int] = 4
    """Rates that the message of a failure lists."""
    at_guard: Final[float] = 1e-9
    """Of the size of the states: a guard that is nearer to its level is at it."""
    alike: Final[float] = 1e-9
    """Of the entries of two linear systems: those that differ by less are one."""


EQUILIBRIUM = EquilibriumLimits()


class RootLimits:
    """Of the characteristic roots of a system with delays: collocation, then Newton's method."""

    fewest_points: Final[int] = 24
    """Of a delay in the collocation, at least."""
    most_points: Final[int] = 160
    """The same at most."""
    largest: Final[int] = 1600
    """Rows of the matrix whose eigenvalues are the guesses."""
    fewest_roots: Final[int] = 8
    """Roots that are listed, where there are less states."""
    far: Final[float] = 40.0
    """A root that decays by exp of it within the longest delay is not looked for."""
    most_steps: Final[int] = 30
    """Newton steps of a root, at most."""
    closed: Final[float] = 1e-13
    """Of the size of a root: a step that moves it by less is the last one."""
    near: Final[float] = 1e-2
    """Of its size: how far an eigenvalue of the collocation lies from its root."""


ROOT = RootLimits()


class OrbitLimits:
    """Of periodic motions, their multipliers, and Lyapunov exponents."""

    points: Final[int] = 400
    """Of a period, where the motion is looked at."""
    most_steps: Final[int] = 40
    """Newton steps on the period map, at most."""
    most_halvings: Final[int] = 8
    """Of one of these steps."""
    still: Final[float] = 1e-3
    """Of the motion at the guess: one that is smaller is a steady state."""
    loose: Final[float] = 1e3
    """Times rtol: the part of its size up to which an orbit closes."""
    closed: Final[float] = 1e-5
    """Of the size of a motion: one that closes less well has no multipliers."""
    size_points: Final[int] = 64
    """Of a motion, to know its size."""
    batches: Final[int] = 20
    """Parts of a run whose means give the error of an exponent."""
    orthogonal_steps: Final[int] = 30
    """Of the integrator between two times that deviations are made orthogonal."""
    lost: Final[float] = 1e-13
    """Of the largest deviation: what rounding leaves of one that is lost."""


ORBIT = OrbitLimits()


class SectionLimits:
    """Of Poincaré sections: how crossings are looked for, and which points are one."""

    first_chunk: Final[float] = 0.02
    """Of the span: how far to look for the first crossings."""
    longest: Final[float] = 100.0
    """Spans that are searched for the crossings of a guard."""
    around: Final[int] = 4
    """Periods that tell how far the motion goes."""
    near: Final[float] = 1e-3
    """Of the extent of a motion: points that are nearer are one."""
    irregular: Final[float] = 0.25
    """Clusters, as a part of the points, from which on a motion is irregular."""
    many: Final[int] = 2000
    """Points whose pairs still fit the memory."""
    other_times: Final[tuple[float, ...]] = (0.137, 0.291, 0.618, 0.853)
    """Of the span: where a drive shows that it changes with time."""
    most_changes: Final[int] = 8
    """Of each guard of a source: how many are looked at."""
    beside: Final[float] = 1e-9
    """Of a period: how far from an edge the source is looked at."""


SECTION = SectionLimits()


class SignalLimits:
    """Of spectra, scalograms and the growth of a signal."""

    fewest_samples: Final[int] = 16
    """Of a signal in the chosen time."""
    even: Final[float] = 1e-6
    """Of a step: what times may be off and count as even."""
    window_points: Final[int] = 1024
    """Of a window that say how it looks."""
    most_numbers: Final[int] = 50_000_000
    """In a scalogram: 400 MB."""
    fewest_peaks: Final[int] = 4
    """Of an oscillation whose growth is fitted."""
    apart: Final[float] = 4.0
    """Standard errors from which on two halves have two rates ..."""
    seen: Final[float] = 0.1
    """... where they also differ by this part of the rate."""


SIGNAL = SignalLimits()


class SweepLimits:
    """Of sweeps over a grid."""

    most_points: Final[int] = 1_000_000
    """Of a grid."""


SWEEP = SweepLimits()


class QuantityLimits:
    """Of the quantities that statements about a system are measured by."""

    rtol: Final[float] = 1e-9
    """The relative tolerance of a run, unless a statement says another one."""
    same_time: Final[float] = 1e-12
    """Of the span: a sample so near to the begin of the measured time belongs to it."""
    xtol: Final[float] = 1e-9
    """Of an edge, in parts of where it is looked for."""
    apart: Final[float] = 1e-2
    """In rad, or the unit of a state: motions whose section points differ by it are two."""
    most_starts: Final[int] = 10_000
    """From which motions are looked for."""
    largest_start: Final[float] = 1e100
    """In the unit of a state: what is larger is no number to begin with."""
    fewest_waves: Final[int] = 1
    """From rise to rise, of a signal that has a frequency."""
    most_lines: Final[int] = 1000
    """Of a spectrum that are counted."""


QUANTITY = QuantityLimits()
