"""What a sensor may do to its signal: one record for each term of what it shows."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class SensorTerm:
    """A term of what a sensor shows of a signal y(t): gain*z + offset + quad*z^2 + drift*(t - t0),
    where z = y(t - delay), and t0 is the first sample.

    words: how a text calls it. shown: what a sensor shows that has it alone, of z, t and t0.
    slope: the derivative of what is shown by the number of the term, of the arrays z and t - t0;
    None for the delay, which moves z. unit: that of the number, where {} stands for the signal's.
    neutral: the number that does nothing. low: the least that makes sense. sign: 1 where the effect
    that a trace tries has a positive coefficient.
    """

    words: str
    shown: str
    slope: Callable[[Any, Any], Any] | None
    unit: str = ""
    neutral: float = 0.0
    low: float = -math.inf
    sign: Literal[0, 1] = 0

    def unit_of(self, unit: str) -> str:
        """The unit of the number, where that of the signal is `unit`; '' where it is not known."""
        if "{}" in self.unit and not unit:
            return ""
        inner = self.unit.startswith("1/") and ("/" in unit or " " in unit)
        return self.unit.format(f"({unit})" if inner else unit)

    def factor(self, factor: float) -> float:
        """The factor to SI of the number, where that of the signal is `factor`."""
        if self.unit.startswith("1/"):
            return 1 / factor
        return factor if "{}" in self.unit else 1.0


SENSOR_TERMS = {
    "offset": SensorTerm("an offset", "z + offset", lambda z, since: 1.0, "{}"),
    "gain": SensorTerm("a gain that is not 1", "gain*z", lambda z, since: z, neutral=1.0, low=0.0),
    "delay": SensorTerm("a delay", "z", None, "s", low=0.0, sign=1),
    "quad": SensorTerm("a bent scale", "z + quad*z**2", lambda z, since: z**2, "1/{}"),
    "drift": SensorTerm("a drift", "z + drift*(t - t0)", lambda z, since: since, "{}/s"),
}
