"""What lets a block be tried as a missing effect: its coefficient, its wiring, its shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Symbol = Literal["q", "v", "a", "u", "other_q", "other_v"]
Scale = Literal["", "Q", "V", "U", "T", "dt", "stroke", "rates", "drives", "top"]
Where = Literal["sum", "drive"]
Tone = Literal["amplitude", "period", "phase"]

SYMBOLS: dict[Symbol, str] = {
    "q": "the coordinate of the place",
    "v": "the rate of the place",
    "a": "the acceleration of the place",
    "u": "the drive",
    "other_q": "the coordinate of another body",
    "other_v": "the rate of another body",
}
SCALES: dict[Scale, str] = {
    "": "",
    "Q": "the largest |q| of the place",
    "V": "the root mean square of v at the place",
    "U": "the largest |u| of the drive",
    "T": "the duration of the longest series",
    "dt": "the sample interval",
    "top": "the largest v of the place",
    "stroke": "the longest way of the place in one direction",
    "rates": "the rates of the place, by factors: 0 the slowest that is resolved, 1 the fastest",
    "drives": "the sizes of the drive, by factors: 0 the least that it has, 1 the largest",
}


@dataclass(frozen=True)
class Shape:
    """Where a trace first tries a parameter that sets the shape of an effect.

    at: multiples of `of`; with an empty `of` the values themselves, in SI. Of the `rates` and
    `drives` they are the place in that range, on a logarithmic scale. low: the least value that the
    parameter may take in a refit, in SI. least, most: between which multiples of `of` the record
    can tell a value. A `wave` is a length along the coordinate that comes back: it is at least a
    few samples long, and those lengths are tried first that a scan of all finds best. A `line` is a
    period in time: those of the lines in the spectrum of the residual are tried, too. A period with
    `modulates` is that of a wave that multiplies the input of this name: the residual has lines at
    the sums and differences of the frequencies of both, so that these are tried. A `fixed` shape
    has the first of its values, or that which the scan of a wave finds, and no fit changes it.
    """

    at: tuple[float, ...]
    of: Scale = ""
    low: float = 0.0
    least: float | None = None
    most: float | None = None
    wave: bool = False
    line: bool = False
    modulates: str = ""
    fixed: bool = False


@dataclass(frozen=True)
class Effect:
    """Says that a block may be tried as a missing effect, and how.

    `inputs` tells which local signal each port reads (see SYMBOLS). `coefficient` is the parameter
    in which the output is linear; the effect vanishes where it is zero. `sign` is 1 where physics
    allows only positive coefficients, 0 where it allows both. `shapes` are the parameters that a
    refit may change beside the coefficient, and where it begins.

    place: `sum`, the output is one more addend of a sum that feeds a rate; `drive`, it is added to
    the drive signal before all that reads it. at: where the output is not linear in the
    coefficient, the values of the coefficient at which it is first tried; None: at 1. tone:
    parameters that every series has of its own: amplitude, period (s) and phase (rad, at t = 0) of
    the sine that its measured drive is. Where a drive is no sine, the effect is not tried.
    each: shapes that every series has of its own, as the phase of a wave that no record follows.
    alias: names of other effects, or of a sensor's (`sensor_offset`), that imitate this one on many
    records; it counts both ways. lacking: the effect is tried only where a place has none of these
    signals, since there is a better one for those that do. both_signs: the effect is tried only
    where these signals take both signs: elsewhere another law is the same, as a viscous friction is
    where a body moves one way. near_rest: the effect is tried only where these signals come near
    zero: elsewhere it stands for any law that falls. lasting: states of the block that a run hardly
    forgets, as those of an oscillation that is little damped: they are free where the run of a
    window begins. That of a lag, which an input leads, is so only where a record begins.
    """

    coefficient: str
    inputs: Mapping[str, Symbol] = field(default_factory=dict, hash=False)
    sign: Literal[0, 1] = 0
    shapes: Mapping[str, Shape] = field(default_factory=dict, hash=False)
    place: Where = "sum"
    at: Shape | None = None
    tone: Mapping[str, Tone] = field(default_factory=dict, hash=False)
    each: tuple[str, ...] = ()
    alias: tuple[str, ...] = ()
    lacking: tuple[Symbol, ...] = ()
    both_signs: tuple[Symbol, ...] = ()
    near_rest: tuple[Symbol, ...] = ()
    lasting: tuple[str, ...] = ()
