"""Random nonlinear systems with events, as text, for the product and for `reference`.

A body on a nonlinear spring with damping and one or two states that leak; between them waves,
products, sines, relays, saturations, friction, walls, resets and counters. The formulas are those
of the diagram; the reference evaluates them as Python.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from typing import Literal

Kind = Literal["relay", "saturation", "abs", "friction", "wall", "reset", "counter"]


@dataclass
class Part:
    """An element: what it reads (a formula), its numbers, and what it sets {state: formula}."""

    kind: Kind
    name: str
    reads: str
    low: float = 0.0
    high: float = 0.0
    sets: dict[str, str] = field(default_factory=dict)


@dataclass
class Smooth:
    """A system: the terms of the rate of each state, its starts, its elements in order."""

    end: float
    terms: dict[str, list[str]]
    starts: dict[str, float]
    parts: list[Part]

    @property
    def said(self) -> list[str]:
        """The kinds of its elements."""
        return sorted({part.kind for part in self.parts})

    def rate(self, state: str) -> str:
        """The formula of a rate."""
        return " + ".join(self.terms[state]) or "0"

    def text(self) -> str:
        """The diagram."""
        lines, events = [f"span: [0, {self.end!r}]", "blocks:"], []
        for state, start in self.starts.items():
            if state in self.terms:
                lines.append(f"  {state}: {{type: integrator, of: a_{state}, start: {start!r}}}")
                lines.append(f'  a_{state}: {{type: expression, formula: "{self.rate(state)}"}}')
        for part in self.parts:
            name, low, high = part.name, part.low, part.high
            if part.kind != "friction":
                lines.append(f'  i_{name}: {{type: expression, formula: "{part.reads}"}}')
            match part.kind:
                case "relay":
                    more = f"on_at: {high}, off_at: {low}, on_value: 1, off_value: -1"
                    lines.append(f"  {name}: {{type: relay, of: i_{name}, {more}}}")
                case "saturation":
                    more = f"low: {low}, high: {high}"
                    lines.append(f"  {name}: {{type: saturation, of: i_{name}, {more}}}")
                case "abs":
                    lines.append(f"  {name}: {{type: abs, of: i_{name}}}")
                case "friction":
                    lines.append(f"  {name}: {{type: coulomb, rate: v, level: {high}}}")
                case "counter":
                    lines.append(f"  {name}: {{type: counter, of: i_{name}, threshold: {high}}}")
                case _:
                    sets = ", ".join(f'{state}: "{to}"' for state, to in part.sets.items())
                    when = f"i_{name} - {high}" if high >= 0 else f"i_{name} + {-high}"
                    events.append(f'  - {{when: "{when}", crosses: up, set: {{{sets}}}}}')
        return "\n".join([*lines, *(["events:", *events] if events else [])]) + "\n"


def draw(seed: int) -> Smooth:
    """The system with a seed."""
    rng = random.Random(seed)

    def number(low: float = 0.2, high: float = 1.5) -> float:
        return rng.choice((-1, 1)) * round(rng.uniform(low, high), 3)

    def size(low: float, high: float) -> float:
        return round(rng.uniform(low, high), 3)

    states = ["x", "v", *(f"y{n}" for n in range(rng.randint(1, 2)))]
    spring = rng.choice(("{}*sin(x)", "{}*x - 0.5*x**3", "{}*tanh(x)", "{}*x"))
    terms = {state: [] for state in states}
    terms["x"] = ["v"]
    terms["v"] = [spring.format(-size(1, 9)), f"{-size(0.05, 0.5)}*v"]
    for state in states[2:]:
        terms[state] = [f"{-size(0.2, 1.0)}*{state}"]
    starts = {state: number(0.1, 1.2) for state in states}
    moved = states[1:]

    def term() -> str:
        one, other = rng.choice(states), rng.choice(states)
        return rng.choice(
            (
                f"{number()}*sin({size(0.5, 3)}*{one} + {size(0, 6)})",
                f"{number()}*{one}*{other}/(1 + {other}**2)",
                f"{number()}*tanh({one})",
                f"{number()}*exp(-{one}**2)",
                f"{number()}*sin({size(0.5, 7)}*t + {size(0, 6)})",
                f"{number()}*cos({one})*sin({size(0.5, 4)}*t)",
                f"{number(0.1, 0.5)}*sqrt(1 + {one}**2)",
                f"{number()}*{one}",
            )
        )

    for _ in range(rng.randint(1, 4)):
        terms[rng.choice(moved)].append(term())
    parts: list[Part] = []
    held = ""
    kinds: tuple[Kind, ...] = (
        "relay", "saturation", "abs", "friction", "wall", "reset", "counter"
    )  # fmt: skip
    for n in range(rng.randint(1, 4)):
        kind, name = rng.choice(kinds), f"e{n}"
        if kind in ("friction", "wall") and kind in [part.kind for part in parts]:
            continue
        reads = term() if rng.random() < 0.6 else rng.choice(states)
        if kind in ("reset", "counter") and held and rng.random() < 0.5:
            reads = f"{number()}*{held} + 0.3*{rng.choice(states)}"
        part = Part(kind, name, reads, low=-size(0.1, 0.6), high=size(0.1, 0.8))
        if kind in ("relay", "saturation", "abs"):
            factor = rng.choice(("", f"*cos({rng.choice(states)})"))
            terms[rng.choice(moved)].append(f"{number()}*{name}{factor}")
        elif kind == "friction":
            part.high, held = size(0.1, 1.2), name
            terms["v"].append(name)
        elif kind == "wall":
            part.reads, part.high = "x", size(max(0.7, starts["x"] + 0.1), 1.5)
            part.sets = {"v": f"{-size(0.3, 0.9)}*v"}
        elif kind == "reset":
            to = rng.choice(states[2:])
            part.high = number(0.1, 0.6)
            part.sets = {to: f"{number(0.1, 0.7)}*{to} + {number(0.1, 0.5)}*sin(v)"}
        elif kind == "counter":
            part.sets = {name: f"{name} + 1"}
            starts[name] = 0.0
        parts.append(part)
    return Smooth(size(3, 8), terms, starts, parts)
