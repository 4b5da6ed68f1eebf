"""The C functions of a model, called at points that a test gives or draws."""

from __future__ import annotations

import ctypes
import math
import random
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from tracewire.compile import Model, compile
from tracewire.compile.pointers import SIGNATURE
from tracewire.diagram import Diagram, read_text

EAGER = ("prepare", "rhs", "outputs", "guards", "guard_rates", "timed", "starts", "resets")
EAGER = (*EAGER, "guard_weights")
LAZY = ("jacobian", "guard_gradients", "guard_curves", "guard_second", "guard_third")
LAZY = (*LAZY, "guard_fourth")
NEAR = 1e-9


@dataclass(frozen=True)
class Point:
    """The arguments of a model's functions but for the constants: p are the parameters."""

    t: float
    x: Sequence[float]
    m: Sequence[float]
    p: Sequence[float]
    k: Sequence[float]


def flat_tables(tables: Iterable[Sequence[Sequence[float]]]) -> list[float]:
    """All tables in one list: the offset of each, and there its length, x, y and slopes."""
    rows = [[float(len(x)), *x, *y, *slope] for x, y, slope in tables]
    offsets, at = [], len(rows)
    for row in rows:
        offsets.append(float(at))
        at += len(row)
    return offsets + [value for row in rows for value in row]


def both(diagram: Diagram | str, record: tuple[str, ...] = ()) -> tuple[Model, Model]:
    """The models of a diagram by both back ends."""
    read = read_text(diagram) if isinstance(diagram, str) else diagram
    return compile(read, record, backend="llvm"), compile(read, record, backend="python")


def called(
    address: int,
    size: int,
    t: float = 0.0,
    x: Sequence[float] = (),
    m: Sequence[float] = (),
    c: Sequence[float] = (),
    k: Sequence[float] = (),
) -> list[float]:
    """What the function at an address writes; an empty array is a null pointer."""
    arrays = [(ctypes.c_double * len(a))(*a) if len(a) else None for a in (x, m, c, k)]
    out = (ctypes.c_double * size)()
    SIGNATURE(address)(t, *arrays, out)
    return list(out)


def values(model: Model, name: str, at: Point) -> list[float]:
    """The values of one function of a model at a point."""
    sizes = model.routines.sizes
    c = called(model.routines.address("prepare"), sizes.constants, x=at.p)
    if name == "prepare":
        return c
    n, modes = sizes.states, sizes.modes
    lengths = {
        "rhs": n,
        "outputs": sizes.outputs,
        "guards": modes,
        "guard_rates": modes,
        "timed": 2 * sizes.timed,
        "starts": n,
        "resets": sizes.resets,
        "jacobian": n * (n + 1),
        "guard_gradients": modes * n,
        "guard_curves": modes * (n + 1),
        "guard_weights": sum(len(states or ()) for states in model.routines.straight),
    }
    size = lengths.get(name, modes)
    return called(model.routines.address(name), size, at.t, at.x, at.m, c, at.k) if size else []


def point_at(model: Model, t: float, x: Sequence[float]) -> Point | None:
    """A point with the modes that its guards ask for, and the diagram's parameters.

    None where the modes do not come to rest, or a guard is too near to a change to be sure of it.
    """
    p = [parameter.formula.value for parameter in model.flat.parameters.values()]  # numbers
    modes = [0.0] * len(model.modes)
    for _ in range(len(modes) + 2):
        at = Point(t, x, [*modes, *(0.0 for _ in modes)], p, [])
        guards = values(model, "guards", at)
        there = []
        for mode, guard in zip(model.modes, guards, strict=True):
            is_sign = mode.kind == "sign"
            if not abs(guard - (0 if is_sign else round(guard))) > NEAR:
                return None
            there.append(float(guard >= 0) if is_sign else float(math.floor(guard)))
        if there == modes:
            return at
        modes = there
    return None


def random_point(model: Model, seed: int, wide: float = 3.0) -> Point:
    """A point of a model with any modes, whether they fit the states or not."""
    draw = random.Random(seed)
    tables = []
    for _ in model.lowered.tables:
        x = sorted(draw.sample(range(-9, 9), draw.randint(1, 5)))
        y = [draw.uniform(-2, 2) for _ in x]
        slope = [(b - a) / (q - p) for a, b, p, q in zip(y, y[1:], x, x[1:], strict=False)]
        tables.append((x, y, slope))
    modes = [
        float(draw.randint(0, 1) if mode.kind == "sign" else draw.randint(-1, 6))
        for mode in model.modes
    ]
    return Point(
        t=draw.uniform(0, 3),
        x=[draw.uniform(-wide, wide) for _ in model.states],
        m=[*modes, *(float(draw.randint(0, 1)) for _ in modes)],
        p=[draw.uniform(0.1, 2) for _ in model.parameters],
        k=flat_tables(tables),
    )


def bits(numbers: Sequence[float]) -> list[bytes]:
    """Numbers by their bits; every NaN is the same, and the two zeros are not."""
    return [b"NaN" if a != a else struct.pack("<d", a) for a in numbers]


def moved(at: Point, index: int, change: float) -> Point:
    """A point with one state changed; index -1 changes the time."""
    if index < 0:
        return replace(at, t=at.t + change)
    return replace(at, x=[a + change * (i == index) for i, a in enumerate(at.x)])
