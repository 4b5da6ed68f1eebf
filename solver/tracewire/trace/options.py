"""What a user may ask of a trace, and every threshold of its choice, with meaning and source."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tracewire.trace.data_thresholds import CheckOptions, PeriodOptions, SplitOptions
from tracewire.trace.thresholds import (
    CandidateOptions,
    ExperimentOptions,
    MapOptions,
    ScreenOptions,
    SearchOptions,
    TrialOptions,
)


@dataclass(frozen=True)
class TraceOptions:
    """What a trace tries, and from when on it believes an effect.

    The defaults of the choice are those of the study in which held-out log scores on blocks of time
    chose right most often on 16 measured records (see `choose/choice.py`); tolerances of 5 to
    10 % did equally well there, 2 % and 20 % worse. Those of the other stages are grouped at the
    end: `TraceOptions(search=SearchOptions(rivals=8))`.
    """

    only: tuple[str, ...] = ()
    """Places that are tried (`sum`, `drive.u`, `sensor.y`); empty: all."""
    without: tuple[str, ...] = ()
    """Effects that are not tried, by name, or by name and place as `coulomb @ force`."""
    effects: int = 3
    """How many effects are added at most."""
    horizon: float | None = None
    """The longer of the two horizons in s; None: five periods of the slowest measured motion."""
    budget: float = math.inf
    """Seconds of wall time after which the search ends with what it has found by then."""

    short_horizon: float = 0.3
    """The shorter horizon in dominant periods of the measured motion."""
    long_horizon: float = 5.0
    """The longer horizon in dominant periods. Where blocks are shorter, a run goes over several, or
    in a record of more than `most_samples` it is as short as they are."""
    shortest_window: int = 8
    """Samples of a window of the shorter horizon, at least."""
    least_blocks: int = 7
    """Blocks of time at least: fewer have no standard error to speak of."""
    most_blocks: int = 20
    """Blocks of time at most: more cost time and correlate with their neighbours."""
    still: float = 10.0
    """A body rests where its signals change by no more than so many times their noise until the
    record ends: about the range of white noise in 1e6 samples."""
    still_part: float = 1e-3
    """The same as a part of the range of the whole record."""
    long_rest: float = 0.05
    """The part of a record that a rest at its end takes at least."""
    folds: int = 8
    """Groups of scattered blocks that are left out in turn."""
    thirds: int = 3
    """Contiguous parts of the data, or groups of series, that are left out in turn."""
    fold_steps: int = 3
    """Steps of the refit without a fold, which begins at the fit to all data."""
    near: float = 0.05
    """The part of the error by which a model may be worse than the best and still count as near."""
    same: float = 1e-3
    """The part of the squared error by which the fits of two models differ at most that are one
    model in two forms."""
    sure: float = 3.0
    """Standard errors over blocks by which a model must beat the declared one to be named."""
    block_counts: float = 0.2
    """The part of the error by which one block counts at most in such a test: in a decay most of
    what is missing shows in the first blocks."""
    stands_out: float = 4.0
    """The excess over phi^2, in phi^2, from which on a channel stands out in a block: more than
    twice the error that is always there."""
    standing_out: int = 3
    """Blocks that must stand out at least where one that takes them away is sure by that alone: one
    or two are single events."""
    material: float = 0.03
    """The part of the declared model's squared error that each effect must take away beside the
    others, the mean over horizons. On 23 generated records with a floor, what stood for the floor
    took at most 0.027, and true second effects 0.2 and more; on a rig a true one took 0.0325."""
    small_share: float = 0.1
    """That part below which a named effect is told to take little: it may stand for another law. On
    two generated records what stood for a floor took 0.04 and 0.05, on two rigs true second effects
    took 0.13 and 0.29; one that was as small as a floor took 0.015."""
    decisive: float = 0.85
    """The part of what is left without an effect, at one horizon, from which on it is no stand-in
    however small it is. On those records stand-ins took at most 0.8, true effects 0.6 to 0.99; on a
    rig of two tanks a true second effect took 0.87."""
    tied: float = 0.95
    """The quantile of F, with as many degrees of freedom as blocks, up to which the squared error
    of another effect in the place of a named one makes it a tie, where it is no more than
    `material` more: 3.8 times for 7 blocks, 2.1 times for 20. On 58 generated records with a floor
    this added 1 or 2 ties to 11, laws of like form; in two of them the new tie was the truth."""
    negligible: float = 0.01
    """The part of the excess squared error that a model may leave at each horizon for no further
    effect to be looked for."""
    looser: float = 0.1
    """The part of its lower bound to which a deflection on it is freed in the best models."""
    rhythms: int = 3
    """Waves of an effect in a period of a free motion, at most, that keep its rhythm."""
    many_effects: int = 3
    """Effects that must predict held-out blocks, although together they come to the noise. On a
    generated record with a floor alone, three small ones did."""
    explained: float = 0.6
    """The share of the excess error that named effects explain at least; a wrong single effect had
    a share of about 0, right models had more than 0.74."""
    explained_uncommon: float = 0.8
    """The same where one of them is a wave, a drift or their kin, which follow a part of anything:
    a false one explained 0.70, the ripple of a measured motor 0.88."""
    explained_uncommon_beside: float = 0.95
    """The same where it stands beside another law, and so the more follows them: false pairs
    explained 0.70 to 0.92 on generated records with a floor alone, true ones nearly all."""
    explained_many: float = 0.95
    """The same with `many_effects` laws more than are declared: together they follow a part of any
    smooth force. Three false ones explained 0.84, 0.88 and 0.94 on generated records with a floor
    alone; three on a measured damper 0.97."""
    small_error: float = 0.03
    """The error of the declared model as a part of what signals move, up to which it may be what
    any rig has besides. On 330 generated records with a floor alone, 14 of 21 false effects stood
    behind an error below that, and 11 of 67 hidden ones."""
    explained_small: float = 0.95
    """The share that effects behind such an error explain at least, unless a declared term goes for
    them: 10 of these 14 explained less on held-out blocks, and one of these 11. None of the 14 let
    a term go; a drag and a dry friction of a measured pendulum did, which explain 0.76."""
    explained_at_noise: float = 0.75
    """The share of what was above the noise that effects take which come down to the noise, to be
    named without a comparison by held-out blocks: false ones took 0.65, 0.68 and 0.89, the offset
    of a measured wheel 0.79, hidden ones 0.99 and more on a hundred generated records."""
    explained_surely: float = 0.5
    """The same less its standard error: the greater part."""
    error_left: float = 0.55
    """The part of the error on held-out blocks, as a geometric mean, that named effects leave at
    most. On 35 generated records right names left at most 0.51; where nothing of the library was
    missing but a small smooth force, what imitated it left 0.61 to 0.77 in 5 cases."""
    whole_runs: float = 0.3
    """The part of the excess squared error of whole unseen runs that named effects take at least.
    On 63 generated records with a floor, right names took 0.45 and more, but for five that took
    0.13 and less; of six names that stood for the floor alone four took 0.14 and less, one 0.35."""
    claimed: float = 0.1
    """The part of the excess squared error that named effects take at least, of free runs or of
    windows, in the part of the data that is kept for the claim. On 116 generated records with a
    floor, right names took 0.24 of free runs or 0.32 of windows and more; of 24 names that stood
    for the floor alone two took 0.06 of free runs, and nothing of windows."""
    excited: float = 0.1
    """The part of the squared error that effects take where they were fitted, which the declared
    model must have in whole unseen runs for these to confirm them. A step answer without a step
    had 0.02."""
    law_from: float = 2.0
    """The reduced chi-square of a rest, twice the variance of the noise, from which on it is
    asked whether it is a law that no block has."""
    informative: float = 2.0
    """The mean squared residual of a block in the noise's variance, from which on the declared
    model lacks something there."""
    law_share: float = 0.95
    """The part of a rest that is a smooth function at one place, from which on it is a law. On 20
    generated records with an unmodelled part it was at most 0.83; on 7 with a law that the library
    lacks 0.87 to 1."""
    law_share_long: float = 0.97
    """The same at the longer horizon, where the freedom of a map counts more: two false names for
    the unmodelled part of generated records left 0.983 and 0.993 there, the right ones of a
    measured pendulum 0.953."""
    law_below: float = 0.9
    """The share explained from which on such a law is a remainder of what was missing."""
    map_gain: float = 0.05
    """The part of the error that a smooth map of position, rate, time or history must gain on
    unseen data for a rest to be called unexplained."""
    harm: float = 0.02
    """The part by which a model may raise the error on unseen data, as by chance, and be named."""
    harm_few: float = 0.1
    """The same where there are less than four windows, whose spread says nothing."""
    harm_errors: float = 2.0
    """Standard errors over windows by which a rise of that error is more than chance."""
    tracked: float = 0.5
    """The error of a whole run, as a part of the standard deviation of the signals, below which the
    run has not lost track of the data, so that another one can be compared with it."""
    out_of_step: float = 0.15
    """The error of long runs, as a part of the standard deviation of the signals, from which on
    their fit may stand in the next minimum, and is done again over longer and longer parts."""
    at_noise: float = 1.3
    """The reduced chi-square below which a residual is at the sensor's noise: there the noise is
    white, likelihood is right, and BIC chooses."""
    few_samples: float = 0.01
    """The part of a series' samples, at most, in which half of its squared residual stands, to be
    told as samples that may be wrong."""
    settles: float = 9.0
    """How many times as large as in the rest, which is at the noise, the mean squared residual at
    the begin or the end of a record is at least, for the note that this part may be left out."""
    input_windows: int = 40
    """Windows of a series on which the likely noise of an input is found."""
    input_noise: float = 0.5
    """The part of the standard deviation of an input that its noise may be: what is larger than the
    input itself is no noise of it."""
    input_shown: float = 0.1
    """The same of the noise that the samples of an input show: what varies from sample to sample by
    more may be meant so."""
    input_left: float = 2.0
    """The reduced chi-square below which the noise of an input explains a residual."""
    input_even: float = 0.5
    """The evenness from which on that noise is white. It was 0.99 of a force's noise, and 0.22 to
    0.74 of a hidden law, by series."""
    input_depends: float = 0.8
    """The share of an excess that a smooth map explains, from which on it is no noise of an input:
    any force that is missing where the input acts has the size of some noise. A map of the rate of
    the rate explained 0.70 of a force's noise, one of a hidden law 0.87 and more."""
    refused: int = 4
    """Models that may be refused because they raise the error on unseen data, before none is
    named."""
    lost: float = 1.5
    """The reduced chi-square on longer windows, three times the shortest length and all of a
    record, from which on a model that is at the noise on shorter ones is not right."""
    slow_noise: float = 30.0
    """The reduced chi-square below which a rest is taken for slow noise of a sensor, where no body
    comes back to where it was and the noise is estimated, not declared."""
    uncommon: tuple[str, ...] = (
        "harmonic", "parametric", "cogging", "position_friction", "sensor_quad", "sensor_gain",
        "stiffness_drift", "viscous_drift", "friction_drift", "sensor_drift", "drive_2nd_harm",
        "drive_3rd_harm",
    )  # fmt: skip
    """Effects that come after common ones where both predict as well: waves, drifts, gains."""
    with_motion: float = 0.5
    """The part by which common effects may take less of the squared error than a wave in time that
    is within one line of a free motion: on a swing with dry friction they took 10 % less."""

    most_samples: int = 5000
    """Samples of the windows on which effects are screened and refits begin; longer records show
    the same there at some windows of each block."""
    most_short: int = 8000
    """Samples of the shorter horizon, some of each block: there the blocks of a longer record say
    no more."""
    windows_together: int = 8
    """Windows in a row that are looked at where not all are: memories go on between them."""
    most_residuals: int = 20_000
    """Residuals that a screen looks at: of more, every second, third, ... one; a screen of 400
    variants then takes 64 MB."""
    most_scanned: int = 12_000
    """Residuals up to which the lengths of waves are scanned in each screen: the scan of 800
    lengths takes most of a screen's time."""
    singles: int = 10
    """Single effects that are refitted beside the declared model, by each of two measures, shared
    by the horizons: on 26 generated records the true one was among the first two 22 times."""
    pairs: int = 2
    """Pairs that are refitted beside the declared model, by each measure."""
    beside: int = 3
    """Effects that are refitted beside each of the best smaller models, by each measure; and two
    pairs less."""
    cheap_samples: int = 5000
    """Samples that refits may take together in any case: a record of 50 samples costs next to
    nothing, and 100 effects are refitted there."""
    tried_before: int = 3
    """Models that were refitted on the shortest windows before, and are compared, too."""
    imitated: float = 0.1
    """By which part of its square an effect must be imitated less without a declared term, to be
    tried there."""
    parents: tuple[int, int] = (2, 1)
    """Single effects, and pairs, beside which a further effect is looked for."""
    parent_behind: float = 10.0
    """The squared error, in units of that of the best model, from which on a model is not
    extended."""
    parent_beside: float = 3.0
    """The same in units of that of the best model of its size."""
    finalists: int = 2
    """Models at each number of fitted numbers whose predictions are compared."""
    first_steps: int = 5
    """Steps of a first refit of a model, at the horizon whose screen proposed it."""
    begun: int = 8
    """How many of the models of the screens are refitted at all horizons after that."""
    coarse: float = 5e-3
    """The part of the squared error by which a step of such a refit must still lower it."""
    steps: int = 12
    """Steps of that refit."""
    restart: float = 0.1
    """The part of its promised coefficient at which an effect begins again where a refit from the
    promise ends worse than without it."""
    moved: float = 0.3
    """The part of its declared value by which a parameter has moved in the fit of the declared
    model, from which on effects are screened at the declared values, too, where none passes at
    those of the fit, and one whose refit is not hopeful begins again there: a friction or a gain
    that makes up for the effect may lie in the way."""
    hopeful: float = 2.0
    """The squared error, in units of the least one of a model of the same size, that a fit must
    promise to reach at its pace, or be given up."""
    most_steps: int = 10_000_000
    """Steps of the solver after which no further models are refitted, one or two minutes."""
    exchanged: int = 1
    """Models of each size of which effects are exchanged for those that look alike."""
    alike: int = 3
    """How many effects are tried in the place of one in such an exchange."""
    fold_ridge: float = 1e-3
    """The weight of the fit to all data beside that without a fold: what only the fold determines
    is then no accident."""
    few_windows: int = 4
    """Windows from which on the spread of their errors says what is chance."""
    noise_errors: float = 4.0
    """Standard errors of a reduced chi-square, sqrt(2/freedom), up to which it is at the noise."""
    confidence: float = 0.95
    """Of the intervals of fitted values and of shares."""
    interval_blocks: int = 12
    """Blocks of time, at least, over which the residual differs for the intervals of values: what
    is missing besides is no noise. With 6 to 48 the widths agreed to a third on three rigs."""
    shown: int = 12
    """Rows of each table of what was tried."""
    told: int = 3
    """Remarks on models with several effects that predict as well."""

    split: SplitOptions = field(default_factory=SplitOptions)
    period: PeriodOptions = field(default_factory=PeriodOptions)
    check: CheckOptions = field(default_factory=CheckOptions)
    candidate: CandidateOptions = field(default_factory=CandidateOptions)
    trial: TrialOptions = field(default_factory=TrialOptions)
    screen: ScreenOptions = field(default_factory=ScreenOptions)
    map: MapOptions = field(default_factory=MapOptions)
    search: SearchOptions = field(default_factory=SearchOptions)
    experiment: ExperimentOptions = field(default_factory=ExperimentOptions)
