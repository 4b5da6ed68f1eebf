"""The search: from the declared model to the effects that it lacks, one step after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tracewire.compile import Model
from tracewire.errors import FitError, SimulationError
from tracewire.residual import Section, Segment, evaluate_windows, fit_initial_states
from tracewire.solve import parameter_values
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import signal_scales_of
from tracewire.trace.check.outlier_windows import fit_without_outliers
from tracewire.trace.check.revisits import has_revisits, observable_candidates
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.assimilation import assimilate, candidates_along_data
from tracewire.trace.screen.screening import Proposal, Screen, screen_candidates
from tracewire.trace.screen.shortlist import distinct, shortlist
from tracewire.trace.screen.torque_linearisation import TorqueLinearisation
from tracewire.trace.search.common import common_first
from tracewire.trace.search.refits import RefitResult, Refits, new_effects
from tracewire.trace.search.workers import Workers
from tracewire.trace.trials.data_split import DataSplit
from tracewire.trace.trials.judge import judge_on_gate
from tracewire.trace.trials.precision import is_loose, tighter
from tracewire.trace.trials.relative_error import relative_error
from tracewire.trace.trials.scanned_lengths import rescan_lengths
from tracewire.trace.trials.trial import TraceProblem, Trial


@dataclass(frozen=True, eq=False)
class Step:
    """One step of the search: where it stood, what the screen promised, what was tried."""

    before: Trial
    screen: Screen
    p_value: float
    refits: tuple[RefitResult, ...]
    after: Trial | None
    words: str


@dataclass
class Search:
    """What the steps of a search share."""

    problem: TraceProblem
    data_split: DataSplit
    places: Sequence[Place]
    shortest: int
    values: Mapping[str, float]
    tell: Callable[[str], None]
    words: list[str]
    workers: Workers = field(default_factory=Workers)
    steps: list[Step] = field(default_factory=list)
    first: Trial | None = None
    best: Trial | None = None
    waves: dict[str, dict[str, tuple[float, ...]]] = field(default_factory=dict)
    """The lengths of waves that were scanned last, by candidate and shape."""
    has_revisits: bool = True
    """Whether a body comes back to where it was: else much looks the same."""
    _last: tuple[Trial, TorqueLinearisation] | None = None

    @property
    def options(self) -> TraceOptions:
        """What the user asks, and every threshold."""
        return self.problem.options

    @property
    def declared_and_best(self) -> tuple[Trial, Trial]:
        """The declared fit, and the best that was found so far."""
        if self.first is None or self.best is None:
            raise AssertionError("the declared model comes first")
        return self.first, self.best

    def note(self, text: str) -> None:
        """Keep a sentence for the result, once."""
        if text not in self.words:
            self.words.append(text)

    @property
    def refits(self) -> Refits:
        """How proposals are refitted."""
        return Refits(self.problem, self.tell, self.words, self.workers)

    @property
    def free(self) -> tuple[str, ...]:
        """The states that are free where a window begins: none where the motion is prescribed, so
        that no place moves a state and each series begins as it says."""
        moved = any(place.a for place in self.places) or not any(p.v for p in self.places)
        begun = any(value is None for m in self.problem.measured for value in m.start.values())
        return self.problem.states if moved or begun else ()

    @property
    def lengths(self) -> list[int]:
        """The window lengths in samples, from the shortest to whole sections."""
        longest = self.data_split.longest
        if not self.free:
            return [longest]
        lengths = [min(self.shortest, longest)]
        split = self.options.split
        while lengths[-1] * split.longer < split.nearly_whole * longest:
            lengths.append(lengths[-1] * split.longer)
        return lengths if lengths[-1] == longest else [*lengths, longest]

    @property
    def short_length(self) -> int:
        """The second of the window lengths: short, and not many windows."""
        return self.lengths[min(1, len(self.lengths) - 1)]

    def windows(self, sections: Sequence[Section], length: int) -> list[Segment]:
        """The windows of some sections."""
        return self.data_split.windows(self.problem.declared, sections, length, self.free)

    def whole_windows(self, sections: Sequence[Section]) -> list[Segment]:
        """Each section as one window."""
        return [w for section in sections for w in self.windows([section], section.count)]

    def fit_declared(self) -> Trial:
        """The diagram as it is, fitted to the shortest windows."""
        self.tell("fitting the declared model")
        options, length = self.options.search, self.lengths[0]
        windows = self.windows(self.data_split.train, length)
        trial = self.problem.fit((), windows, length, self.values, steps=options.first_steps)
        if trial.reduced_chi2 > options.far:
            # a fit that few windows rule also ends where it looks flat
            trial = fit_without_outliers(self.problem, trial, windows, options.first_steps)
        if trial.converged:
            return trial
        return self.problem.fit((), trial.windows.segments, length, trial.values)

    def omits_windows(self, trial: Trial) -> bool:
        """Whether a trial leaves out windows that it does not bear."""
        return len(trial.windows.segments) < len(self.windows(self.data_split.train, trial.length))

    def refit_on_all(self, trial: Trial) -> Trial:
        """A trial on all windows, where it bears those that were left out."""
        if not self.omits_windows(trial):
            return trial
        windows = self.windows(self.data_split.train, trial.length)
        whole = self.problem.try_refit(trial, windows, trial.length)
        if whole is None or not whole.reduced_chi2 < self.options.search.far:
            return trial
        return whole

    def finish(self, trial: Trial) -> Trial:
        """A trial whose fit has converged, where it does so in another run of steps, with lengths
        that were scanned beside it."""
        if not trial.converged:
            trial = self.problem.try_refit(trial) or trial
        return rescan_lengths(self.problem, trial)

    def tighten(self) -> None:
        """Let the solver have a tenth of its tolerance from now on."""
        self.problem = tighter(self.problem)
        self.words.append(
            f"the solver's error counted beside the residual: rtol is {self.problem.rtol:.0e} now"
        )

    def fit_declared_precisely(self) -> Trial:
        """The declared fit, with a tolerance at which the solver's error does not count."""
        trial = self.fit_declared()
        for _ in range(self.options.check.tightened):
            if not is_loose(self.problem, trial):
                break
            self.tighten()
            trial = self.fit_declared()
        return trial

    def refit_precisely(self, trial: Trial) -> Trial:
        """A trial with a tolerance at which the solver's error does not count. It grows with the
        windows: on long ones another effect may seem to explain it."""
        for _ in range(self.options.check.tightened):
            if not is_loose(self.problem, trial):
                break
            self.tighten()
            trial = self.problem.refit(trial)
        return trial

    def lengthen_windows(
        self, trial: Trial, sections: Sequence[Section] | None = None, far: float | None = None
    ) -> Trial:
        """A trial refitted on longer and longer windows, as far as its residual stays small, with a
        solver that is precise enough for these. A fit that has not converged may be astray, but not
        near the noise: there it stands where a body begins to stick."""
        sections = self.data_split.train if sections is None else sections
        far = self.options.search.far if far is None else far
        longest = max(section.count for section in sections)
        lengths = [
            n for n in self.lengths if trial.length < n < self.options.split.nearly_whole * longest
        ]
        for length in [*lengths, *([longest] if trial.length < longest else [])]:
            if trial.reduced_chi2 > far:
                break
            self.tell(f"refitting on windows of {length} samples")
            try:
                longer = self.problem.refit(trial, self.windows(sections, length), length)
                longer = self.refit_precisely(longer)
            except FitError:
                break
            ended = longer.converged or longer.reduced_chi2 < self.options.search.near
            if not ended or longer.reduced_chi2 > far:
                break
            trial = longer
        return trial

    def run(self, declared: Trial) -> None:
        """One effect after the other, from the declared fit, until none passes the gate."""
        whole = not self.omits_windows(declared)
        self.first = self.best = best = self.lengthen_windows(declared) if whole else declared
        options = self.options.search
        while len(best.effects) < self.options.effects:
            found = self.add_effect(best)
            if found is None and not best.effects:
                found = self.add_effect_at_declared_values(declared)
            if found is None:
                break
            before = best.reduced_chi2
            self.best = best = self.lengthen_windows(self.refit_on_all(self.finish(found)))
            if best.reduced_chi2 > max(options.far, before / options.nearer):
                break  # the noise is out of reach: models are compared otherwise

    def add_effect(self, now: Trial) -> Trial | None:
        """One more effect, or a pair: screened, refitted, ranked, and passed by the gate."""
        self.tell("screening effects")
        self.steps[-1:] = [
            replace(step, screen=step.screen.best_rows_only()) for step in self.steps[-1:]
        ]
        seen = now
        if now.reduced_chi2 > self.options.search.far and now.count > self.options.most_samples:
            most, together = self.options.most_samples, self.options.windows_together
            seen = self.problem.on_some_windows(now, _spread(now, most, together))
        screen = self.screen(seen)
        p_value = screen.p_value()
        proposals = self._proposals(seen, screen) if p_value <= self.options.screen.chance else []
        if not proposals:
            words = f"nothing stands out (p = {p_value:.2g})"
            self.steps.append(Step(now, screen, p_value, (), None, words))
            return None
        return self._add_best_of(now, screen, p_value, proposals)

    def add_effect_at_declared_values(self, declared: Trial) -> Trial | None:
        """One more effect, or a pair, screened where the values are those that the diagram
        declares, if the fit has moved one far: a friction that makes up for an effect may go where
        that effect cannot be seen."""
        values = moved_values(self.problem.declared, declared.values, self.options.moved)
        if not values or declared.reduced_chi2 < self.options.at_noise:
            return None
        self.tell("screening effects at the declared values")
        there = _at_values(self.problem, declared, values)
        if not all(near.ran for near in there.windows.linearisations):
            return None
        try:
            screen = self.screen(there)
        except FitError:  # it does not run there with its places open
            return None
        found = shortlist(screen, self.options.effects, self.options.screen.singles)
        proposals = [replace(proposal, values=values) for proposal in found]
        return self._add_best_of(declared, screen, screen.p_value(), proposals)

    def _add_best_of(
        self, now: Trial, screen: Screen, p_value: float, proposals: Sequence[Proposal]
    ) -> Trial | None:
        """The best of the proposals that passes the gate, refitted beside a model."""
        singles = [p for p in proposals if len(p.rows) == 1]
        pairs = [p for p in proposals if len(p.rows) > 1]
        results = self.refits.refit_best(now, singles, pairs)
        winner = None
        queue = _worth_judging(results, now, self.options.screen.least_gain)
        queue = common_first(queue, results, now, self.options)
        numbers_judged: set[int] = set()
        while queue and winner is None:
            number = queue.pop(0)
            numbers_judged.add(number)
            passed, remark, simpler = self.judge(now, results[number], results)
            results[number] = replace(results[number], remark=remark)
            if passed:
                winner = results[number]
            elif simpler is not None and simpler not in numbers_judged:
                # its part stands in its place
                queue = [simpler, *(n for n in queue if n != simpler)]
        words = (
            "no effect passes" if winner is None else f"accepted: {new_effects(winner.trial, now)}"
        )
        after = None if winner is None else winner.trial
        self.steps.append(Step(now, screen, p_value, tuple(results), after, words))
        return after

    def _proposals(self, now: Trial, screen: Screen) -> list[Proposal]:
        """What is worth a refit beside a model: far from the noise first what is judged along the
        data."""
        options = self.options.screen
        room = self.options.effects - len(now.effects)
        along = self.screen_along_data(now)
        if along is None:
            near = now.reduced_chi2 < self.options.search.far
            return shortlist(screen, room, options.singles if near else options.many)
        first = [along.with_values(p) for p in shortlist(along, room, options.singles)]
        return distinct([*first, *shortlist(screen, room, options.singles)])

    def screen(self, trial: Trial) -> Screen:
        """The screen beside a model. Lengths of waves are scanned where there are few samples; else
        they are those that were found there last."""
        taken = [effect.candidate for effect in trial.effects]
        linearisation = self.linearise(trial)
        return self._screen_along(linearisation, trial, self.candidates(linearisation, taken))

    def _screen_along(
        self, linearisation: TorqueLinearisation, trial: Trial, candidates: Sequence[Candidate]
    ) -> Screen:
        options = self.options
        scan = not self.waves or trial.count <= options.most_scanned
        if not scan:
            candidates = [
                replace(c, shapes={**c.shapes, **self.waves.get(str(c), {})}) for c in candidates
            ]
        screen = screen_candidates(
            linearisation, trial, candidates, scan, options.most_residuals, self.note
        )
        for candidate in {str(row.candidate): row.candidate for row in screen.rows}.values():
            if candidate.waves:
                shapes = {name: candidate.shapes[name] for name in candidate.waves}
                self.waves[str(candidate)] = shapes
        return screen

    def screen_along_data(self, trial: Trial) -> Screen | None:
        """The screen beside a model far from the data, along these; None where it is near them, or
        where none can be."""
        options = self.options
        near_noise = trial.reduced_chi2 < options.search.far
        if near_noise or relative_error(trial) < options.screen.far_from_data or not self.free:
            return None
        along = assimilate(self.problem, trial, self.linearise(trial))
        if along is None:
            return None
        taken = [effect.candidate for effect in trial.effects]
        return self._screen_along(
            along, trial, candidates_along_data(self.candidates(along, taken))
        )

    def linearise(self, trial: Trial) -> TorqueLinearisation:
        """The windows of a model linearised in torques at the places; that of the last one is
        kept, as a screen and one along the data ask for the same. Raises FitError where it does not
        run with its places open: a fit has stopped where runs are about to end."""
        if self._last is None or self._last[0] is not trial:
            args = trial.diagram, trial.windows, self.places, self.problem.rtol, self.options
            try:
                self._last = trial, TorqueLinearisation(*args)
            except SimulationError as error:
                raise FitError(error.problems) from None
        return self._last[1]

    def candidates(
        self, linearisation: TorqueLinearisation, taken: Sequence[Candidate]
    ) -> list[Candidate]:
        """The effects at places that may be tried beside those that are there."""
        options, runs = self.options, linearisation.trajectories
        signal_scales = signal_scales_of(runs, options.candidate)
        declared, sines = self.problem.declared, self.problem.drive_sines
        found = find_candidates(
            declared, self.places, signal_scales, options.candidate, taken, sines
        )
        self.has_revisits = has_revisits(self.places, runs, options.check.again)
        if not self.has_revisits:
            found = observable_candidates(declared, found, runs, options.check)
        only, without = self.options.only, self.options.without
        return [
            c
            for c in found
            if (not only or c.place.name in only)
            and c.effect not in without
            and str(c) not in without
        ]

    def judge(
        self, now: Trial, one: RefitResult, results: Sequence[RefitResult]
    ) -> tuple[bool, str, int | None]:
        """Whether a trial passes the gate, also beside each simpler one that was tried, that in
        words, and the number of the one that it does not improve on."""
        length = one.trial.length
        windows = self.windows(self.data_split.gate, length)
        passed, words = judge_on_gate(self.problem, now, one.trial, windows, -one.delta_bic)
        for number, other in enumerate(results):
            if passed and _is_simpler(other, one):
                bic_reduction = other.delta_bic - one.delta_bic
                passed, words = judge_on_gate(
                    self.problem, other.trial, one.trial, windows, bic_reduction
                )
                if not passed:
                    return False, words, number
        return passed, words, None


