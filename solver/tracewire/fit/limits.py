"""The thresholds of a fit: how its methods search, and from when on its result is doubted.

Where no source stands, a number is a judgement, checked on made and measured records by the tests.
"""

from __future__ import annotations

from typing import Final


class SearchLimits:
    """Of every search: how often it reports, and when least squares ends."""

    report_every: Final[float] = 0.1
    """Wall time between two reports of progress, s."""
    most_steps: Final[int] = 1_000_000
    """Steps of least squares, whatever the options allow."""
    exact: Final[float] = 1e-14
    """Its relative tolerance on formulas alone."""
    noisy: Final[float] = 1e-2
    """The same on runs, in units of their rtol."""
    unmoved: Final[float] = 1e-3
    """The part by which the criterion may rise where a parameter without effect is put back: other
    values change the steps of a run, and so its rounding."""


SEARCH = SearchLimits()


class SimplexSteps:
    """How fminsearch moves its simplex (Nelder and Mead 1965), and where it begins (Pfeffer)."""

    reflection: Final[float] = 1.0
    """ρ"""
    expansion: Final[float] = 2.0
    """χ"""
    contraction: Final[float] = 0.5
    """γ"""
    shrinkage: Final[float] = 0.5
    """σ"""
    relative_edge: Final[float] = 0.05
    """By which part of itself each coordinate of the start is moved."""
    zero_edge: Final[float] = 0.0075
    """By how much, where it is 0."""


SIMPLEX = SimplexSteps()


class TrackingLimits:
    """Of how far a model follows a measured series."""

    tracked: Final[float] = 0.2
    """A model follows a series where it is off by less than this part of the series' spread."""
    parts: Final[int] = 10
    """Parts of a series whose median spread is what it usually swings."""
    noise: Final[float] = 4.0
    """A spread of data is at least this many times their noise."""


TRACKING = TrackingLimits()


class GrowingWindowLimits:
    """Of least squares on the first samples, then on more and more of them."""

    fewest_samples: Final[int] = 8
    """Samples in the first part of a series, at least."""
    diverged: Final[float] = 0.3
    """A search has diverged on a part where this part of its spread remains."""
    slowest: Final[float] = 1.1
    """By which factor a part grows at least."""
    fastest: Final[float] = 4.0
    """By which factor a part grows at most."""
    width: Final[float] = 0.3
    """How far unknowns may go on one part, as a part of their size: a standard deviation."""
    steps: Final[int] = 20
    """Of least squares on a part, at most."""
    ftol: Final[float] = 1e-3
    """The relative change that ends it."""
    last_steps: Final[int] = 100
    """The same on the whole series ..."""
    last_ftol: Final[float] = 1e-8
    """... and the change that ends that."""
    most_parts: Final[int] = 200
    """Parts on which least squares is tried before it goes to the whole series."""


GROWING = GrowingWindowLimits()


class MultipleShootingLimits:
    """Of segments with initial states of their own, whose gaps are closed stage by stage."""

    fewest_samples: Final[int] = 10
    """Samples of a segment, at least."""
    most_segments: Final[int] = 300
    """Segments of a series, at most."""
    longer: Final[int] = 4
    """How many times longer than the longest so far the next segment may be."""
    steps: Final[int] = 15
    """Of a stage, at most."""
    ftol: Final[float] = 1e-3
    """The relative change that ends it."""
    last_steps: Final[int] = 40
    """The same of the last stage ..."""
    last_ftol: Final[float] = 1e-6
    """... and the change that ends that."""
    closed: Final[float] = 1e-5
    """Gaps of this part of what states change from one start to the next are closed."""
    first_damping: Final[float] = 1e-3
    """Damping of the first step, in squared column lengths of the derivatives."""
    least_damping: Final[float] = 1e-12
    """Damping does not fall below it."""
    most_damping: Final[float] = 1e10
    """Damping from which on a stage ends."""
    alike: Final[float] = 2.0
    """One run is as good as the segments where its criterion is at most so many times theirs ..."""
    nothing: Final[float] = 1e-6
    """... or is this part of what the data spread: as good as none."""


SEGMENTS = MultipleShootingLimits()


class MultistartLimits:
    """Of the search from many points."""

    points: Final[int] = 32
    """For each unknown, rounded up to a power of two."""
    most_points: Final[int] = 4096
    """In all, at most."""
    batch: Final[int] = 32
    """Points that are evaluated together."""
    polished: Final[int] = 6
    """Of the best points: how many least squares goes on from."""
    steps: Final[int] = 60
    """Of least squares, at most."""
    ftol: Final[float] = 1e-8
    """The relative change that ends it."""
    apart: Final[float] = 0.05
    """Two points are one start where they are nearer than this part of the bounds in every
    unknown."""
    same: Final[float] = 1e-3
    """Two ends are one minimum where their criteria differ by less than this part."""


MULTISTART = MultistartLimits()


