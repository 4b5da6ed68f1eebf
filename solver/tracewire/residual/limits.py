"""The thresholds of residuals: where a record counts as noisy, uneven, off, or converged.

Where no source stands, a number is a judgement, checked on made and measured records by the tests.
"""

from __future__ import annotations

from typing import Final


class NoiseLimits:
    """Of the noise that is read from a record."""

    orders: Final[tuple[int, ...]] = (4, 6, 8, 10, 12)
    """Of differences: the higher, the less of a smooth signal they see."""
    falling: Final[float] = 1.2
    """A higher order that finds no less than this part of the noise sees no less of the signal."""
    fewest_samples: Final[int] = 96
    """Samples of a record whose spectrum is taken."""
    uneven: Final[float] = 1e-3
    """Of the median interval: times that spread by more are not even."""
    flat: Final[float] = 1.6
    """The largest ratio of the densities of two bands of white noise, beside their own errors."""
    plateau: Final[int] = 3
    """Bands of half an octave that a plateau below the highest frequencies has, at least."""
    lowest: Final[int] = 12
    """Bands above the plateau of noise, at most: six octaves."""
    part: Final[float] = 0.05
    """The part of a signal that noise is, at most, where it has a plateau."""
    above: Final[float] = 8.0
    """How many times the density of a plateau of noise the signal's is, which follows it."""
    steepest: Final[float] = 2.3
    """The rise of density per half octave of noise without a plateau: a random walk has 2."""
    rounded: Final[float] = 1.5
    """A floor within this factor of that of rounding is rounding."""
    sure: Final[float] = 2.0
    """The factor between the ends of an interval and the estimate, up to which it is sure."""
    disturbed: Final[float] = 0.5
    """Of the highest band's noise: differences that find less do so between events."""
    least: Final[float] = 1e-6
    """Of the spread of a signal: no sensor is better."""


NOISE = NoiseLimits()


class SpectrumLimits:
    """Of the spectrum in bands from which noise is read (P. D. Welch, IEEE Transactions on Audio
    and Electroacoustics 15, 1967, 70)."""

    long: Final[int] = 64
    """Samples of a stretch for the highest octave."""
    short: Final[int] = 32
    """The same where the record is short."""
    enough: Final[int] = 384
    """Samples from which on a record has the longer stretches."""
    shape: Final[float] = 14.0
    """Of Kaiser's window: its side lobes are at 1e-5 of the main one or less."""
    bins: Final[float] = 2.1
    """Neighbouring frequencies that this window makes one."""
    overlap: Final[int] = 4
    """Stretches begin at each such part of their length."""
    fewest: Final[int] = 3
    """Stretches of a record, at least."""


SPECTRUM = SpectrumLimits()


class ReadingLimits:
    """Of how the readings of a sensor stand."""

    largest_factor: Final[int] = 64
    """Of an interpolation that is looked for: samples for one of the sensor's own."""
    fewest_own: Final[int] = 20
    """Own samples of an interpolated record, at least."""
    quiet: Final[float] = 0.03
    """How small the differences between own samples are, in units of those at them."""
    outlier: Final[float] = 8.0
    """Standard deviations from the mean of both neighbours: such a sample is an outlier."""
    fewest_steps: Final[int] = 8
    """Gaps between readings that show a step, at least."""
    few_steps: Final[int] = 2
    """The same where each reading comes many times, as in a part in which little happens."""
    times_each: Final[int] = 10
    """How often each reading comes then, in the mean."""
    most_parts: Final[int] = 8
    """Steps of the least gap, at most."""
    coarse: Final[float] = 1e3
    """Steps of the median gap, at most."""
    even: Final[float] = 0.1
    """By this part at most do changes from sample to sample differ where a motion is steady,"""
    mostly: Final[float] = 0.95
    """in so many of them at least: no rounding is seen there."""
    timed: Final[float] = 0.2
    """What local quartics leave of samples that were taken where a counter stepped, in units of
    what rounding would leave, at most."""
    moving_places: Final[int] = 10
    """Places at which every sample differs from the one before, to tell that, at least."""


READING = ReadingLimits()


