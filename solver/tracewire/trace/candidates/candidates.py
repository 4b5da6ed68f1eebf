"""Candidates: an effect at a place, wired to the signals that are there."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence

from tracewire.compile import Model
from tracewire.diagram import BlockUse, Diagram, EffectType, effects_of
from tracewire.library import SENSOR_TERMS, Effect, Shape
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.drive_sines import Sine, own_values
from tracewire.trace.candidates.effects import bounds_of, scale_of
from tracewire.trace.candidates.inside import extensible_subsystems
from tracewire.trace.candidates.places import Place
from tracewire.trace.candidates.signal_scales import SignalScales
from tracewire.trace.thresholds import CandidateOptions

NO_NAME = re.compile(r"\W+", re.ASCII)
RANGES = {"rates": "slowest", "drives": "least"}
"""The scales that are ranges: by the name of their largest size that of their least one."""


def find_candidates(
    model: Model,
    places: Sequence[Place],
    signal_scales: SignalScales,
    options: CandidateOptions,
    taken: Sequence[Candidate] = (),
    sines: Mapping[str, Mapping[str, Sine]] | None = None,
) -> list[Candidate]:
    """Every effect at every place that has the signals it needs.

    Effects are blocks of the library and subsystems of the diagram that say so; one that reads
    another body is tried for each. `taken` are effects that the model has already got from the
    trace. An offset, gain ... of a sensor that the diagram gives, free or not, is no candidate. An
    effect whose shapes are sizes of a signal that is always zero is left out, and so is one that
    follows the tone of its drive where that has none in `sines` (by drive and series).
    """
    diagram = model.diagram
    found: list[Candidate] = []
    have = {(c.effect, c.place.name, c.of) for c in taken}
    names = set().union(diagram.blocks, diagram.parameters, diagram.inputs, diagram.subsystems)
    names |= {
        f"{name}.{inner}"
        for name, use in extensible_subsystems(diagram).items()
        for inner in _names_in(use)
    }
    kinds = effects_of(diagram)
    several = {kind: sum(p.kind == kind for p in places) > 1 for kind in ("sum", "drive")}
    for place in places:
        if place.kind == "sensor":
            found += _sensor_candidates(diagram, place, signal_scales)
            continue
        for kind in kinds:
            name = kind.name
            if kind.effect.place != place.kind:
                continue
            plain = name.rpartition(".")[2]  # a block of a package has the name of that in front
            at = NO_NAME.sub("_", place.name.rpartition(".")[2]).strip("_")  # force_0 of force[0]
            wanted = f"{plain}_{at}" if several[place.kind] else plain
            for of, signals in _wirings(kind.effect, place, places):
                block = f"{wanted}_{of}" if of else wanted
                block = free_name(f"{place.within}.{block}" if place.within else block, names)
                candidate = _candidate(
                    kind, place, block, of, signals, signal_scales, sines or {}, options
                )
                if candidate is not None:
                    names.add(block)
                    found.append(candidate)
    return [c for c in found if (c.effect, c.place.name, c.of) not in have]


def _names_in(use: BlockUse) -> set[str]:
    """The names that are taken inside a subsystem."""
    inside = use.subsystem
    if inside is None:
        return set()
    return set().union(inside.blocks, inside.parameters, inside.inputs, inside.outputs)


def free_name(wanted: str, taken: set[str]) -> str:
    """The name, with a number behind it where it is taken."""
    name, number = wanted, 2
    while name in taken:
        name, number = f"{wanted}_{number}", number + 1
    return name


def _wirings(
    effect: Effect, place: Place, places: Sequence[Place]
) -> Iterator[tuple[str, dict[str, str]]]:
    """The signals by port for each other body or drive that the effect may read, and its name."""
    symbols = set(effect.inputs.values())
    own = {"q": place.q, "v": place.v, "a": place.a}
    rooms: list[tuple[str, dict[str, str]]] = [("", own)]
    if symbols & {"other_q", "other_v"}:
        sums = [other for other in places if other.kind == "sum"]
        named = {(other.q, other.v): other.name.replace(".", "_") for other in sums}
        rooms = [
            (named.get((q, v), (v or q).replace(".", "_")), {**own, "other_q": q, "other_v": v})
            for q, v in place.others
        ]
    if "u" in symbols:
        many = len(place.drive) > 1
        rooms = [
            ("_".join(part for part in (of, drive if many else "") if part), {**room, "u": drive})
            for of, room in rooms
            for drive in place.drive
        ]
    for of, room in rooms:
        if any(room.get(symbol) for symbol in effect.lacking):
            continue
        signals = {port: room[symbol] for port, symbol in effect.inputs.items()}
        if all(signals.values()):
            yield of, signals


def _candidate(
    kind: EffectType,
    place: Place,
    block: str,
    of: str,
    signals: dict[str, str],
    signal_scales: SignalScales,
    sines: Mapping[str, Mapping[str, Sine]],
    options: CandidateOptions,
) -> Candidate | None:
    effect = kind.effect
    own = own_values(effect.tone, sines.get(place.definition)) if effect.tone else {}
    if effect.tone and not own:
        return None
    for port, symbol in effect.inputs.items():
        read_there = signal_scales.of(signals[port])
        least = options.both_signs * read_there.max
        if symbol in effect.both_signs and read_there.other_side < least:
            return None
        nearest = 0.0 if read_there.other_side > 0 else read_there.least
        if symbol in effect.near_rest and nearest > options.near_rest * read_there.max:
            return None
    sizes = _sizes(effect, signals, place, signal_scales, options)
    shapes: dict[str, tuple[float, ...]] = {}
    limits: dict[str, tuple[float, float]] = {}
    resolved: dict[str, float] = {}
    for parameter, shape in effect.shapes.items():
        grid = _grid(shape, sizes)
        if grid is None:
            return None
        low, high = _limits(shape, grid, bounds_of(kind, parameter), sizes, options)
        if not low < high:
            return None
        if shape.of == "V" and 0.0 in grid:
            resolved[parameter] = sizes["slowest"]
            grid = tuple(value for value in grid if not 0.0 < value <= sizes["slowest"])
        if shape.of in ("stroke", *RANGES):
            grid = tuple(dict.fromkeys(min(max(value, low), high) for value in grid))
        shapes[parameter] = grid
        limits[parameter] = low, high
    at_sizes: tuple[float, ...] = (1.0,)
    if effect.at is not None:
        values = _grid(effect.at, sizes)
        if values is None:
            return None
        longest = options.longest_lag * signal_scales.duration
        at_sizes = (values[0], *(value for value in values[1:] if value < longest))
    at = at_sizes[0]
    low, high = bounds_of(kind, effect.coefficient)
    limits[effect.coefficient] = max(low, 0.0) if effect.sign else low, high
    base = signal_scales.of(place.definition if place.kind == "drive" else place.name).rms
    inputs = {port: signal_scales.of(signal) for port, signal in signals.items()}
    scale = scale_of(kind, inputs, shapes, base, at, signal_scales.duration, options.parts)
    return Candidate(
        kind.name,
        place,
        block,
        signals,
        f"{block}.{effect.coefficient}",
        effect.sign,
        shapes,
        scale,
        at,
        of=of,
        limits=limits,
        own=own,
        resolved=resolved,
        scales={name: shape.of for name, shape in effect.shapes.items()},
        waves=tuple(name for name, shape in effect.shapes.items() if shape.wave),
        lines=tuple(name for name, shape in effect.shapes.items() if shape.line),
        modulated={n: signals[s.modulates] for n, s in effect.shapes.items() if s.modulates},
        fixed=tuple(name for name, shape in effect.shapes.items() if shape.fixed),
        alias=effect.alias,
        at_sizes=at_sizes,
        each=effect.each,
        lasting=tuple(f"{block}.{state}" for state in effect.lasting),
    )


def _sizes(
    effect: Effect,
    signals: Mapping[str, str],
    place: Place,
    signal_scales: SignalScales,
    options: CandidateOptions,
) -> dict[str, float]:
    """What the shapes of an effect are multiples of."""
    read = {symbol: signals[port] for port, symbol in effect.inputs.items()}
    q = signal_scales.of(read.get("q") or read.get("other_q") or place.q)
    v = signal_scales.of(read.get("v") or read.get("other_v") or place.v)
    u = signal_scales.of(read.get("u") or "".join(place.drive[:1]))
    return {
        "": 1.0,
        "Q": q.max,
        "V": v.rms,
        "stroke": q.stroke or 2 * q.max,
        "step": q.step,
        "rates": v.max,
        "top": v.max,
        "slowest": max(v.slowest, options.slowest_rate * v.max),
        "U": u.max,
        "drives": u.max,
        "least": u.slowest,
        "T": signal_scales.duration,
        "dt": signal_scales.interval,
    }


def _grid(shape: Shape, sizes: Mapping[str, float]) -> tuple[float, ...] | None:
    """The values of a shape that are tried first; None where they are sizes of nothing."""
    size = sizes[shape.of]
    if not size > 0:
        return None
    if shape.of in RANGES:
        least = sizes[RANGES[shape.of]]
        return tuple(least * (size / least) ** at for at in shape.at) if least > 0 else None
    return tuple(at * size for at in shape.at)


def _limits(
    shape: Shape,
    grid: Sequence[float],
    bounds: tuple[float, float],
    sizes: Mapping[str, float],
    options: CandidateOptions,
) -> tuple[float, float]:
    """Finite bounds of a shape: what the record can tell where that is known, else wide ones."""
    if shape.of in RANGES:
        return max(sizes[RANGES[shape.of]], bounds[0]), min(sizes[shape.of], bounds[1])
    wide, size = options.wide * max(map(abs, grid)), sizes[shape.of]
    low, high = max(shape.low, bounds[0], -wide), min(bounds[1], wide)
    if shape.most is not None:
        high = min(bounds[1], shape.most * size)
    if shape.least is not None:
        low = max(low, shape.least * size)
    elif low >= 0.0 and min(grid) > 0:
        low = max(low, options.narrow * min(grid))
    if shape.wave:
        least = options.samples_in_a_wave * sizes["step"]
        return max(shape.low, least, high / options.most_waves), high
    if shape.line:
        low = max(shape.low, bounds[0], options.samples_in_a_wave * sizes["dt"])
    return low, max(high, *grid)


def _sensor_candidates(
    diagram: Diagram, place: Place, signal_scales: SignalScales
) -> Iterator[Candidate]:
    signal = place.definition
    scale = signal_scales.of(signal)
    scales = {
        "offset": scale.rms,
        "gain": 1.0,
        "delay": signal_scales.interval,
        "quad": 1 / scale.max if scale.max > 0 else 1.0,
        "drift": scale.rms / signal_scales.duration,
    }
    channels = [s.channels[signal] for s in diagram.measured.values() if signal in s.channels]
    for kind, term in SENSOR_TERMS.items():
        values = [getattr(channel, kind) for channel in channels]
        if any(value is not None for value in values):
            continue
        yield Candidate(
            f"sensor_{kind}",
            place,
            "",
            {"y": signal},
            f"{kind}.{signal}",
            term.sign,
            scale=max(scales[kind], 1e-300),
            neutral=term.neutral,
            limits={kind: (term.low, math.inf)},
        )
