"""The result of a trace: verdict, effects, what was tried, errors before and after, the diagram."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

from tracewire.array_types import Matrix, Vector
from tracewire.diagram import Diagram, difference
from tracewire.errors import OptionError, unknown
from tracewire.result import Result, plain
from tracewire.trace.options import TraceOptions

Verdict = Literal["null", "effect", "unexplained"]
RunKind = Literal["windowed", "free run"]
IN_JSON = (
    "verdict interrupted effects dropped depends_on missing rmse_before rmse_after sigma s2_before "
    "s2_after declared moved errors steps power experiments explained remainder remainder_depends "
    "held_out noisy_inputs reason options words"
)
"""What a result has in JSON by its own name."""


@dataclass(frozen=True)
class Tie:
    """An effect that these data cannot tell from one that was found: the correlation of the two on
    the data, its refitted parameters in SI, and its BIC relative to the one found."""

    name: str
    place: str
    likeness: float
    params: Mapping[str, float] = field(default_factory=dict)
    rise: float = float("nan")

    def __str__(self) -> str:
        return f"{self.name} @ {self.place}"


@dataclass(frozen=True)
class LikelyInput:
    """An input whose noise alone would explain the residual: the standard deviation of white noise
    in SI, and the reduced chi-square that it would leave."""

    name: str
    sigma: float
    left: float


@dataclass(frozen=True)
class FoundEffect:
    """An effect that the data ask for.

    `place` is a sum, `sensor.SIGNAL` or `drive.INPUT`, `block` the block that was added ('' for a
    sensor's). `params` are its parameters in SI, `coefficient` the one that it is linear in,
    `intervals` 95 % intervals. `gain` is half the fall of BIC that it brought, `masked` the part of
    it that the declared parameters had imitated, `weight` its share among what was tried beside it.
    `share` is the part of the squared error that was missing which it takes beside the others, None
    of one alone. `doubt` says what else would look like it, and what to do about that; '' where
    nothing is known.
    """

    name: str
    place: str
    params: Mapping[str, float]
    ties: tuple[Tie, ...] = ()
    block: str = ""
    coefficient: str = ""
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    gain: float = float("nan")
    masked: float = float("nan")
    weight: float = float("nan")
    share: float | None = None
    doubt: str = ""

    def __str__(self) -> str:
        return f"{self.name} @ {self.place}"

    @property
    def sensor(self) -> str:
        """The measured signal whose sensor the effect changes; '' for other effects."""
        return "" if self.block else self.place.removeprefix("sensor.")


@dataclass(frozen=True)
class CandidateScore:
    """Effects that were tried in a step: the half fall of BIC that the screen promised and that the
    refit gave (nan where there was none), their share of the weight, the part that declared
    parameters imitate, the squared residual per degree of freedom after, and what became of them.
    """

    effects: str
    promised: float
    gain: float = float("nan")
    weight: float = float("nan")
    masked: float = float("nan")
    s2: float = float("nan")
    remark: str = ""


@dataclass(frozen=True)
class SearchStep:
    """A step of the search: window length in s, squared residual per degree of freedom before, the
    probability that noise alone promises as much, what was tried, and the outcome in words."""

    window: float
    s2: float
    chance: float
    tried: tuple[CandidateScore, ...]
    words: str


@dataclass(frozen=True)
class ParameterChange:
    """A declared parameter without and with the effects, in SI, and its standard error with.

    `written` is the unit in the file where that is not of SI; `factor` brings its numbers to SI.
    `at_bound`: without the effects it sits on a bound, so that its value says nothing there.
    `declared` is its value in the diagram, where it has one.
    """

    name: str
    unit: str
    before: float
    after: float
    error: float
    written: str = ""
    factor: float = 1.0
    at_bound: bool = False
    declared: float | None = None

    @property
    def users_unit(self) -> str:
        """The unit in the file."""
        return self.written or self.unit

    @property
    def significant(self) -> bool:
        """Whether it moved by more than two standard errors."""
        return abs(self.after - self.before) > 2 * self.error


@dataclass(frozen=True)
class ChannelError:
    """Root mean square errors of a signal in a series in SI, before and after; `kind` is windowed
    (starts of short windows fitted) or free run (one run, its start fitted on the first part)."""

    series: str
    use: str
    signal: str
    unit: str
    kind: RunKind
    before: float
    after: float
    sigma: float


@dataclass(frozen=True, eq=False)
class Curve:
    """A measured signal of a series with the free runs before and after, in SI. `edges` are the
    times where windows begin, `windowed_before/after` the residuals in sigma within windows at each
    of `t`, nan where there is none; empty where the series was not cut. `spans` are stretches of
    the series that are used in different ways: (from, to, use)."""

    series: str
    use: str
    signal: str
    unit: str
    t: Vector
    measured: Vector
    before: Vector
    after: Vector
    edges: Vector
    windowed_before: Vector
    windowed_after: Vector
    spans: tuple[tuple[float, float, str], ...] = ()


@dataclass(frozen=True)
class Power:
    """The smallest coefficient of an effect that these data would show (5 standard errors), SI."""

    name: str
    place: str
    coefficient: str
    smallest: float


@dataclass(frozen=True)
class Dependence:
    """What a missing torque at a place depends on: variables, and the cross-validated share of the
    excess squared residual that a smooth function of them explains."""

    place: str
    variables: tuple[str, ...]
    share: float


@dataclass(frozen=True, eq=False)
class Missing:
    """The torque that is missing at a place, as a smooth function of one or two variables, in SI.

    `grid` has the grid points of each variable, `torque` the values, shape (n,) or (n, m), and
    `density` how many samples lie near each.
    """

    place: str
    variables: tuple[str, ...]
    share: float
    grid: tuple[Vector, ...]
    torque: Matrix
    density: Matrix


@dataclass(frozen=True, eq=False)
class Experiment:
    """The experiment that would separate an effect from a tie: settings, and by how many sigma it
    does; `map` has what was searched: rows of settings with their separation."""

    one: str
    other: str
    settings: Mapping[str, float]
    separation: float
    words: str
    map: tuple[Mapping[str, float], ...] = ()


@dataclass(frozen=True, eq=False)
class Means:
    """What is needed at a place in bins of one variable, in SI: where each bin is, the mean force
    that the data ask for there, and its standard error, each (K,)."""

    at: Vector
    mean: Vector
    error: Vector


@dataclass(frozen=True, eq=False)
class Force:
    """What is needed at a place over its coordinate and rate: torque histories (N,) that the
    data ask for beside the refitted declared terms, and those of the fitted effects; for the
    restoring picture.
    `names` are the signals that q and v are. `means` are over q and over v, estimated for all bins
    at once in the windows of the fit; () where that was not done."""

    place: str
    q: Vector
    v: Vector
    needed: Vector
    fitted: Vector
    names: tuple[str, str] = ("q", "v")
    means: tuple[Means, ...] = ()


@dataclass(frozen=True)
class Explained:
    """The share of the excess error that the named effects explain on unseen data, and its 95 %
    interval (jackknife over blocks of time). The excess is what the declared model leaves more than
    the reachable floor: 1 is all of it, 0 nothing, less than 0 is worse than without."""

    share: float
    low: float
    high: float


@dataclass(frozen=True)
class Remainder:
    """What is left of a signal with the effects, on data that no fit saw: its root mean square in
    `unit` and in units of the sensor's noise, and as a share of that of the declared model; `floor`
    is what a smooth map of position, rate and direction would leave (root mean square in `unit`,
    nan where none was fitted)."""

    signal: str
    unit: str
    rms: float
    in_sigma: float
    share: float
    floor: float = float("nan")


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Errors on held-out blocks of time at one horizon: the start of each block in s (B,), the
    series of each, and the root mean square error in units of the noise (B,) of the declared model,
    of the one with effects, and of the floor map (empty where there is none)."""

    horizon: float
    series: tuple[str, ...]
    begin: Vector
    declared: Vector
    best: Vector
    floor: Vector


@dataclass(frozen=True, eq=False, repr=False)
class Found(Result):
    """What a trace found.

    `verdict`: `null` (nothing is missing beyond the noise), `effect` (named in `effects`), or
    `unexplained` (something is missing, and no effect of the library explains it; `effects` are
    then partial approximations). `rmse_before` and `rmse_after` are root mean square errors in SI
    of free runs on data that played no part, over all measured signals; `sigma` is the noise of
    each. `s2_before` and `s2_after` are squared residuals per degree of freedom in units of the
    noise, both on the windows to which the model with the effects was fitted. `dropped` are
    declared parameters that went to zero, `values` the refitted and `declared` the fitted
    parameters of the diagram as it was.

    `explained` is the share of the excess that the effects explain, `remainder` what is left of
    each signal, `remainder_depends` on what that depends (the map of the remainder, the best
    first), `held_out` the errors on held-out blocks at each horizon, all None or empty where the
    residual is at the noise. `reason` says why what came near is not named, or is not enough; ''
    where the verdict is another. `options` is what the user asked for, with every threshold;
    `interrupted`: the user stopped the trace, and this is what was known by then.

    `diagram` is the edited diagram: with the effects and the fitted values, for `null` with the
    fitted values. The one as it was for `unexplained`, as partial approximations may do worse on
    other data, unless the trace was interrupted. `find_diagram` is
    that with some of the effects; a trace that was loaded has none. `units` are the SI units of
    signals and parameters by name, also of those that were added ('coulomb.level',
    'offset.theta'), `users_units` the unit of a signal in the user's files and its factor to SI,
    where they are not to be taken from `original`.
    """

    verdict: Verdict
    effects: tuple[FoundEffect, ...]
    dropped: tuple[str, ...]
    values: Mapping[str, float]
    declared: Mapping[str, float]
    rmse_before: float
    rmse_after: float
    sigma: Mapping[str, float]
    s2_before: float
    s2_after: float
    moved: tuple[ParameterChange, ...]
    errors: tuple[ChannelError, ...]
    steps: tuple[SearchStep, ...]
    power: tuple[Power, ...]
    dependences: tuple[Dependence, ...]
    missing: Missing | None
    experiments: tuple[Experiment, ...]
    confusable: tuple[tuple[str, ...], Matrix]
    curves: tuple[Curve, ...]
    find_forces: Callable[[], tuple[Force, ...]] = field(repr=False)
    words: tuple[str, ...]
    original: Diagram
    diagram: Diagram
    units: Mapping[str, str] = field(default_factory=dict)
    interrupted: bool = False
    explained: Explained | None = None
    remainder: tuple[Remainder, ...] = ()
    remainder_depends: tuple[Dependence, ...] = ()
    held_out: tuple[HeldOut, ...] = ()
    noisy_inputs: tuple[LikelyInput, ...] = ()
    reason: str = ""
    options: TraceOptions = field(default_factory=TraceOptions)
    users_units: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    find_diagram: Callable[[Collection[str]], Diagram] | None = field(default=None, repr=False)

    @cached_property
    def forces(self) -> tuple[Force, ...]:
        """What is needed at each place that got an effect; found when it is asked for."""
        return self.find_forces()

    @property
    def depends_on(self) -> tuple[str, ...]:
        """The variables on which a missing torque depends; () where nothing is unexplained."""
        return () if self.missing is None else self.missing.variables

    @property
    def patch(self) -> str:
        """The lines of the diagram that the trace would change, as a unified diff."""
        return difference(self.original, self.diagram)

    def apply(
        self, diagram: Diagram | None = None, effects: Collection[str] | None = None
    ) -> Diagram:
        """The diagram with the effects added and its parameters refitted; comments are kept.

        effects: those to add, by their texts (`coulomb @ torque`); None adds all that the verdict
        names, and so no partial approximation. The parameters were refitted with all of them: after
        a choice, fit again. Raises OptionError: no such effect, or a choice from a trace that was
        loaded; ValueError: another diagram.
        """
        if diagram is not None and diagram.text != self.original.text:
            raise ValueError("the diagram has changed since it was traced: trace it again")
        known = [str(effect) for effect in self.effects]
        wrong = [name for name in effects or () if name not in known]
        if wrong:
            raise OptionError([unknown("effect of the trace", name, known) for name in wrong])
        named = self.verdict == "effect" or self.interrupted
        if effects is None or (named and set(effects) == set(known)):
            return self.diagram
        if not effects:
            return self.original
        if self.find_diagram is None:
            what = "a trace that was loaded is applied as a whole"
            raise OptionError.one(what, hint="Apply all effects, or trace the diagram again.")
        return self.find_diagram(effects)


def data_of(found: Found) -> dict[str, Any]:
    """The result as plain data, without curves and diagrams."""
    data: dict[str, Any] = {name: plain(getattr(found, name)) for name in IN_JSON.split()}
    data |= {"parameters": plain(found.values), "where_what": plain(found.dependences)}
    for entry, effect in zip(data["effects"], found.effects, strict=True):
        entry |= {"ties": [str(tie) for tie in effect.ties], "tied": entry["ties"]}
    for experiment in data["experiments"]:
        del experiment["map"]
    return data