class InputLimits:
    """Of inputs: how they go on between samples, and what their noise does."""

    fewest_samples: Final[int] = 9
    """Samples of an input that is taken for held or smooth."""
    uneven: Final[float] = 0.01
    """The spread of time steps, in units of their mean, up to which samples are evenly spaced."""
    repeated: Final[float] = 0.5
    """The part of samples that repeat the one before, from which on an input looks held."""
    moving: Final[float] = 0.5
    """The part of changes that another one follows at once, up to which an input looks held."""
    jump: Final[float] = 0.02
    """The least median change beside the range of an input that looks held."""
    better: Final[float] = 0.3
    """The largest error of the spline, in units of that of straight lines, where an input is
    smooth."""
    visible: Final[float] = 1e-6
    """Of the range of an input: an error of straight lines that is smaller is no concern."""
    fine: Final[float] = 1e-3
    """The same for what may be left between the points."""
    finest: Final[int] = 8
    """Points for one sample, at most, of an input of more than `few_points` points."""
    few_points: Final[int] = 1000
    """Points of an input that cost a run little, however few its samples are."""
    lost: Final[float] = 5e-3
    """The part of an input's amplitude that straight lines lose, from which on it is told."""
    draws: Final[int] = 64
    """Sequences of input errors that are followed."""
    chance: Final[float] = 0.99
    """The quantile of such sequences that is the largest residual by chance."""
    small: Final[float] = 1e-2
    """Of the spread of an input: the change by which answers are taken where no noise is
    declared."""
    rtol: Final[float] = 1e-9
    """Relative tolerance of runs from sample to sample, of which differences are taken."""
    grid: Final[int] = 40
    """Levels of noise from which a search begins."""
    largest: Final[int] = 1500
    """Residuals of a window whose covariance is made: a free run's would fill the memory."""
    kept: Final[float] = 2.5e7
    """Numbers of such covariances that are kept: 200 MB."""
    least_halves: Final[int] = 40
    """Numbers that the noise of an input made, at least, for a look at whether it is white."""


INPUT = InputLimits()


class WindowLimits:
    """Of windows and their fitted initial states."""

    traced: Final[int] = 40
    """Samples of a series, at least, in which a missing effect can be traced."""
    points: Final[tuple[int, ...]] = (17, 11, 7)
    """Samples around a start through which a polynomial is laid: fewer where the signal bends."""
    places: Final[int] = 40
    """Places of a record at which these are compared."""
    bends: Final[float] = 2.0
    """By which factor what a polynomial leaves through more samples may exceed that of the fewest,
    root mean square. In white noise the median is 1.2."""
    degree: Final[int] = 4
    """Of this polynomial."""
    ahead: Final[float] = 2.0
    """How many delays of a sensor a window's run begins ahead of its first sample: a fit may find a
    longer delay than it began with."""
    remembered: Final[float] = 0.1
    """The part of a series by which a run begins ahead of a window, so that what a model remembers
    is what the record has made it: two time constants of a lag that the record shows ten times."""
    remembered_windows: Final[int] = 2
    """The same in lengths of the window, at most: what a short window ignores is soon forgotten."""
    initial_state_steps: Final[int] = 8
    """Gauss-Newton steps of initial states, at most."""
    least_part: Final[int] = 10
    """Samples of the first part of a long window to which its initial states are fitted alone."""
    far_off: Final[float] = 100.0
    """An initial state so many scales of it away from the one that the data show is refused."""
    converged: Final[float] = 1e-4
    """The part of the squared residual below which a step gains nothing."""
    negligible_gain: Final[float] = 0.05
    """The same in units of the noise's variance."""
    diverged: Final[float] = 10.0
    """The mean squared residual of a window, in units of the median of all, from which on its
    initial state may be wrong."""
    forgotten: Final[float] = 40.0
    """Time constants after which nothing is left of what a lag was."""
    rest_moved: Final[float] = 1.1
    """The factor of all parameters by which a rest that depends on them is seen."""
    beside: Final[tuple[float, ...]] = (-2.0, -1.0, 1.0, 2.0)
    """Standard deviations of the noise beside what the data tell, at which a measured state of a
    window that diverged is tried, too."""
    unseen: Final[float] = 1e-7
    """A direction of initial states that moves the residual less than this part of the strongest
    is left out."""
    largest: Final[float] = 1e100
    """Of measured and predicted values: its square, and sums of such squares, are numbers still."""


