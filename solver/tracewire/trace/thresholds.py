"""Every threshold of a trace between its data and its choice: meaning, unit, and its source.

The reduced chi-square is the squared residual in sigma per degree of freedom: 1 at the noise of the
sensors. Where a number says "Study:", a study on generated records with known truth asked for it,
which preceded this program; the others are judgements that the benchmark has borne out as a whole
(`python -m benchmarks tracing`), but that were not varied one by one.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CandidateOptions:
    """What is tried of an effect: the sizes of its numbers, by what the record shows."""

    wide: float = 10.0
    """The upper bound of a shape, in units of the largest value that is tried first."""
    narrow: float = 0.1
    """The lower bound of a shape that may not be zero, in units of the smallest one."""
    resolved_rates: float = 0.01
    """The part of the samples, of those that move, below whose rates nothing is resolved."""
    slowest_rate: float = 0.01
    """The least part of the largest rate that counts as resolved."""
    moves: float = 1e-3
    """Of the largest rate: what is slower rests."""
    near_rest: float = 0.1
    """Of the largest rate: what a rate that keeps its sign comes down to, to come near rest."""
    both_signs: float = 0.05
    """Of the largest absolute value of a signal: what it reaches on the other side of zero, to take
    both signs."""
    parts: tuple[float, ...] = (-1.3, -0.6, 0.4, 1.0, 1.4)
    """Of the root mean square of a signal: where the size of an effect is looked at."""
    variants: int = 160
    """Choices of the shapes of one candidate that are screened, at most."""
    memory_tolerance: float = 1e-4
    """The relative tolerance of what memories put out: a screen needs no more."""
    memory_steps: int = 5
    """Steps between two samples, on average, at which memories that run together are split: one of
    them needs so short steps. The others of rigs took 1 to 3."""
    pure_tone: float = 0.02
    """The part of a drive's variance that its sine may leave."""
    longest_lag: float = 0.25
    """The part of the longest series that a lag takes at most where it is first tried."""

    samples_in_a_wave: float = 4.0
    """Samples that a wave takes at least: along the coordinate at the median rate, or in time."""
    most_waves: int = 400
    """Waves in the longest way of the coordinate, at most."""
    lengths_a_wave: int = 2
    """Lengths that are scanned for each wave more on the way."""
    finer_lengths: int = 2
    """Lengths that are scanned on each side of a peak, between it and the length beside it."""
    scanned: int = 6000
    """Residuals on which the lengths of waves are scanned; of a longer record those of windows that
    are spread evenly over it."""
    wave_peaks: int = 6
    """Lengths of the best waves that are tried first."""
    line_chance: float = 1e-3
    """The probability that white noise has a line in its spectrum as high as one that is tried."""
    line_finer: int = 4
    """Frequencies of the spectrum for each that is independent: a refit finds what lies between."""
    line_sparse: float = 20.0
    """Times its samples that a record with gaps may have room for: of what is longer the spectrum
    would fill the memory."""
    line_near: int = 25
    """Frequencies, 1 over the record's length apart, among whose power a line stands out."""
    line_around: float = 2.0
    """Frequencies, 1 over the record's length apart, beside the sum of two lines where the period
    of a wave that modulates a signal is looked for: the lines of a swing are that wide."""
    modulated_lines: int = 2
    """Lines of a signal, the highest ones, that a wave which modulates it is looked for beside."""
    modulated_least: float = 0.01
    """The least power of such a line, as a part of the highest."""
    teeth: int = 48
    """The most teeth, slots or poles of a turn that are tried one by one."""


