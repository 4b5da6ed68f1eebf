"""`trace`: fit, find the residual, try every effect at every place, accept only on unseen data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.diagram import Diagram, set_values
from tracewire.errors import FitError
from tracewire.fit.fit import with_measured_signals
from tracewire.fit.measured import Measured, load_measured
from tracewire.fit.noise import channel_noise
from tracewire.fit.result import Fit
from tracewire.trace.candidates import Candidate, extend, find_candidates
from tracewire.trace.found import Found, FoundEffect, HeldOut, Ranked, Verdict
from tracewire.trace.judge import AT_NOISE, gate, prune
from tracewire.trace.places import find_places
from tracewire.trace.screening import Proposal, screen_candidates, shortlist
from tracewire.trace.statistics import Screen, bic
from tracewire.trace.stretches import can_be_cut, share_out
from tracewire.trace.trial import Bench, Trial

Vector = NDArray[np.float64]
MOST_EFFECTS = 3
LEAST_GAIN = 5.0
LIKE = 0.985


def trace(
    subject: Model | Fit,
    measured: Sequence[Measured] | None = None,
    *,
    rtol: float = 1e-6,
    progress: Callable[[str], None] | None = None,
) -> Found:
    """Trace the residual of a diagram on its measured series to an effect that it lacks.

    Every effect of the library is tried at every sum that feeds a rate, and an offset at every
    measured channel: first by a score test on one linearisation, then the best, and pairs of them,
    by a refit in the loop, ranked by BIC. It is accepted only if it improves stretches that the fit
    did not see; the errors reported come from a third stretch.

    Raises DataError where the series cannot be used, FitError where the model does not run.
    """
    return _Tracing(subject, measured, rtol, progress or (lambda text: None)).found()


class _Tracing:
    def __init__(
        self,
        subject: Model | Fit,
        measured: Sequence[Measured] | None,
        rtol: float,
        progress: Callable[[str], None],
    ) -> None:
        self.begun: dict[str, float] = {}
        if isinstance(subject, Fit):
            self.begun = dict(subject.values)
            measured = subject.measured if measured is None else measured
            subject = subject.model
        model = with_measured_signals(subject, measured)
        self.model, self.tell = model, progress
        self.places = find_places(model)
        series = tuple(load_measured(model) if measured is None else measured)
        sigma = channel_noise([m for m in series if m.use != "validate"])
        self.bench = Bench(model, series, sigma, rtol)
        self.stretches = share_out(model, series)
        self.words: list[str] = []
        self.ranking: list[Ranked] = []
        if not self.places:
            self.words.append("no sum of the diagram feeds a rate: only sensor offsets were tried")

    def found(self) -> Found:
        declared = self.declared_fit()
        best = declared
        screen: Screen | None = None
        while len(best.effects) < MOST_EFFECTS:
            step = self.step(best)
            if step is None:
                break
            best, screen = step
        if not best.effects:
            return self.report(declared, declared, (), None)
        self.tell("refitting on long runs")
        long, removed = prune(self.bench, self.lengthened(best), self.tell)
        self.words += [f"'{name}' is not needed beside the others" for name in removed]
        dropped = tuple(name for name in removed if name in self.model.flat.parameters)
        return self.report(self.lengthened(declared), long, dropped, screen)

    def declared_fit(self) -> Trial:
        """The diagram as it is, fitted; cut into windows where one run does not reach the noise."""
        self.tell("fitting the declared model")
        bench = self.bench
        trial = bench.grown(self.model, (), self.stretches.train, self.begun)
        cut = any(s.free for s in self.stretches.train)
        if trial.s2 > AT_NOISE and not cut and can_be_cut(self.model, bench.measured):
            self.stretches = share_out(self.model, bench.measured, cut=True)
            trial = bench.grown(self.model, (), self.stretches.train, trial.values)
        self.words += self.stretches.words
        return trial

    def lengthened(self, trial: Trial) -> Trial:
        """The trial refitted on long runs, which determine coefficients better than windows do."""
        starts = {(s.measured.name, s.begin): s.start for s in trial.segments}
        runs = [
            replace(run, start=starts.get((run.measured.name, run.begin), run.start))
            for run in self.stretches.runs()
        ]
        scales = {u.name: u.scale for u in trial.criterion.unknowns}
        return self.bench.grown(trial.model, trial.effects, runs, trial.values, scales)

    def step(self, now: Trial) -> tuple[Trial, Screen] | None:
        """One more effect, or a pair: screened, refitted, ranked, and passed by the gate."""
        self.tell("screening effects")
        candidates = find_candidates(now.model, self.places, now.effects)
        screen, scales = screen_candidates(self.bench, now, self.places, candidates)
        # far from the noise the residual is so correlated that a score proves nothing: try the best
        least = LEAST_GAIN if now.s2 <= AT_NOISE else -np.inf
        proposals = shortlist(screen, candidates, MOST_EFFECTS - len(now.effects), least)
        trials = [t for p in proposals if (t := self.extended(now, p, scales)) is not None]
        if not trials:
            return None
        part = min(trials, key=lambda trial: trial.rss).part

        def quality(trial: Trial) -> float:
            return bic(trial.rss, now.count, part, trial.unknowns)

        trials.sort(key=quality)
        winner: Trial | None = None
        for trial in trials:
            rise = quality(trial) - quality(now)
            remark = ""
            if winner is None:
                passed, remark = self.judged(now, trial, trials, rise)
                winner = trial if passed else None
            names = " + ".join(map(str, trial.effects[len(now.effects) :]))
            self.ranking.append(Ranked(names, rise, trial.s2, remark))
        return None if winner is None else (winner, screen)

    def judged(
        self, now: Trial, trial: Trial, trials: Sequence[Trial], rise: float
    ) -> tuple[bool, str]:
        """Whether a trial passes: in BIC, at the gate, and a pair at the gate beside each of it."""
        if rise > -2 * LEAST_GAIN:
            return False, "no better than before"
        passed, remark = gate(self.bench, now, trial, self.stretches.gate)
        for single in trials:
            if passed and set(single.effects) < set(trial.effects):
                passed, remark = gate(self.bench, single, trial, self.stretches.gate)
                remark += f" (beside {single.effects[-1]} alone)"
        return passed, remark

    def extended(self, now: Trial, proposal: Proposal, scales: Mapping[str, float]) -> Trial | None:
        """The model with more effects, refitted from where it stood; None if it does not run."""
        self.tell("refitting with " + " and ".join(map(str, proposal.effects)))
        added = [(c, 0.0) for c in proposal.effects if c.block is not None]
        model = self.bench.compiled(extend(now.model.diagram, added))
        pairs = list(zip(proposal.effects, proposal.expected, strict=True))
        values = now.values | {c.unknown: 0.7 * value for c, value in pairs}
        sizes = dict(scales) | {
            c.unknown: max(abs(value), 1e-6 * scales[c.unknown]) for c, value in pairs
        }
        effects = (*now.effects, *proposal.effects)
        try:
            return self.bench.refit(model, effects, now.segments, values, sizes)
        except FitError:
            self.words.append(f"with {' and '.join(map(str, proposal.effects))} it does not run")
            return None

    def report(
        self, declared: Trial, best: Trial, dropped: tuple[str, ...], screen: Screen | None
    ) -> Found:
        self.tell("checking on the stretch that played no part")
        bench, segments = self.bench, self.stretches.validate
        if any(s.free for s in segments):
            self.words.append(
                "on the stretch that played no part only its start states were fitted"
            )
        before = bench.in_units(segments, bench.elsewhere(declared, segments))
        after = bench.in_units(segments, bench.elsewhere(best, segments))
        values = best.values | dict.fromkeys(dropped, 0.0)
        return Found(
            verdict=_verdict(best),
            effects=tuple(self.effect(e, values, screen) for e in best.effects),
            dropped=dropped,
            values=values,
            declared=declared.values,
            rmse_before=_rmse(before),
            rmse_after=_rmse(after),
            sigma=bench.sigma,
            s2_before=declared.s2,
            s2_after=best.s2,
            fitted_before=_rmse(bench.in_units(declared.segments, declared.residuals())),
            fitted_after=_rmse(bench.in_units(best.segments, best.residuals())),
            ranking=tuple(self.ranking),
            held_out=tuple(self.held_out(before, after)),
            words=tuple(self.words),
            original=self.model.diagram,
            diagram=self.edited(best, values),
        )

    def held_out(self, before: Sequence[Vector], after: Sequence[Vector]) -> Iterable[HeldOut]:
        """Measured and simulated signals of the stretches that played no part."""
        for segment, b, a in zip(self.stretches.validate, before, after, strict=True):
            for n, signal in enumerate(segment.signals):
                measured = segment.measured.values[signal][segment.rows]
                yield HeldOut(
                    series=segment.measured.name,
                    signal=signal,
                    unit=self.model.flat.units.get(signal, ""),
                    t=segment.t,
                    measured=measured,
                    before=measured + b[:, n],
                    after=measured + a[:, n],
                )

    def effect(
        self, candidate: Candidate, values: Mapping[str, float], screen: Screen | None
    ) -> FoundEffect:
        """An effect of the result, with the candidates that these data cannot tell from it."""
        ties: list[str] = []
        if screen is not None and candidate.unknown in screen.columns:
            ties = [
                str(other)
                for other in find_candidates(self.model, self.places)
                if other.unknown != candidate.unknown
                and other.unknown in screen.columns
                and screen.likeness(candidate.unknown, other.unknown) > LIKE
            ]
        params = {candidate.parameter(): values[candidate.unknown]}
        return FoundEffect(candidate.effect, candidate.place, params, tuple(ties))

    def edited(self, best: Trial, values: Mapping[str, float]) -> Diagram:
        """The original text with the effects and the refitted parameters."""
        if not best.effects:
            return self.model.diagram
        diagram = extend(self.model.diagram, [(e, values[e.unknown]) for e in best.effects])
        own = {n: v for n, v in values.items() if n in self.model.flat.parameters}
        return set_values(diagram, own)


def _verdict(best: Trial) -> Verdict:
    if best.effects:
        return "effect"
    return "null" if best.s2 <= AT_NOISE else "unexplained"


def _rmse(residuals: Iterable[Vector]) -> float:
    joined = np.concatenate([r.ravel() for r in residuals])
    return float(np.sqrt(np.mean(joined**2)))
