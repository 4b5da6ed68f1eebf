"""Random piecewise linear hybrid systems: exactly, and as a diagram in random units.

A system is one or two bodies on springs with dampers and one to three states that leak, between
them waves, piecewise linear functions, relays, play, friction, switches, stops, resets and clocks.
All numbers are of the size 1; the diagram multiplies every state, signal and time by a unit.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field

import numpy as np
from fuzz.elements import (
    Clock,
    Element,
    Piecewise,
    Play,
    Reader,
    Relay,
    Reset,
    Stop,
    Switch,
    System,
    Wave,
)
from numpy.typing import NDArray

Vector = NDArray[np.float64]
WIDEST = 9  # powers of ten, of a unit


@dataclass
class Draft:
    """A system while it is drawn: the states, lines of the diagram, and the exact parts.

    Place 0 of z is the number 1. `lines` are (name, block), `forces` the terms of each rate.
    """

    rng: random.Random
    end: float
    second: float  # the unit of time
    names: list[str] = field(default_factory=lambda: [""])
    units: list[float] = field(default_factory=lambda: [1.0])
    rate_units: list[float] = field(default_factory=lambda: [1.0])
    starts: list[float] = field(default_factory=lambda: [1.0])
    bodies: list[tuple[int, int]] = field(default_factory=list)
    plain: list[int] = field(default_factory=list)  # states that may be written
    stops: dict[int, str] = field(default_factory=dict)  # the block of a body, by its place x
    lines: list[str] = field(default_factory=list)
    events: list[str] = field(default_factory=list)
    terms: dict[int, list[str]] = field(default_factory=dict)
    slopes: list[tuple[int, int, float]] = field(default_factory=list)  # row, column, value
    makes: list[tuple[str, dict[str, object]]] = field(default_factory=list)
    said: set[str] = field(default_factory=set)
    switches: list[tuple[str, int, float]] = field(default_factory=list)  # block, make, scale

    def number(self, low: float = 0.2, high: float = 2.0) -> float:
        """A number of either sign."""
        return self.rng.choice((-1, 1)) * round(self.rng.uniform(low, high), 3)

    def unit(self) -> float:
        """A unit: a power of ten, at times times another number."""
        return float(10.0 ** self.rng.uniform(-WIDEST, WIDEST))

    def add(self, name: str, unit: float, start: float) -> int:
        """The place of a new entry of z."""
        self.names.append(name)
        self.units.append(unit)
        self.starts.append(start)
        return len(self.names) - 1

    def act(self, place: int, term: str, value: float = 0.0, column: int = -1) -> None:
        """Let a term add to the rate of a state; or value times another entry of z."""
        if column >= 0:
            self.slopes.append((place, column, value))
            factor = value * self.units[place] / self.second / self.units[column]
            term = f"{factor!r}*{self.names[column]}" if column else f"{factor!r}"
        self.terms.setdefault(place, []).append(term)

    def signal(self, name: str, row: dict[int, float], unit: float) -> None:
        """A block that puts out row @ z in its unit."""
        parts = []
        for place, value in row.items():
            factor = value * unit / self.units[place]
            parts.append(f"{factor!r}*{self.names[place]}" if place else f"{factor!r}")
        self.lines.append(f'{name}: {{type: expression, formula: "{" + ".join(parts)}"}}')

    def reading(self, *, rates: bool = True) -> dict[int, float]:
        """Something to read: one or two entries of z with weights, and a level."""
        known = [n for n in range(1, len(self.names)) if self.names[n]]
        known = known if rates else [x for x, _ in self.bodies] or known
        row = {n: self.number(0.5, 1.5) for n in self.rng.sample(known, min(len(known), 2))}
        if self.rng.random() < 0.5:
            row = dict([next(iter(row.items()))])
        return row

    def target(self) -> int:
        """A state on whose rate something acts."""
        return self.rng.choice([v for _, v in self.bodies] + self.plain)


def draw(seed: int) -> Draft:
    """The draft with a seed."""
    rng = random.Random(seed)
    wide = rng.random() < 0.7
    draft = Draft(rng, round(rng.uniform(3, 8), 2), 10.0 ** rng.uniform(-6, 6) if wide else 1.0)
    for n in range(rng.randint(0, 2)):
        _body(draft, n, wide)
    for n in range(rng.randint(1, 2) if draft.bodies else rng.randint(1, 3)):
        unit = draft.unit() if wide else 1.0
        z = draft.add(f"z{n}", unit, draft.number(0.1, 1.5))
        draft.plain.append(z)
        draft.act(z, "", -abs(draft.number(0.1, 1.0)), z)
    for n in range(rng.randint(0, 2)):
        _sine(draft, n, wide)
    _couple(draft)
    kinds = [
        _piecewise,
        _relay,
        _play,
        _friction,
        _between,
        _switch,
        _reset,
        _clock,
        _wave,
        _counter,
        _reader,
    ]
    for n in range(rng.randint(1, 4)):
        rng.choice(kinds)(draft, n, draft.unit() if wide else 1.0)
    return draft


def _body(draft: Draft, n: int, wide: bool) -> None:
    rng, unit = draft.rng, draft.unit() if wide else 1.0
    stop = rng.random() < 0.3
    name = f"s{n}" if stop else f"x{n}"
    x = draft.add(f"{name}.x" if stop else name, unit, round(rng.uniform(-0.6, 0.6), 3))
    v = draft.add(f"{name}.v" if stop else f"v{n}", unit / draft.second, draft.number(0.1, 1.5))
    draft.bodies.append((x, v))
    draft.slopes.append((x, v, 1.0))
    draft.act(v, "", -abs(draft.number(0.5, 12.0)), x)
    draft.act(v, "", -abs(draft.number(0.02, 0.5)), v)
    if stop:
        draft.stops[x] = name
        high, low = round(rng.uniform(0.7, 1.2), 3), -round(rng.uniform(0.7, 1.2), 3)
        restitution = round(rng.uniform(0.0, 0.7), 2)
        draft.lines.append(
            f"{name}: {{type: hard_stop, force: a{v}, high: {high * unit!r}, low: {low * unit!r}, "
            f"restitution: {restitution}, start: {draft.starts[x] * unit!r}, "
            f"start_rate: {draft.starts[v] * draft.units[v]!r}}}"
        )
        draft.makes.append(
            ("stop", {"x": x, "v": v, "low": low, "high": high, "restitution": restitution})
        )
        draft.said.add("stop")


def _sine(draft: Draft, n: int, wide: bool) -> None:
    unit, omega = draft.unit() if wide else 1.0, abs(draft.number(0.5, 9.0))
    phase = round(draft.rng.uniform(0, 6), 3)
    draft.lines.append(
        f"w{n}: {{type: sine, amplitude: {unit!r}, omega: {omega / draft.second!r}, "
        f"phase: {phase}}}"
    )
    s = draft.add(f"w{n}", unit, math.sin(phase))
    c = draft.add("", 1.0, math.cos(phase))
    draft.slopes += [(s, c, omega), (c, s, -omega)]


def _couple(draft: Draft) -> None:
    """Some entries of z act on the rates of others."""
    for _ in range(draft.rng.randint(1, 3)):
        row = draft.reading()
        target = draft.target()
        for place, value in row.items():
            if place != target:
                draft.act(target, "", value * 0.7, place)
    if draft.rng.random() < 0.6:
        draft.act(draft.target(), "", draft.number(), 0)


def _onto(draft: Draft, name: str, unit: float, weight: float) -> int:
    """Let the output of a block, in its unit, act on a state."""
    target = draft.target()
    factor = weight * draft.units[target] / draft.second / unit
    draft.act(target, f"{factor!r}*{name}")
    return target


def _piecewise(draft: Draft, n: int, unit: float) -> None:
    rng, row = draft.rng, draft.reading()
    low, high = -round(rng.uniform(0.1, 0.8), 3), round(rng.uniform(0.1, 0.8), 3)
    draft.signal(f"i{n}", row, unit)
    kind = rng.choice(("saturation", "dead_zone", "abs"))
    if kind == "abs":
        draft.lines.append(f"e{n}: {{type: abs, of: i{n}}}")
        knots, slopes, offsets = (0.0,), (-1.0, 1.0), (0.0, 0.0)
    else:
        draft.lines.append(
            f"e{n}: {{type: {kind}, of: i{n}, low: {low * unit!r}, high: {high * unit!r}}}"
        )
        knots = (low, high)
        if kind == "saturation":
            slopes, offsets = (0.0, 1.0, 0.0), (low, 0.0, high)
        else:
            slopes, offsets = (1.0, 0.0, 1.0), (-low, 0.0, -high)
    weight = draft.number()
    target = _onto(draft, f"e{n}", unit, weight)
    draft.makes.append(
        (
            "piecewise",
            {"row": row, "knots": knots, "slopes": slopes, "offsets": offsets}
            | {"into": {target: weight}},
        )
    )
    draft.said.add(kind)


def _relay(draft: Draft, n: int, unit: float) -> None:
    row = draft.reading()
    draft.signal(f"i{n}", row, unit)
    on_at = round(draft.rng.uniform(-0.3, 0.6), 3)
    off_at = round(on_at - draft.rng.uniform(0.1, 0.5), 3)
    draft.lines.append(
        f"e{n}: {{type: relay, of: i{n}, on_at: {on_at * unit!r}, off_at: {off_at * unit!r}, "
        f"on_value: {unit!r}, off_value: {-unit!r}}}"
    )
    weight = draft.number()
    target = _onto(draft, f"e{n}", unit, weight)
    draft.makes.append(
        ("relay", {"row": row, "on_at": on_at, "off_at": off_at, "into": {target: weight}})
    )
    draft.said.add("relay")


def _play(draft: Draft, n: int, unit: float) -> None:
    if not draft.bodies:
        return
    x, v = draft.rng.choice(draft.bodies)
    half = round(draft.rng.uniform(0.05, 0.4), 3)
    draft.signal(f"i{n}", {x: 1.0}, unit)
    draft.signal(f"r{n}", {v: 1.0}, unit / draft.second)
    draft.lines.append(
        f"e{n}: {{type: play_operator, of: i{n}, rate: r{n}, width: {2 * half * unit!r}, "
        f"start: {draft.starts[x] * unit!r}}}"
    )
    at = draft.add("", unit, draft.starts[x])
    weight = draft.number()
    target = _onto(draft, f"e{n}", unit, weight)
    draft.makes.append(
        ("play", {"row": {x: 1.0}, "rate": {v: 1.0}, "half": half, "at": at}
         | {"into": {target: weight}})
    )  # fmt: skip
    draft.said.add("play")


def _friction(draft: Draft, n: int, unit: float) -> None:
    if not draft.bodies:
        return
    _x, v = draft.rng.choice(draft.bodies)
    slip = abs(draft.number(0.1, 1.0))
    stick = slip if draft.rng.random() < 0.5 else round(slip * draft.rng.uniform(1.0, 1.6), 4)
    force = unit
    draft.lines.append(
        f"e{n}: {{type: dry_friction, rate: {draft.names[v]}, slip: {slip * force!r}, "
        f"stick: {stick * force!r}}}"
    )
    draft.act(v, f"{draft.units[v] / draft.second / force!r}*e{n}")
    draft.switches.append((f"e{n}", len(draft.makes), force))
    draft.makes.append(
        (
            "switch",
            {"row": {v: 1.0}, "level": -slip, "stick": stick / slip, "into": {v: 1.0}}
            | {"friction": True},
        )
    )
    draft.said.add("friction")


def _between(draft: Draft, n: int, unit: float) -> None:
    """Dry friction between two bodies of different masses."""
    if len(draft.bodies) < 2:
        _friction(draft, n, unit)
        return
    (_, v), (_, w) = draft.bodies
    slip = abs(draft.number(0.1, 1.0))
    stick = slip if draft.rng.random() < 0.5 else round(slip * draft.rng.uniform(1.0, 1.6), 4)
    heavy = round(draft.rng.uniform(0.3, 3.0), 3)
    draft.signal(f"i{n}", {v: 1.0, w: -1.0}, unit)
    draft.lines.append(
        f"e{n}: {{type: dry_friction, rate: i{n}, slip: {slip!r}, stick: {stick!r}}}"
    )
    draft.act(v, f"{draft.units[v] / draft.second!r}*e{n}")
    draft.act(w, f"{-draft.units[w] / draft.second / heavy!r}*e{n}")
    parts = {"row": {v: 1.0, w: -1.0}, "level": -slip, "stick": stick / slip, "friction": True}
    draft.switches.append((f"e{n}", len(draft.makes), 1.0))
    draft.makes.append(("switch", parts | {"into": {v: 1.0, w: -1.0 / heavy}}))
    draft.said.add("friction between")


def _switch(draft: Draft, n: int, unit: float) -> None:
    row, target = draft.reading(), draft.target()
    draft.signal(f"i{n}", row, unit)
    draft.lines.append(f"e{n}: {{type: sign, of: i{n}}}")
    level = draft.number()
    draft.switches.append((f"e{n}", len(draft.makes), 1.0 / level))
    draft.act(target, f"{level * draft.units[target] / draft.second!r}*e{n}")
    draft.makes.append(
        ("switch", {"row": row, "level": level, "stick": 1.0, "into": {target: 1.0}})
    )
    draft.said.add("sign")


def _wave(draft: Draft, n: int, unit: float) -> None:
    half = round(draft.rng.uniform(0.3, 1.5), 3)
    draft.lines.append(
        f"e{n}: {{type: square, amplitude: {unit!r}, frequency: {0.5 / half / draft.second!r}}}"
    )
    weight = draft.number()
    target = _onto(draft, f"e{n}", unit, weight)
    draft.makes.append(("wave", {"level": 1.0, "half": half, "into": {target: weight}}))
    draft.said.add("wave")


def _written(draft: Draft) -> tuple[dict[int, dict[int, float]], str]:
    """What an event writes, and in YAML."""
    place = draft.rng.choice(draft.plain + [v for _, v in draft.bodies])
    other = draft.rng.choice([n for n in range(1, len(draft.names)) if draft.names[n]])
    row = {place: round(draft.rng.uniform(-0.6, 0.6), 3)}
    row[other] = row.get(other, 0.0) + draft.number(0.1, 0.5)
    parts = [
        f"{value * draft.units[place] / draft.units[n]!r}*{draft.names[n]}"
        for n, value in row.items()
    ]
    return {place: row}, f'{{{draft.names[place]}: "{" + ".join(parts)}"}}'


def _reset(draft: Draft, n: int, unit: float) -> None:
    row = draft.reading()
    row[0] = -round(draft.rng.uniform(0.05, 0.6), 3)
    draft.signal(f"i{n}", row, unit)
    rows, text = _written(draft)
    draft.events.append(f"- {{when: i{n}, crosses: up, set: {text}}}")
    draft.makes.append(("reset", {"row": row, "rows": rows}))
    draft.said.add("reset")


def _clock(draft: Draft, n: int, unit: float) -> None:
    if "clock" in draft.said:
        return
    period = round(draft.rng.uniform(0.4, 1.7), 3)
    rows, text = _written(draft)
    period_text = repr(period * draft.second)
    draft.events.append(f"- {{every: {period_text}, offset: {period_text}, set: {text}}}")
    draft.makes.append(("clock", {"period": period, "rows": rows}))
    draft.said.add("clock")


def _counter(draft: Draft, n: int, unit: float) -> None:
    """The number of rises of a signal, which drives nothing."""
    row = draft.reading()
    level = round(draft.rng.uniform(-0.5, 0.5), 3)
    draft.signal(f"i{n}", row, unit)
    draft.lines.append(f"c{n}: {{type: counter, of: i{n}, threshold: {level * unit!r}}}")
    at = draft.add(f"c{n}", 1.0, 0.0)
    draft.makes.append(("reset", {"row": row | {0: -level}, "rows": {at: {at: 1.0, 0: 1.0}}}))
    draft.said.add("counter")


def _reader(draft: Draft, n: int, unit: float) -> None:
    """An event or a counter that reads a friction, which may hold, and at times a state."""
    if not draft.switches:
        return
    block, make, scale = draft.rng.choice(draft.switches)
    row = draft.reading() if draft.rng.random() < 0.4 else {}
    row[0] = -draft.number(0.05, 0.8)
    weight = draft.number(0.5, 1.5)
    draft.signal(f"j{n}", row, unit)
    formula = f"{weight * unit / scale!r}*{block} + j{n}"
    draft.lines.append(f'i{n}: {{type: expression, formula: "{formula}"}}')
    if draft.rng.random() < 0.5:
        draft.lines.append(f"c{n}: {{type: counter, of: i{n}, threshold: 0}}")
        at = draft.add(f"c{n}", 1.0, 0.0)
        rows = {at: {at: 1.0, 0: 1.0}}
    else:
        rows, text = _written(draft)
        draft.events.append(f"- {{when: i{n}, crosses: up, set: {text}}}")
    parts = {"row": row, "weight": weight, "of": make, "rows": rows}
    draft.makes.append(("reader", parts))
    draft.said.add("reader")


def text_of(draft: Draft) -> str:
    """The diagram."""
    lines = [f"span: [0, {draft.end * draft.second!r}]", "blocks:"]
    inside = {v: name for x, v in draft.bodies for name in [draft.stops.get(x)] if name}
    rates = {x: v for x, v in draft.bodies if x not in draft.stops}
    for place, name in enumerate(draft.names):
        if place in rates:
            start = draft.starts[place] * draft.units[place]
            lines.append(f"  {name}: {{type: integrator, of: {draft.names[place + 1]}, "
                         f"start: {start!r}}}")  # fmt: skip
        elif place in draft.terms:
            if place not in inside:
                start = draft.starts[place] * draft.units[place]
                lines.append(f"  {name}: {{type: integrator, of: a{place}, start: {start!r}}}")
            formula = " + ".join(draft.terms[place])
            lines.append(f'  a{place}: {{type: expression, formula: "{formula}"}}')
    lines += [f"  {line}" for line in draft.lines]
    if draft.events:
        lines += ["events:", *(f"  {event}" for event in draft.events)]
    return "\n".join(lines) + "\n"


def system_of(draft: Draft) -> System:
    """The exact twin."""
    size = len(draft.names)
    one = np.eye(size)[0]

    def row(parts: dict[int, float]) -> Vector:
        found = np.zeros(size)
        for place, value in parts.items():
            found[place] += value
        return found

    matrix = np.zeros((size, size))
    for place, column, value in draft.slopes:
        matrix[place, column] += value
    elements: list[Element] = []
    made_of: dict[int, Element] = {}
    clocks: list[Clock] = []
    for number, (kind, given) in enumerate(draft.makes):
        parts = dict(given)
        into = row(parts.pop("into")) if "into" in parts else np.zeros(size)
        for name in ("row", "rate"):
            if name in parts:
                parts[name] = row(parts[name])  # type: ignore[arg-type]
        if "rows" in parts:
            parts["rows"] = {n: row(r) for n, r in parts["rows"].items()}  # type: ignore[attr-defined]
        if kind == "clock":
            clocks.append(Clock(**parts))  # type: ignore[arg-type]
            continue
        if kind == "relay":
            parts["values"] = (-1.0, 1.0)
        made = {"piecewise": Piecewise, "relay": Relay, "switch": Switch, "play": Play,
                "stop": Stop, "reset": Reset, "reader": Reader, "wave": Wave}[kind]  # fmt: skip
        if kind == "reader":
            parts["of"] = made_of[parts["of"]]  # type: ignore[index]
        elif kind != "reset":
            parts["one"] = one
        made_of[number] = made(into=into, **parts)
        elements.append(made_of[number])
    return System(matrix, np.array(draft.starts), elements, clocks)