WINDOW = WindowLimits()


class DescentLimits:
    """Of the two least-squares loops: Levenberg-Marquardt on windows, scipy's trust region."""

    rescue_steps: Final[int] = 2
    """Gauss-Newton steps of the initial state of a window that diverged."""
    ftol: Final[float] = 5e-4
    """A step that gains less than this part of the sum of squares is the last one."""
    first_damping: Final[float] = 1e-3
    """Damping of the first step, in squared column lengths of the derivatives."""
    least_damping: Final[float] = 1e-9
    """Damping does not fall below it."""
    most_damping: Final[float] = 1e6
    """Damping from which on a fit ends: steps so short change nothing."""
    most_failures: Final[int] = 8
    """Steps whose run fails, after which a fit ends."""
    patience: Final[int] = 4
    """Steps in a row that are too slow until a fit is given up."""
    hope: Final[float] = 2.0
    """How many times the gain that its pace promises may still come."""
    fast: Final[float] = 0.9
    """A step that leaves less than this part of the criterion lets the next one do without a run
    for its derivatives."""
    slow: Final[int] = 6
    """So many steps that together gain too little end a search ..."""
    slow_gain: Final[float] = 0.1
    """... where that is less than this in units of the noise's variance ..."""
    steady: Final[float] = 0.3
    """... and the last of them gains this part of the first: it creeps, and does not converge."""


DESCENT = DescentLimits()


class CriterionLimits:
    """Of the criterion, its derivatives and what it does where a run fails."""

    step: Final[float] = 1e-4
    """Of the scale of an unknown: the change by which differences are taken."""
    penalty: Final[float] = 100.0
    """The residual where a run fails, in units of the spread of the samples."""
    many: Final[int] = 2000
    """Steps from which on series run in parallel, about 4 ms with sensitivities: below, threads
    cost more than they save, as what Python does around a run waits for its lock. Three traces of
    one degree of freedom took 2.4, 3.2 and 4.3 s with 400 steps, and 2.3, 2.8 and 4.3 s with 2000;
    one of the double torsion pendulum 14.2 and 14.7 s (least times of three runs, and of one)."""
    kept: Final[int] = 50_000
    """Numbers in the inputs and times of a series up to which the problem of its runs is kept: to
    make it again takes a small part of a longer run, and many criteria live at once."""
    rate_step: Final[float] = 1e-3
    """Of a sample interval: how far to each side a signal is sampled for its rate."""
    tiny: Final[float] = 1e-6
    """Of the width between its bounds: a value closer to zero says nothing of its size."""
    huber: Final[float] = 1.345
    """In sigma; it keeps 95 % of the efficiency of least squares on normal noise (P. W. Holland and
    R. E. Welsch, Communications in Statistics A6, 1977, 813)."""
    cauchy: Final[float] = 2.385
    """The same of the Cauchy loss."""


CRITERION = CriterionLimits()


class RemarkLimits:
    """From when on a record is remarked upon, as of another unit or another time."""

    largest_angle: Final[float] = 20.0
    """Range of an angle in rad from which on it may be one in degrees."""
    much_longer: Final[float] = 100.0
    """How many spans of the run a record takes whose times may be in ms."""
    far: Final[float] = 10.0
    """How many spans lie between a record and the run where both may count from other zeros."""
    epoch: Final[float] = 1e8
    """Seconds, three years: a time that is larger counts from a date."""
    near_pi: Final[float] = 0.3
    """In rad: a first sample so near to pi from the start counts from the other end."""
    near_turn: Final[float] = 0.6
    """In rad, a tenth of a turn: a step of an angle so near to a turn is one, where most steps are
    smaller than this."""
    elsewhere: Final[float] = 0.2
    """Of the range of a measured state: a first sample so far from the run's is another start."""
    resting: Final[int] = 5
    """Samples of exactly zero that are no passage through zero."""
    noisier: Final[float] = 10.0
    """Samples that scatter by so many times the declared sigma are told: a wrong unit is a factor
    of 57 (degrees for radians) or 1000, and the estimate was wrong by 7 on one record of 230."""


REMARK = RemarkLimits()
