"""Random diagrams: as YAML for the product, and as plain Python for an independent integration.

Every state leaks or is held by a spring with a damper, and what drives it is bounded, so that no
run can leave a bounded region.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from oracles.switching import Switches

Vector = NDArray[np.float64]
END = 3.0
POINTS = ((-1.0, 0.5), (-0.2, -0.4), (0.6, 1.0), (1.5, 0.2))


@dataclass(frozen=True)
class Asker:
    """The switches, for one block of a diagram."""

    name: str
    t: float
    switches: Switches

    def __call__(self, number: int, guard: float, quiet: bool = False) -> bool:
        return self.switches.ask((self.name, number), guard, quiet)

    @property
    def middle(self) -> float:
        """A time within the piece between two known times."""
        return sum(self.switches.piece) / 2


Value = Callable[[list[float], tuple[float, ...], Asker], float]


@dataclass(frozen=True)
class Kind:
    """A block type: the names of its inputs and parameters, and what it puts out.

    `value(u, p, ask)` takes inputs and parameters by position; `ask` answers relations.
    """

    inputs: tuple[str, ...]
    parameters: tuple[str, ...]
    value: Value
    formula: str = ""


def _saturation(u: list[float], p: tuple[float, ...], ask: Asker) -> float:
    high, low = ask(0, u[0] - p[1]), ask(1, p[0] - u[0])
    return p[1] if high else p[0] if low else u[0]


def _dead_zone(u: list[float], p: tuple[float, ...], ask: Asker) -> float:
    high, low = ask(0, u[0] - p[1]), ask(1, p[0] - u[0])
    return u[0] - p[1] if high else u[0] - p[0] if low else 0.0


def _dry(u: list[float], p: tuple[float, ...], ask: Asker) -> float:
    level = p[1] if (ask.name, 0) in ask.switches.sticking else p[0]
    return -level if ask(0, u[0]) else level


def _table(u: list[float], p: tuple[float, ...], ask: Asker) -> float:
    value, (x, y) = POINTS[0][1], zip(*POINTS, strict=True)
    piece = sum(ask(n, u[0] - x[n], quiet=True) for n in range(len(x)))
    if 0 < piece < len(x):
        part = (u[0] - x[piece - 1]) / (x[piece] - x[piece - 1])
        value = y[piece - 1] + part * (y[piece] - y[piece - 1])
    elif piece:
        value = y[-1]
    return value


def _choice(u: list[float], p: tuple[float, ...], ask: Asker) -> float:
    first, second = ask(0, u[1] - p[0]), ask(1, u[2] - u[1])
    return u[0] if first and not second else u[2]


KINDS: dict[str, Kind] = {
    "gain": Kind(("of",), ("k",), lambda u, p, ask: p[0] * u[0]),
    "sin": Kind(("of",), (), lambda u, p, ask: math.sin(u[0])),
    "tanh": Kind(("of",), (), lambda u, p, ask: math.tanh(u[0])),
    "sign": Kind(("of",), (), lambda u, p, ask: 1.0 if ask(0, u[0]) else -1.0),
    "abs": Kind(("of",), (), lambda u, p, ask: u[0] if ask(0, u[0]) else -u[0]),
    "min": Kind(("of", "other"), (), lambda u, p, ask: u[1] if ask(0, u[0] - u[1]) else u[0]),
    "max": Kind(("of", "other"), (), lambda u, p, ask: u[0] if ask(0, u[0] - u[1]) else u[1]),
    "saturation": Kind(("of",), ("low", "high"), _saturation),
    "dead_zone": Kind(("of",), ("low", "high"), _dead_zone),
    "coulomb": Kind(("rate",), ("level",), lambda u, p, ask: -p[0] if ask(0, u[0]) else p[0]),
    "dry_friction": Kind(("rate",), ("slip", "stick"), _dry),
    "quad_drag": Kind(
        ("rate",), ("c",), lambda u, p, ask: -p[0] * u[0] * (u[0] if ask(0, u[0]) else -u[0])
    ),
    "asymmetric_viscous": Kind(
        ("rate",), ("c_l", "c_r"), lambda u, p, ask: -(p[0] if ask(0, u[0]) else p[1]) * u[0]
    ),
    "switch": Kind(
        ("control", "above", "below"),
        ("threshold",),
        lambda u, p, ask: u[1] if ask(0, u[0] - p[0]) else u[2],
    ),
    "table": Kind(("of",), (), _table),
    "sum": Kind(("of", "of"), (), lambda u, p, ask: u[0] + u[1]),
    "difference": Kind(("of", "of"), (), lambda u, p, ask: u[0] - u[1]),
    "product": Kind(("of", "of"), (), lambda u, p, ask: u[0] * u[1]),
    "steps": Kind(
        ("of",),
        (),
        lambda u, p, ask: sum(ask(n, 2 * math.sin(u[0]) - (n - 1)) for n in range(3)) - 2.0,
        "floor(2*sin({0}))",
    ),
    "choice": Kind(
        ("a", "b", "c"), ("level",), _choice, "{0} if {1} >= {3} and not {2} >= {1} else {2}"
    ),
    "relay": Kind(
        ("of",),
        ("on_at", "off_at"),
        lambda u, p, ask: float(ask.switches.relay(ask.name, u[0], p[0], p[1])),
    ),
    "square": Kind(
        (),
        ("amplitude", "frequency", "phase"),
        lambda u, p, ask: p[0] * (1 - 2 * (math.floor(2 * p[1] * ask.middle + p[2] / math.pi) % 2)),
    ),
    "step": Kind(
        (), ("height", "at", "offset"), lambda u, p, ask: p[2] + (p[0] if ask.middle >= p[1] else 0)
    ),
    "sine": Kind(
        (), ("amplitude", "omega", "phase"), lambda u, p, ask: p[0] * math.sin(p[1] * ask.t + p[2])
    ),
    "ramp": Kind(
        (),
        ("slope", "at"),
        lambda u, p, ask: p[0] * (ask.t - p[1]) if ask.middle >= p[1] else 0.0,
    ),
}
SOURCES = ("square", "step", "sine", "ramp")
LIMITERS = ("sin", "tanh", "saturation", "sign", "steps")
BLOCKS = tuple(name for name in KINDS if name not in SOURCES)


@dataclass(frozen=True)
class Wired:
    """One block: its type, what its inputs read, its parameters."""

    kind: str
    reads: tuple[str, ...]
    numbers: tuple[float, ...]

    def line(self) -> str:
        """The block in YAML."""
        kind = KINDS[self.kind]
        if kind.formula:
            formula = kind.formula.format(*self.reads, *self.numbers)
            return f'{{type: expression, formula: "{formula}"}}'
        if self.kind in ("sum", "difference", "product"):
            second = ("-" if self.kind == "difference" else "") + self.reads[1]
            name = "product" if self.kind == "product" else "sum"
            return f"{{type: {name}, of: [{self.reads[0]}, {second}]}}"
        inputs = dict(zip(kind.inputs, self.reads, strict=True))
        entries = (
            {"type": self.kind} | inputs | dict(zip(kind.parameters, self.numbers, strict=True))
        )
        if self.kind == "table":
            entries["points"] = [list(point) for point in POINTS]
        return "{" + ", ".join(f"{key}: {value}" for key, value in entries.items()) + "}"

    def known(self) -> list[float]:
        """The times at which a source jumps or bends."""
        p = self.numbers
        if self.kind == "square":
            first = math.ceil(p[2] / math.pi)
            count = math.ceil(2 * p[1] * END) + 1
            return [(first + n - p[2] / math.pi) / (2 * p[1]) for n in range(count)]
        return [p[1]] if self.kind in ("step", "ramp") else []


@dataclass(frozen=True)
class Wiring:
    """A diagram: blocks by name, each behind those it reads, and states as (rate, start)."""

    blocks: Mapping[str, Wired]
    states: Mapping[str, tuple[str, float]]

    def text(self) -> str:
        """The diagram as YAML."""
        lines = [f"span: [0, {END}]", "blocks:"]
        for name, (rate, start) in self.states.items():
            lines.append(f"  {name}: {{type: integrator, of: {rate}, start: {start}}}")
        lines += [f"  {name}: {block.line()}" for name, block in self.blocks.items()]
        return "\n".join(lines) + "\n"

    def rates(self, t: float, x: Vector, switches: Switches) -> Vector:
        """The field for the independent integration."""
        values = dict(zip(self.states, map(float, x), strict=True))
        for name, block in self.blocks.items():
            ask = Asker(name, t, switches)
            inputs = [values[read] for read in block.reads]
            values[name] = KINDS[block.kind].value(inputs, block.numbers, ask)
        return np.array([values[rate] for rate, _ in self.states.values()])

    def starts(self) -> list[float]:
        """The start of each state."""
        return [start for _, start in self.states.values()]

    def known(self) -> list[float]:
        """All known times."""
        return [time for block in self.blocks.values() for time in block.known()]


NUMBER = st.one_of(
    st.sampled_from([0.0, 0.5, 1.0, -0.5]), st.integers(-2000, 2000).map(lambda n: n / 1000)
)
POSITIVE = st.integers(1, 1500).map(lambda n: n / 1000)
SPECIAL: dict[str, st.SearchStrategy[tuple[float, ...]]] = {
    "saturation": st.tuples(POSITIVE, POSITIVE).map(lambda p: (-p[0], p[1])),
    "dead_zone": st.tuples(POSITIVE, POSITIVE).map(lambda p: (-p[0] / 2, p[1] / 2)),
    "dry_friction": st.tuples(POSITIVE, POSITIVE).map(lambda p: (min(p), max(p))),
    "relay": st.tuples(NUMBER, POSITIVE).map(lambda p: (p[0], round(p[0] - p[1] / 3, 4))),
    "coulomb": st.tuples(POSITIVE),
    "quad_drag": st.tuples(POSITIVE),
    "asymmetric_viscous": st.tuples(POSITIVE, POSITIVE),
    "square": st.tuples(NUMBER, POSITIVE, st.sampled_from([0.0, 1.0, 3.5])),
    "sine": st.tuples(NUMBER, POSITIVE.map(lambda w: 4 * w), NUMBER),
}


@st.composite
def wirings(draw: st.DrawFn) -> Wiring:
    """Bodies on springs with friction, leaking states, and up to six blocks between them."""
    blocks: dict[str, Wired] = {}
    states: dict[str, tuple[str, float]] = {}

    def add(kind: str, *reads: str, numbers: tuple[float, ...] | None = None) -> str:
        if numbers is None:
            free = st.tuples(*[NUMBER] * len(KINDS[kind].parameters))
            numbers = draw(SPECIAL.get(kind, free))
        name = f"b{len(blocks)}"
        blocks[name] = Wired(kind, reads, numbers)
        return name

    bodies, leaks = draw(st.integers(0, 2)), draw(st.integers(0, 2))
    leaks = leaks or int(bodies == 0)
    seen = [name for n in range(bodies) for name in (f"x{n}", f"v{n}")]
    seen += [f"z{n}" for n in range(leaks)]
    seen += [add(draw(st.sampled_from(SOURCES))) for _ in range(draw(st.integers(0, 2)))]
    for _ in range(draw(st.integers(1, 6))):
        kind = draw(st.sampled_from(BLOCKS))
        count = len(KINDS[kind].inputs)
        if count <= len(seen):  # a choice between equals is none, and no event
            seen.append(add(kind, *draw(st.permutations(seen))[:count]))

    def drive() -> str:
        return add(draw(st.sampled_from(LIMITERS)), draw(st.sampled_from(seen)))

    for n in range(bodies):
        force = add("sum", drive(), add("gain", f"x{n}", numbers=(-1.0 - draw(POSITIVE),)))
        force = add("sum", force, add("gain", f"v{n}", numbers=(-draw(POSITIVE),)))
        if draw(st.booleans()):
            rate = f"v{n}" if n == 0 or draw(st.booleans()) else add("difference", "v1", "v0")
            kind = draw(st.sampled_from(["coulomb", "dry_friction"]))
            force = add("sum", force, add(kind, rate))
        states[f"x{n}"] = f"v{n}", draw(NUMBER)
        states[f"v{n}"] = force, draw(NUMBER)
    for n in range(leaks):
        leak = add("gain", f"z{n}", numbers=(-draw(POSITIVE),))
        states[f"z{n}"] = add("sum", leak, drive()), draw(NUMBER)
    return Wiring(_needed(blocks, states), states)


def _needed(
    blocks: Mapping[str, Wired], states: Mapping[str, tuple[str, float]]
) -> dict[str, Wired]:
    """The blocks that some rate depends on, in the same order."""
    needed = {rate for rate, _ in states.values()}
    for name in reversed(blocks):
        if name in needed:
            needed.update(blocks[name].reads)
    return {name: block for name, block in blocks.items() if name in needed}