@dataclass(frozen=True)
class TrialOptions:
    """What a fit with effects may cost, and how it passes the gate."""

    least_steps: int = 1500
    """Steps of a run that are always allowed."""
    steps_a_sample: int = 15
    """Steps of a run for each sample beside them: what is slower is a failure, and no candidate to
    wait for."""
    events_a_sample: int = 5
    """Events of a run for each sample, at most."""
    seconds: float = 20.0
    """Seconds of one run, at most."""
    steps: int = 20
    """Steps of a fit, at most."""
    in_flat: float = 0.1
    """The component of a value in a direction of length 1 that the data do not show, from which on
    the value takes part in it."""
    not_astray: float = 2.0
    """The mean squared residual of a window, in the noise's variance, up to which its start has not
    been led astray."""
    ruling: float = 4.0
    """A window with this many times the squared residual of the middle one may rule a fit. Seen in
    the demonstration: two of 21 windows, at 11 and 5 times, held all values at twice the squared
    error."""
    few_ruling: float = 0.25
    """The part of the windows, at most, that is left out to see whether it rules a fit."""
    near_bound: float = 1e-3
    """Of the range between two bounds, or of the size of a number: how near to one is on it."""
    phase_steps: int = 8
    """Steps of the fit of a phase to a series that no fit has seen."""
    rescans: int = 2
    """How often a length that no fit changes is scanned again beside a model, which is then
    refitted."""
    rescan_spread: float = 0.04
    """How far it may be from the length of the scan before, as a part of it: the half of what lies
    between two lengths of that scan where there are six steps."""
    rescan_lengths: int = 17
    """Lengths of a grid over that spread."""
    rescan_grids: int = 2
    """Grids: each lies between two lengths of the one before."""

    gate_drop: float = 0.02
    """The part by which the squared error falls on the gate, at least, of a model at the noise.
    Study: with many samples everything tiny is significant."""
    gate_material: float = 1 / 3
    """Far above it everything is significant: the part of what is above the noise that falls."""
    gate_noise: float = 1.5
    """The reduced chi-square up to which the gate and the pruning take a model to be at the
    noise."""
    gate_errors: float = 2.0
    """Standard errors over windows by which the squared error falls."""
    gate_improved: float = 0.75
    """Or the part of the windows that improve."""
    gate_decisive: float = 100.0
    """A fall of BIC that needs less support from the gate. Study: on 16 short windows a true
    second effect was refused whose BIC fell by more than 300."""
    gate_few_errors: float = 1.0
    """Standard errors that are then enough."""
    gate_harm: float = 0.1
    """Or the part of what windows gain that others may lose: a stop is met in few, and harms
    none."""
    gate_astray: float = 30.0
    """Times the noise's variance from which on a window has lost its track, as by an impact that
    comes a sample too early, where the model is at the noise elsewhere."""
    gate_few_astray: float = 0.1
    """The part of the windows that may have."""


@dataclass(frozen=True)
class ScreenOptions:
    """What one linearisation promises, and what of it is worth a refit."""

    nodes: int = 13
    """Samples of a piece of the linearised run: few hats at a time keep a run cheap, many pieces
    cost runs."""
    chance: float = 1e-3
    """The probability that noise does as well, below which what stands out is tried. Study: an
    error of the solver alone can go below it; the gate then refuses."""
    draws: tuple[int, int] = (50, 200)
    """Draws of white noise that tell that probability: at first, and where that is not enough."""
    sure: tuple[float, float] = (1e-5, 0.02)
    """The first draws are enough where they tell less than the one, or more than the other."""
    seed: int = 20
    """Of the random numbers of the draws."""

    far_from_data: float = 0.05
    """The root mean square of a residual over that of what the signal moves beside a straight line,
    from which on a model moves so far from the data that effects are judged along these."""
    torque_nodes: int = 120
    """Nodes, at most, of the torques that let a window of a model far from the data follow them."""
    torque_bend: float = 0.3
    """The size of second differences of such a torque from node to node, of the root mean square
    of the sum at its place."""
    torque_level: float = 1e-3
    """How much less than its bends the size of such a torque is held."""
    followed: float = 0.1
    """The part of the squared residual, at most, that such torques may leave."""
    trust: float = 0.7
    """The part of an expected coefficient at which a refit begins, as in the study."""
    wrong_sign: float = 0.1
    """The part of a promise of the wrong sign at which a refit begins with the right one."""
    paired: int = 24
    """How many single effects are paired with each other."""
    paired_hidden: int = 8
    """How many more are paired that have an impossible sign alone, as a quadratic drag beside the
    dry friction that is missing, too."""
    least_gain: float = 5.0
    """Half the fall of BIC from which on an effect is worth a refit."""
    singles: int = 6
    """Single effects that are refitted."""
    pairs: int = 4
    """Pairs that are refitted."""
    simple_pairs: int = 2
    """Of these: the best one at each of the smallest numbers of fitted numbers."""
    many: int = 10
    """Single effects that are refitted far from the noise, where promises are poor."""
    shows: float = 5.0
    """Standard errors of a coefficient that the data would show."""