class ShootingLimits:
    """Of rounds of random shots and of the simplex."""

    first_radius: Final[float] = 0.05
    """Of the shots, as a part of the size of each unknown: a standard deviation."""
    nearest: Final[float] = 0.2
    """A shot has the radius of its round, or one that is smaller, down to this part of it."""
    least_radius: Final[float] = 1e-5
    """A radius that would be smaller begins again at the first."""
    shots: Final[int] = 2
    """In a round, for each unknown; twice as many where there is no simplex."""
    least_shots: Final[int] = 10
    """In a round, at least."""
    longest: Final[float] = 8.0
    """Shots along the simplex are as long as it is, and up to so many times longer."""
    patience: Final[int] = 5
    """A simplex is left where so many evaluations for each unknown ..."""
    stalled: Final[float] = 0.8
    """... leave this part of the criterion."""
    edge: Final[float] = 0.05
    """Of the simplex of fminsearch, as a part of each unknown."""
    least_edge: Final[float] = 1e-4
    """A simplex ends where it has shrunk to this part of its first edges, or its values have."""
    zero: Final[float] = 0.02
    """The least size of an unknown, as a part of what it is scaled by."""
    polishing: Final[int] = 10
    """Steps of least squares after a round."""
    polished: Final[float] = 0.9
    """Where they leave more than this part of the criterion they are not tried again before a shot
    is better."""
    polish_ftol: Final[float] = 1e-6
    """The relative change that ends them."""
    gain: Final[float] = 1e-3
    """A round that gains less than this part of the criterion has gained nothing."""
    lost: Final[int] = 8
    """So many rounds without gain end the search."""


SHOOTING = ShootingLimits()


class DiagnosisLimits:
    """Of what is left after a fit: from when on it is no noise."""

    at_noise: Final[float] = 1.3**0.5
    """Times the noise up to which a residual is at it: the noise itself is known to 8 % or so."""
    coloured: Final[float] = 3.0
    """How many times the estimated noise a correlated residual may be noise itself: the estimate
    counts what neighbouring samples do not share."""
    doubt: Final[float] = 0.01
    """Probability below which chance is no explanation."""
    notable: Final[float] = 0.1
    """Autocorrelation that matters; less may be significant in long records and is not
    important."""
    far: Final[float] = 4.0
    """Robust standard deviations from which a sample is an outlier; chance has 6 in 100 000."""
    fewest_samples: Final[int] = 10
    """Samples that are diagnosed, and signs among which runs are counted."""
    lags: Final[int] = 20
    """So many last samples of a drive may show in a residual ..."""
    components: Final[int] = 6
    """... and so many combinations of these."""
    fast: Final[float] = 3.0
    """The size of a fitted start rate, in the fastest rate between two samples of what it is the
    rate of, from which on no record shows such a start."""
    raised: Final[float] = 1.05
    """By what factor the error of a series that was not fitted rises at least to be told."""
    promised: Final[float] = 0.9
    """The part of the residual that a Gauss-Newton step promises to leave, below which a search has
    ended before a minimum."""
    out_of_step: Final[float] = 0.15
    """The root mean square of a residual, as a part of the standard deviation of what was measured,
    from which on a fit may stand in another minimum than the lowest: its runs are out of step."""


DIAGNOSIS = DiagnosisLimits()


class UncertaintyLimits:
    """Of standard errors, and of parameters that the data do not determine."""

    at_bound: Final[float] = 1e-6
    """Part of the width between bounds, or of the value's own size where that is less, within which
    a value sits on one."""
    far: Final[float] = 3.0
    """In sigma: beyond it a robust loss takes a residual for an outlier."""
    unmoved: Final[float] = 10.0
    """Relative standard error of a parameter, all others known, from which the data do not move
    it."""
    loose: Final[float] = 0.5
    """Relative standard error from which two of them reach the value itself: 100 %."""
    collinear: Final[float] = 100.0
    """Brun's collinearity index from which the others stand in for a parameter. Brun calls 10 to 20
    critical; NIST certifies errors at 50 (Nelson), and 500 is what a product of parameters has."""
    part: Final[float] = 0.1
    """Share of a direction from which a parameter takes part in it."""
    trace: Final[float] = 1e-3
    """The same where the direction is exactly flat: less is within the derivatives' error."""


UNCERTAINTY = UncertaintyLimits()


class ProfileLimits:
    """Of the profile of a likelihood, followed to both sides of a value."""

    first: Final[float] = 0.6
    """The first step, in standard errors."""
    growth: Final[float] = 1.4
    """How much longer each next step is."""
    beyond: Final[float] = 1.5
    """Times the level at which a side has been followed far enough."""
    finer: Final[int] = 3
    """How many more values may be tried where a step has gone far beyond the level."""
    fell: Final[float] = 1.0
    """How much lower -2 log likelihood must be elsewhere before a fit counts as not converged."""


PROFILE = ProfileLimits()
