"""The search: from the declared model to the effects that it lacks, one step after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tracewire.errors import FitError
from tracewire.fit.segment import Segment
from tracewire.trace.candidates import find_candidates
from tracewire.trace.judge import MATERIAL, Verdict, gate
from tracewire.trace.levels import levels_of
from tracewire.trace.places import Place
from tracewire.trace.refits import AT_NOISE, FAR, FIRST_STEPS, NEAR, Refits, Tried, named
from tracewire.trace.repeated import comes_back, visible
from tracewire.trace.screening import Screen, screened
from tracewire.trace.shortlist import LEAST_GAIN, MANY, SINGLES, shortlist
from tracewire.trace.strays import without_strays
from tracewire.trace.stretches import Stretches
from tracewire.trace.tangent import Tangent
from tracewire.trace.trial import Bench, Trial
from tracewire.trace.windows import Section

MOST_EFFECTS = 3
CHANCE = 1e-3
LENGTHENED = 0.2
LONGEST = 1000
"""Samples of a section: a search on longer ones takes too long, as contacts do in such runs."""
LONGER = 3
RUNNER_UP = 0.9
"""The part of the fall of BIC of the best effect from which another one is a runner-up."""


@dataclass(frozen=True, eq=False)
class Step:
    """One step of the search: where it stood, what the screen promised, what was tried."""

    before: Trial
    screen: Screen
    chance: float
    tried: tuple[Tried, ...]
    after: Trial | None
    words: str


@dataclass
class Search:
    """What the steps of a search share."""

    bench: Bench
    stretches: Stretches
    places: Sequence[Place]
    shortest: int
    values: Mapping[str, float]
    tell: Callable[[str], None]
    words: list[str]
    steps: list[Step] = field(default_factory=list)
    first: Trial | None = None
    best: Trial | None = None
    returns: bool = True
    """Whether a body comes back to where it was: else much looks the same."""

    @property
    def standing(self) -> tuple[Trial, Trial]:
        """The declared fit, and the best that was found so far."""
        if self.first is None or self.best is None:
            raise AssertionError("the declared model comes first")
        return self.first, self.best

    @property
    def refits(self) -> Refits:
        """How proposals are refitted."""
        return Refits(self.bench, self.tell, self.words)

    @property
    def free(self) -> tuple[str, ...]:
        """The states that are free where a window begins: none where the motion is prescribed, so
        that no place moves a state and each series begins as it says."""
        moved = any(place.a for place in self.places) or not any(p.v for p in self.places)
        begun = any(value is None for m in self.bench.measured for value in m.start.values())
        return self.bench.states if moved or begun else ()

    @property
    def lengths(self) -> list[int]:
        """The window lengths in samples, from the shortest to whole sections."""
        longest = self.stretches.longest
        if not self.free:
            return [longest]
        lengths = [min(self.shortest, longest)]
        while lengths[-1] * LONGER < 0.75 * longest:
            lengths.append(lengths[-1] * LONGER)
        return lengths if lengths[-1] == longest else [*lengths, longest]

    @property
    def short(self) -> int:
        """The second of the window lengths: short, and not many windows."""
        return self.lengths[min(1, len(self.lengths) - 1)]

    def windows(self, sections: Sequence[Section], length: int) -> list[Segment]:
        """The windows of some sections."""
        return self.stretches.windows(self.bench.declared, sections, length, self.free)

    def declared(self) -> Trial:
        """The diagram as it is, fitted to the shortest windows."""
        self.tell("fitting the declared model")
        length = self.lengths[0]
        windows = self.windows(self.stretches.train, length)
        trial = self.bench.fitted((), windows, length, self.values, steps=FIRST_STEPS)
        if trial.s2 > FAR:  # a fit that few windows rule also ends where it looks flat
            trial = without_strays(self.bench, trial, windows, FIRST_STEPS)
        if trial.converged:
            return trial
        return self.bench.fitted((), trial.windows.segments, length, trial.values)

    def is_part(self, trial: Trial) -> bool:
        """Whether a trial leaves out windows that it does not bear."""
        return len(trial.windows.segments) < len(self.windows(self.stretches.train, trial.length))

    def completed(self, trial: Trial) -> Trial:
        """A trial on all windows, where it bears those that were left out."""
        if not self.is_part(trial):
            return trial
        windows = self.windows(self.stretches.train, trial.length)
        try:
            whole = self.bench.again(trial, windows, trial.length)
        except FitError:
            return trial
        return whole if whole.s2 < FAR else trial

    def climbed(
        self, trial: Trial, sections: Sequence[Section] | None = None, far: float = FAR
    ) -> Trial:
        """A trial refitted on longer and longer windows, as far as its residual stays small."""
        sections = self.stretches.train if sections is None else sections
        longest = max(section.end - section.first for section in sections)
        lengths = [n for n in self.lengths if trial.length < n < 0.75 * longest]
        for length in [*lengths, *([longest] if trial.length < longest else [])]:
            if trial.s2 > far:
                break
            self.tell(f"refitting on windows of {length} samples")
            try:
                longer = self.bench.again(trial, self.windows(sections, length), length)
            except FitError:
                break
            if not longer.converged or longer.s2 > far:
                break
            trial = longer
        return trial

    def run(self, declared: Trial) -> None:
        """One effect after the other, from the declared fit."""
        self.first = self.best = declared if self.is_part(declared) else self.climbed(declared)
        self._stepped()
        if self.first.s2 > FAR and self.best.s2 > NEAR and self.free:
            self._lengthened()

    def _stepped(self) -> None:
        """Effects from the best model on, until none passes; then from runners-up of the first
        step, where that does not reach the noise: a stand-in may have been ahead of the truth."""
        first = len(self.steps)
        self._onward()
        runners_up = self._runners_up(first)
        for number, one in enumerate(runners_up, start=1):
            if self.best is None or self.best.s2 < AT_NOISE:
                break
            self.tell(f"from the runner-up {one.trial.effects[-1]} ({number} of {len(runners_up)})")
            known = self.best, self.steps[:]
            step = self.steps[first]
            words = f"accepted a runner-up: {named(one.trial, step.before)}"
            self.steps = [*self.steps[:first], replace(step, after=one.trial, words=words)]
            self.best = self.climbed(self.completed(one.trial))
            self._onward()
            shorter = self.best.length < known[0].length
            if shorter or self.best.s2 > (1 - MATERIAL) * known[0].s2:
                self.best, self.steps = known

    def _onward(self) -> None:
        """Effects from the best model on, until none passes."""
        while self.best is not None and len(self.best.effects) < MOST_EFFECTS:
            found = self.step(self.best)
            if found is None:
                break
            self.best = self.climbed(self.completed(found))

    def _runners_up(self, number: int) -> list[Tried]:
        """Single effects that did nearly as well in a step as the one that was accepted."""
        if number >= len(self.steps):
            return []
        step = self.steps[number]
        winner = next((one for one in step.tried if one.trial is step.after), None)
        if winner is None:
            return []
        near = [one for one in step.tried if one.rise < RUNNER_UP * winner.rise]
        return [one for one in near if one is not winner and len(one.proposal.rows) == 1]

    def _lengthened(self) -> None:
        """The search once more on whole sections, where short windows stay far above the noise.

        What no effect explains at every sample then rules short windows, while what is missing adds
        up in long ones. What is found there counts where it explains the greater part.
        """
        known = self.first, self.best, len(self.steps)
        length = self.lengths[-1]
        if length > LONGEST:
            return
        self.tell("searching on whole sections")
        try:
            first = self.bench.fitted(
                (), self.windows(self.stretches.train, length), length, self.values
            )
        except FitError:
            return
        self.first = self.best = first
        self._stepped()
        if self.best.effects and self.best.s2 < LENGTHENED * first.s2:
            self.words.append("short windows stay far above the noise: searched on whole sections")
            del self.steps[: known[2]]
        else:
            self.first, self.best = known[0], known[1]
            del self.steps[known[2] :]

    def step(self, now: Trial) -> Trial | None:
        """One more effect, or a pair: screened, refitted, ranked, and passed by the gate."""
        self.tell("screening effects")
        tangent = Tangent(now.diagram, now.windows, self.places, self.bench.rtol)
        taken = [effect.candidate for effect in now.effects]
        levels = levels_of(tangent.trajectories)
        candidates = find_candidates(
            self.bench.declared, self.places, levels, taken, self.bench.tones
        )
        self.returns = comes_back(self.places, tangent.trajectories)
        if not self.returns:
            candidates = visible(self.bench.declared, candidates, tangent.trajectories)
        screen = screened(tangent, now, candidates)
        chance = screen.chance()
        count = SINGLES if now.s2 < FAR else MANY
        proposals = shortlist(screen, MOST_EFFECTS - len(now.effects), count)
        if chance > CHANCE or not proposals:
            words = f"nothing stands out (p = {chance:.2g})"
            self.steps.append(Step(now, screen, chance, (), None, words))
            return None
        singles = [p for p in proposals if len(p.rows) == 1]
        pairs = [p for p in proposals if len(p.rows) > 1]
        tried = self.refits.tried(now, singles, pairs)
        winner = None
        for number in _worth_judging(tried, now):
            verdict = self.judged(now, tried[number], tried)
            tried[number] = replace(tried[number], remark=verdict.words)
            if verdict.passed:
                winner = tried[number]
                break
        words = "no effect passes" if winner is None else f"accepted: {named(winner.trial, now)}"
        after = None if winner is None else winner.trial
        self.steps.append(Step(now, screen, chance, tuple(tried), after, words))
        return after

    def judged(self, now: Trial, one: Tried, tried: Sequence[Tried]) -> Verdict:
        """What the gate says of a trial, of a pair also beside each effect alone."""
        length = one.trial.length
        windows = self.windows(self.stretches.gate, length)
        verdict = gate(self.bench, now, one.trial, windows, -one.rise)
        mine = {str(e) for e in one.trial.effects}
        for other in tried:
            if verdict.passed and {str(e) for e in other.trial.effects} < mine:
                fall = other.rise - one.rise
                verdict = gate(self.bench, other.trial, one.trial, windows, fall)
        return verdict


def _worth_judging(tried: Sequence[Tried], now: Trial) -> list[int]:
    """The two best, and the best single effect: where no pair is more than its parts."""
    gains = [n for n, one in enumerate(tried) if one.rise < -2 * LEAST_GAIN]
    gains = [n for n in gains if len(tried[n].trial.effects) > len(now.effects)]
    singles = [n for n in gains if len(tried[n].trial.effects) == len(now.effects) + 1]
    return sorted({*gains[:2], *singles[:1]})