@dataclass(frozen=True)
class MapOptions:
    """The smooth maps that say where something is missing and what it depends on."""

    coarse: int = 11
    """Bumps over the range of a variable."""
    medium: int = 41
    """The same, finer. Study: of sin(12 q) 11 bumps explain 11 %, 41 explain 97.5 %."""
    fine: int = 121
    """The same, where the samples resolve them."""
    rates: tuple[int, int] = (31, 21)
    """Bumps over the range of a rate, on a linear and on an asinh scale."""
    surfaces: tuple[tuple[int, int, bool], ...] = (
        (7, 7, False), (9, 9, True), (21, 5, False), (21, 5, True),
    )  # fmt: skip
    """Bumps over a coordinate and a rate, and whether the rate is on its asinh scale."""
    others: int = 7
    """Bumps over each of two variables of different bodies."""
    slopes: tuple[float, ...] = (0.05, 0.005)
    """Of the root mean square of a rate: where its asinh scale turns from linear to logarithmic."""
    lags: tuple[float, ...] = (0.03, 0.06, 0.12, 0.25, 0.5, 1.0)
    """Time constants of low-passed signals, as parts of the period of the motion."""
    plays: tuple[float, ...] = (0.03, 0.08, 0.2, 0.4, 0.7)
    """Widths of stop operators as parts of the largest coordinate."""
    harmonics: int = 4
    """Multiples of the phase of a drive."""
    in_time: int = 10
    """Bumps in time in each series."""
    tonal: float = 0.8
    """The part of a drive's variance that one sine explains where its phase has a meaning."""

    folds: int = 4
    """Groups of pieces that are left out in turn."""
    pieces: int = 24
    """Pieces of a series that are left out as wholes."""
    seed: int = 7
    """Of the random order of the folds."""
    ridges: tuple[float, ...] = (1e-9, 10**-7.5, 1e-6, 10**-4.5, 1e-3, 10**-1.5, 1.0)
    """The weights of smoothness that compete, in units of the mean square of a column."""
    near: float = 0.95
    """Of the best share: what is as good as it, at the same place."""
    near_elsewhere: float = 0.98
    """The same at another place."""
    least_share: float = 0.1
    """The share of the excess below which nothing is said to depend on anything."""
    least_fall: float = 25.0
    """A smaller fall of the squared residual, in the noise's variance, is noise."""
    history_counts: int = 3
    """How many variables the history of a motion counts as."""
    grid: tuple[int, int] = (81, 25)
    """Points of the table of a missing torque, along one variable, and along each of two."""

    force_bins: int = 9
    """Bins of a variable with equally many samples, and bins of equal width; both kinds of edges
    are used: a body that mostly rests moves fast in few samples."""
    force_samples: int = 8
    """Samples of such a bin, at least."""
    force_nodes: int = 500
    """Nodes of a missing torque in a window, between which it is straight: 2700 at the samples of a
    record at 1 kHz took half a minute and half a GB, and show the same."""
    force_smooth: float = 0.3
    """The size that a missing torque may have between neighbouring nodes, of the sum at its
    place."""


