"""Every threshold of what a trace takes from its data: meaning, unit, and where it comes from.

Where a number says "Study:", see `thresholds.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

from tracewire.residual import WINDOW


@dataclass(frozen=True)
class SplitOptions:
    """How series are shared out between fit, gate and final claim, and cut into windows."""

    blocks: int = 9
    """Parts of a series of which every third is the gate."""
    few_blocks: int = 3
    """The same of a series whose ninths are too short for a window."""
    validated: float = 1 / 6
    """The part at the end of a series that is held back for the final claim."""
    moving: float = 0.02
    """The part of its range that a signal still moves through at the end of a run; where all move
    less, the run has come to rest."""
    shortest: int = 16
    """Samples of the shortest window, at least."""
    in_a_period: float = 5.0
    """The shortest windows in a period of the slowest measured signal. Study: with windows of 0.25
    and 0.5 s the true effect came first in 7 of 8 screens, of 2 s in fewer, of 8 s some were lost:
    over long ones the residual does not depend linearly on what is missing."""
    longer: int = 3
    """How many times longer the next windows are."""
    nearly_whole: float = 0.75
    """The part of a section from which on a window is as good as the whole section."""
    first_part: float = 0.2
    """The part of a record on which the start of a free run, and a phase, is fitted."""


@dataclass(frozen=True)
class PeriodOptions:
    """What counts as a period of a motion that has no frequency of its own."""

    returns: float = 5.0
    """Turns of a shaft in a record from which on the time of one is a period; the same of moves of
    a body, in a record and between two passages of its mean in one direction."""
    speed_steps: int = 400
    """The steps of time in a record over which a speed is taken, at most."""
    speed_doublings: int = 4
    """How often the steps are doubled until noise makes no moves."""
    rests: float = 0.3
    """The part of the root mean square of a speed below which a move has ended."""
    moves_alike: float = 0.2
    """The part by which the counts of moves at two steps may differ."""
    steps_in_a_move: float = 8.0
    """The steps from one move to the next, at least: means of white noise pass such levels every
    few steps."""


@dataclass(frozen=True)
class CheckOptions:
    """From when on a record, or the declared model, is not fit to be traced."""

    least_samples: int = WINDOW.traced
    """Samples of a series, at least."""
    above_noise: float = 1.5
    """A signal that spreads less than this many times its noise shows nothing else."""
    neighbours: float = 8.0
    """By how much, over the root of N, the mean square of differences of white noise may fall
    below twice its variance (von Neumann 1941: its standard error is about 2 there)."""
    sure_rate: float = 0.9
    """The part of a signal that the integral of its rate explains before their ratio counts."""
    near_factor: float = 0.02
    """How near to a factor between units that ratio is, as a part of it."""

    input_ends: float = 1.5
    """Samples by which an input may begin later, or end earlier, than the signals."""

    near_half: float = 0.1
    """How near to half of the time between samples a delay is that a held input imitates, as a part
    of that half."""

    again: float = 1.2
    """The way a body goes over the range of its coordinate, from which on it has come back."""
    turns: float = 5.0
    """Turns of a shaft from which on one that does not come back has no spring and no stop."""
    swings: float = 2.0
    """Periods in a record of what swings on a body that does not come back, at least: what does not
    swing follows any smooth change of its force."""

    spike: float = 8.0
    """Standard deviations by which a single wrong sample is off its neighbours, at least."""
    spike_side: int = 5
    """Samples on each side of it by whose parabola it is judged."""
    spike_neighbour: float = 3.0
    """Standard deviations by which these are off theirs once it stands on its own, at most."""
    spike_share: float = 0.01
    """The part of what a spike is off by which its neighbours may be off: for a sensor that loses
    a sample where few samples a period lie far off any cubic. Kinks and steps have over 0.1."""
    spike_alike: float = 1 / 3
    """The part of its height by which both sides agree on what should stand there."""
    most_spikes: float = 0.02
    """The part of a record that may be spikes: what is more is no mistake of single samples."""
    gap: float = 3.0
    """The largest sample interval around a spike, in units of their median, at most."""

    mistake_from: float = 30.0
    """The reduced chi-square in short windows from which on a record may hold a mistake."""
    mistake_undone: float = 2.0
    """The reduced chi-square at which no other mistake is looked for."""
    mistake_nearer: float = 30.0
    """How many times less is left once a mistake is undone: no effect of the library does that."""
    mistake_samples: int = 250
    """Samples at the beginning of a record on which mistakes are tried."""
    mistake_window: int = 25
    """Samples of the windows there."""
    mistake_first_steps: int = 8
    """Steps of the fit of the declared model there."""
    mistake_steps: int = 4
    """Steps of a fit with a mistake undone."""
    lag_hopeful: float = 5.0
    """How many times less is left at a lag beside which others are tried."""
    lag_likely: int = 3
    """The likely lags from which a search begins, at most."""
    lag_better: float = 0.9
    """The part of the squared error that a step of the lag must leave, at most, to go on."""
    lag_steps: int = 10
    """Samples by which a lag is followed, at most."""
    lag_longest: float = 2.0
    """The longest lag in s that is looked for."""
    lag_bump: int = 9
    """Half the samples of the smooth bump that takes derivatives of noisy signals."""
    lag_before: int = 4
    """Samples by which a response comes before its drive that no effect explains, at least."""
    lag_after: int = 15
    """Samples by which it comes after its drive that no effect explains, at least."""
    suspicious: float = 3.0
    """The reduced chi-square that no effect explains, from which on mistakes are looked for."""

    tighter: float = 0.1
    """The factor by which a solver's tolerance is tightened."""
    tightened: int = 2
    """How many times it may be tightened."""
    solver_error: float = 0.3
    """What the residual of a window may move with the tolerance, as a part of the larger of the
    noise and what is left, as a root mean square: a tenth of its squares. Study: with too long
    steps the solver's error looked like an effect of the speed."""

    stray: float = 30.0
    """A window with this many times the squared residual of the middle one is a stray."""
    strays_left: float = 0.5
    """The part of the windows that stays at least where strays are left out."""
    strays_left_converged: float = 0.8
    """The same where the fit converged: windows that are many and far off show what is missing."""
    stray_rounds: int = 4
    """Rounds of leaving strays out, at most."""
    stray_share: float = 0.5
    """The part of the sum of squares from which on strays rule a fit, and are left out."""
    led_astray: float = 30.0
    """The reduced chi-square from which on strays may lead a fit."""