def moved_values(declared: Model, values: Mapping[str, float], most: float) -> dict[str, float]:
    """The declared values of the fitted parameters, where a fit has moved one of them by more than
    this part of it; else none."""
    known = parameter_values(declared, {})
    own = {name: known[name] for name in values if name in known}
    far = any(abs(values[name] - value) > most * abs(value) > 0 for name, value in own.items())
    return own if far else {}


def _at_values(problem: TraceProblem, trial: Trial, values: Mapping[str, float]) -> Trial:
    """A trial with other values of its unknowns, whose windows begin where these fit best."""
    criterion = problem.free_criterion(trial, trial.windows.segments, {**trial.values, **values})
    return replace(trial, windows=fit_initial_states(evaluate_windows(criterion, np.inf)))


def _is_simpler(other: RefitResult, one: RefitResult) -> bool:
    """Whether a trial is a part of another one, or has an effect that one of the other's imitates,
    as Coulomb friction and a Stribeck curve, and fewer numbers."""
    theirs, mine = ({str(e): e.candidate for e in each.trial.effects} for each in (other, one))
    new, old = theirs.keys() - mine.keys(), mine.keys() - theirs.keys()
    if not new:
        return bool(old)
    fewer = other.proposal.count < one.proposal.count
    return fewer and len(new) == len(old) == 1 and new <= mine[next(iter(old))].imitated


def _spread(trial: Trial, most: int, together: int) -> list[int]:
    """The numbers of windows with about so many samples together, in groups over the record."""
    sizes = [near.residual.size for near in trial.windows.linearisations]
    every = -(-sum(sizes) // most)
    return [n for n in range(len(sizes)) if n // together % every == 0]


def _worth_judging(results: Sequence[RefitResult], now: Trial, least_gain: float) -> list[int]:
    """The two best, and the best single effect: where no pair is more than its parts."""
    gains = [n for n, one in enumerate(results) if one.delta_bic < -2 * least_gain]
    gains = [n for n in gains if len(results[n].trial.effects) > len(now.effects)]
    singles = [n for n in gains if len(results[n].trial.effects) == len(now.effects) + 1]
    return sorted({*gains[:2], *singles[:1]})