@dataclass(frozen=True)
class SearchOptions:
    """The refits in the loop, and how what they found is pruned and compared."""

    far: float = 30.0
    """Reduced chi-square: longer windows than those that leave this much say little, as there the
    residual does not depend linearly any more on what is missing."""
    near: float = 3.0
    """The same from which on a single effect comes near the noise, and pairs are for later."""
    nearer: float = 8.0
    """How many times less a step has to leave, while it is far from the noise, for another one to
    follow it."""
    kept: int = 3
    """Proposals of a kind that are refitted on all windows."""
    kept_far: int = 5
    """The same far from the noise."""
    slower: float = 6.0
    """How many times the cost of the model before an effect may take, in steps of a run."""
    within: float = 2.0
    """How many times the sum of squares of another one a refit must come near."""
    within_noise: float = 1.2
    """The same where that one is at the noise."""
    steps: int = 20
    """Steps of a refit."""
    first_steps: int = 5
    """Steps of the first round of refits."""
    few: int = 30
    """About how many windows that takes."""
    small: float = 0.1
    """The part of its promised size at which an effect begins again that led a refit astray."""

    cheap: float = 6.0
    """The rise of BIC below which an effect is superfluous. Study: in two of five searches for a
    pair the first effect was a stand-in, which this took out again."""
    immaterial: float = 0.02
    """The part by which a declared term far above the noise must lower the squared error."""
    certain: float = 10.0
    """The standard errors from which on no model without a term is tried: it is there."""
    trifle: float = 5e-4
    """The part of what was missing, as a sum of squares, that an effect beside others must explain
    if it is uncommon or has a rival that does as well. Seen on five rigs: 5e-5 of a drift, 1.6e-4
    of a wave, 6e-6 of a drive's gain, 2e-4 of a play, 4e-4 of a bias, where other names were
    right."""
    rough: float = 3.0
    """How many times as much the squared error may rise without such an effect: its standard error
    says roughly what it takes, and says next to nothing where other effects hold its coefficient.
    Seen on a law that no block has: 3e-4 of the excess, and 50 times the noise."""
    slight: float = 0.1
    """The part of the squared error of the noise below which an effect beside others is a part of
    what is left, where that is no noise either. Seen on four rigs: 0.02 to 0.06."""
    related: float = 0.9
    """The likeness from which on an effect is a rival of another one."""
    related_beside: float = 0.95
    """The same of what an effect leaves of others where it is there."""
    related_together: float = 0.5
    """The same where two effects came together."""
    rivals: int = 5
    """Rivals of an effect that are refitted."""
    behind: float = 10.0
    """How many times the sum of squares of the best model a rival may leave in few short windows,
    where few steps may not bring it further."""
    bare: float = 2.0
    """A difference of BIC up to which the effect with fewer numbers is the better one: it is not
    worth more than a bare mention (R. E. Kass, A. E. Raftery, Bayes factors, 1995)."""
    tied: float = 10.0
    """A rival that BIC puts less than this behind is a tie."""
    tie_blocks: int = 10
    """Blocks of time over which a rival is compared."""
    tie_errors: float = 2.0
    """Standard errors over blocks up to which a rival is a tie. In white noise that is a difference
    of 16 in BIC; where few blocks make the difference, as with a law that is only nearly right, of
    more. On a measured pendulum, three other laws and an offset were 1.2 to 1.8 behind, 11 to 28 in
    BIC."""
    tie_left: float = 1.4
    """The squared error that a tie so close over blocks leaves at most, of that of the best model.
    On 53 rigs and records and in the tests 10 of them left 1.006 to 1.08 of it, and one, which was
    better on unseen data, 1.3; three left 4.2, 17 and 31, and were wrong. One just over two errors
    behind left 1.5 of it, and 16 times the error on unseen data."""


@dataclass(frozen=True)
class ExperimentOptions:
    """Experiments that would tell effects apart."""

    tied: int = 2
    """Ties of an effect for which an experiment is looked for."""
    decides: float = 1.0
    """A separation in sigma (root mean square) below which an experiment does not decide."""
    alike: float = 0.1
    """A best separation below which the two are the same law on this rig."""
    sizes: tuple[float, ...] = (0.1, 0.2, 0.5, 1.0)
    """Of the largest drive, or of the widest motion, that was measured."""
    beyond: float = 1.1
    """How far a release may begin, of the widest motion that was measured: a little farther."""
    reach: float = 2.0
    """How far the signals may go, of their range in the records, in both models. Of a glider on a
    track of 2 m an experiment without this bound went 63 m."""
    both_sides: float = 0.5
    """How far a drive goes on its smaller side of zero, of the larger one, to be a sine around
    zero; else it is one around its mean."""
    off_zero: float = 0.1
    """Of the motion that was measured: how far from zero a place of rest is told."""
    pitches: tuple[float, ...] = (0.15, 0.4, 0.8, 1.25, 2.5)
    """Of the main frequency that was measured."""
    near_sizes: tuple[float, float] = (0.8, 1.25)
    """Releases, and frequencies, that are tried around the best one, as parts of it."""
    near_amplitudes: tuple[float, float] = (0.75, 1.33)
    """The same of amplitudes."""
    rounds: int = 2
    """How many times experiments around the best one are tried."""
    samples: int = 300
    """Samples of an experiment, at most."""
    samples_a_period: int = 30
    """Samples in a period of the measured motion."""
    coarser: int = 20
    """How many times the interval of the record the samples may be apart."""
    highest: float = 0.05
    """The highest frequency, in samples^-1."""
    windows: tuple[int, int] = (3, 12)
    """Windows of the rival's fit: least, most."""
    steps: int = 100_000
    """Steps of the solver in an experiment."""
    seconds: float = 30.0
    """Seconds that one may take."""
    events: int = 20_000
    """Events in one."""
