"""Which fitted numbers sit on a bound: an answer of a fit that may not be what the data say."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from tracewire.residual import OWN, Unknown, is_of_sensor
from tracewire.trace.candidates.candidate import PHASE
from tracewire.trace.trials.placed_effect import PlacedEffect
from tracewire.trace.trials.trial import Trial

Kind = Literal["parameter", "sensor", "coefficient", "shape"]


@dataclass(frozen=True)
class AtBound:
    """A fitted number on one of its bounds, in SI; the user has it in `unit`, which is `factor` SI.

    name: of the unknown. kind: a declared parameter, a number of a sensor, or the coefficient or a
    shape of an effect, which is then `effect`. absent: the bound is 0, and what the number scales
    is not there.
    """

    name: str
    kind: Kind
    value: float
    low: float
    high: float
    upper: bool
    unit: str = ""
    effect: str = ""
    factor: float = 1.0

    @property
    def bound(self) -> float:
        """The bound that it sits on."""
        return self.high if self.upper else self.low

    @property
    def absent(self) -> bool:
        """Whether it is a term that the fit has switched off, and no bound that is too narrow."""
        return self.kind in ("parameter", "coefficient") and not self.upper and self.low == 0.0

    @property
    def exact(self) -> bool:
        """Whether it is the smoothing of a law at 0, where the law is exact."""
        return self.kind == "shape" and self.bound == 0.0 and self.name.endswith(".width")

    @property
    def words(self) -> str:
        """What sits where, and what to do."""
        known = self._known
        ends = f"`fit: [{self.low / self.factor:.4g}, {self.high / self.factor:.4g}]`"
        short = self.name.rpartition(".")[2]
        if self.kind == "shape":
            side = "above" if self.upper else "below"
            return (
                f"the {short} of {self.effect} sits on its bound {known}: the record tells nothing "
                f"{side} it; take a simpler law in its place, or a record that goes further"
            )
        if self.kind == "coefficient":
            return (
                f"the {short} of {self.effect} sits on its bound {known}: the fit does not use it"
            )
        if self.absent:
            return f"'{self.name}' sits on its bound {known}: the fit does not use it"
        return (
            f"{self._what} sits on its bound {known}: widen its {ends}, or an effect may be named "
            "that only makes up for it"
        )

    @property
    def words_without(self) -> str:
        """What sits where in the fit of the declared diagram, of which another one came."""
        return f"without the effects, {self._what} sits on its bound {self._known}"

    @property
    def _known(self) -> str:
        return f"{self.bound / self.factor:.4g} {self.unit}".strip()

    @property
    def _what(self) -> str:
        """The name of a declared parameter, or of a number of a sensor."""
        if self.kind != "sensor":
            return f"'{self.name}'"
        kind, _, signal = self.name.partition(".")
        return f"the {kind} of the sensor of '{signal}'"


def at_bounds(trial: Trial) -> list[AtBound]:
    """The fitted numbers of a trial that sit on a bound: declared parameters and sensors first.

    A number is on a bound where it is nearer to it than a thousandth of their range and of its own
    size; between positive bounds more than tenfold apart, of the range of their logarithms. A phase
    comes round: its bounds cut nothing off.
    """
    effects = {effect.unknown(name): effect for effect in trial.effects for name in effect.values}
    found = []
    for unknown in trial.windows.criterion.unknowns:
        value = trial.windows.values[unknown.name]
        near = trial.options.near_bound
        upper = _near(unknown, value, near, upper=True)
        if not upper and not _near(unknown, value, near, upper=False):
            continue
        effect = effects.get(unknown.name)
        if effect is not None and _is_phase(unknown.name):
            continue
        low, high = unknown.low, unknown.high
        unit, factor = _users_unit(trial, unknown.name, effect)
        kind = _kind(trial, unknown.name, effect)
        label = "" if effect is None else str(effect)
        found.append(AtBound(unknown.name, kind, value, low, high, upper, unit, label, factor))
    order = ("parameter", "sensor", "coefficient", "shape")
    return sorted(found, key=lambda one: order.index(one.kind))


def upper_shapes(trial: Trial) -> list[AtBound]:
    """The shapes of effects that sit on their upper bound: the record tells nothing beyond it."""
    return [one for one in at_bounds(trial) if one.kind == "shape" and one.upper]


def describe_bounds(declared: Trial, best: Trial) -> list[str]:
    """What sits on bounds in the final model, and what does so only without its effects."""
    final = [one for one in at_bounds(best) if not one.exact]
    known = {one.name for one in final}
    only = [one for one in at_bounds(declared) if one.name not in known]
    return [*(one.words_without for one in only), *(one.words for one in final)]


def _near(unknown: Unknown, value: float, part: float, upper: bool) -> bool:
    """Whether a value sits on the upper, or the lower, bound of its unknown."""
    low, high = unknown.low, unknown.high
    bound = high if upper else low
    if not math.isfinite(bound):
        return False
    if low > 0 and math.isfinite(high) and high > 10 * low and value > 0:
        return abs(math.log(value / bound)) <= part * math.log(high / low)
    size = max(abs(bound), unknown.scale)
    return abs(value - bound) <= part * min(size, high - low)


def _is_phase(name: str) -> bool:
    """Whether an unknown is the phase of an effect, perhaps in one series."""
    return name.partition(OWN)[0].rpartition(".")[2] == PHASE


def _kind(trial: Trial, name: str, effect: PlacedEffect | None) -> Kind:
    if effect is not None:
        return "coefficient" if name == effect.candidate.coefficient else "shape"
    return "sensor" if is_of_sensor(trial.model, name) else "parameter"


def _users_unit(trial: Trial, name: str, effect: PlacedEffect | None) -> tuple[str, float]:
    """The unit in which a user has a number, and its factor to SI; '' where it is not known."""
    model = trial.model
    if effect is not None:
        place, of = effect.candidate.place, effect.candidate.scales.get(name.rpartition(".")[2], "")
        if of in ("", "T", "dt"):
            return ("s" if of else ""), 1.0
        if of in ("U", "drives"):
            return model.users_unit("".join(place.drive[:1]) or place.definition)
        return model.users_unit(place.v if of in ("V", "rates", "top") else place.q)
    if is_of_sensor(model, name):
        kind, _, signal = name.partition(".")
        if kind == "offset":
            return model.users_unit(signal)
        return ("s" if kind == "delay" else ""), 1.0
    parameter = model.flat.parameters.get(name.partition(OWN)[0])
    return parameter.users_unit if parameter is not None else ("", 1.0)
