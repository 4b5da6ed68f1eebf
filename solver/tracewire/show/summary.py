"""Diagrams, models and runs as tables, texts, and data for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tracewire.compile import Model
from tracewire.diagram import Diagram
from tracewire.show.limits import WORD
from tracewire.show.table import Table, shown
from tracewire.show.tidy import tidy_formula

if TYPE_CHECKING:
    from tracewire.residual import Measured
    from tracewire.solve import Event, Run


# --- diagrams and models ------------------------------------------------------------------------


def parameters_table(model: Model) -> Table:
    """Parameters: value and unit in SI, and the bounds of those that a fit may change.

    Where a parameter is written in another unit, what stands in the file is beside it.
    """
    rows = []
    written = any(p.factor != 1.0 for p in model.flat.parameters.values())
    for name, value in _values(model).items():
        parameter = model.flat.parameters[name]
        bounds = "" if parameter.fit is None else _bounds(parameter.fit)
        cells = [name, shown(value), parameter.unit, bounds]
        if written:
            number = f"{shown(value / parameter.factor)} {parameter.written}".rstrip()
            cells.append("" if parameter.factor == 1.0 else number)
        rows.append(tuple(cells))
    header = ("parameter", "value", "unit", "fit", *(["in the file"] if written else []))
    return Table("parameters", header, tuple(rows), frozenset({1, 4} if written else {1}))


def states_table(model: Model) -> Table:
    """States: start and rate, as formulas."""
    from tracewire.formula import to_text

    rows = tuple(
        (state.name, state.unit, to_text(state.start), to_text(state.rate))
        for state in model.flat.states
    )
    return Table("states", ("state", "unit", "start", "rate"), rows)


def recorded_table(model: Model) -> Table:
    """Recorded signals, their units and the types of their blocks."""
    blocks, units = model.flat.blocks, model.flat.units
    rows = tuple(
        (name, units.get(name, ""), blocks[name].type if name in blocks else "")
        for name in model.recorded
    )
    return Table("recorded signals", ("signal", "unit", "block"), rows)


def places_table(model: Model) -> Table:
    """Places where an effect may be tried: sums (rate v, coordinate q), drives, sensors."""
    from tracewire.trace.candidates.places import find_places

    rows = tuple(
        (place.name, place.kind, *((place.v, place.q) if place.kind == "sum" else ("", "")))
        for place in find_places(model)
    )
    return Table("places", ("place", "kind", "rate v", "coordinate q"), rows)


def overview(model: Model) -> dict[str, object]:
    """What `show` tells, as data."""
    from tracewire.trace.candidates.places import find_places

    flat, values = model.flat, _values(model)
    return {
        "title": flat.title,
        "file": str(model.diagram.file),
        "parameters": {
            name: {"value": values[name], "unit": p.unit, "fit": p.fit, "factor": p.factor}
            for name, p in flat.parameters.items()
        },
        "states": [
            dict(zip(("name", "unit", "start", "rate"), row, strict=True))
            for row in states_table(model).rows
        ],
        "recorded": {name: flat.units.get(name, "") for name in model.recorded},
        "places": find_places(model),
        "presets": list(flat.presets),
        "measured": list(model.diagram.measured),
    }


def runaway_remarks(run: Run) -> list[str]:
    """The recorded signals that grow without end: from the first tenth to the last by
    `WORD.runaway`, beside the largest signal of the unit, as a wave that arrives in a chain grows
    from nothing."""
    tenth = max(len(run.t) // 10, 1)
    found, largest = [], dict[str, float]()
    for name, values in run.signals.items():
        unit, first = run.units.get(name, ""), float(np.abs(values[:tenth]).max())
        largest[unit] = max(largest.get(unit, 0.0), first)
    for name, values in run.signals.items():
        size = np.abs(values)
        early, late = float(size[:tenth].max()), float(size[-tenth:].max())
        if early > 0 and late > WORD.runaway * largest[run.units.get(name, "")]:
            found.append(
                f"'{name}' grows from {early:.3g} to {late:.3g} and does not stop. "
                "Is a sign wrong? "
                "The force of a spring or a damper block pulls back by itself: add it with a plus."
            )
    return found


def contents(model: Model) -> dict[str, object]:
    """What is in a model, counted."""
    flat = model.flat
    return {
        "title": flat.title,
        "blocks": len({block.place.block for block in flat.blocks.values()}),
        "states": list(model.states),
        "parameters": len(flat.parameters),
        "free": [name for name, p in flat.parameters.items() if p.fit is not None],
        "presets": list(flat.presets),
        "recorded": list(model.recorded),
        "events": len(flat.events),
    }


def series_contents(series: Measured, model: Model) -> dict[str, object]:
    """What is in a measured series of a model."""
    from tracewire.residual import WINDOW, estimate_noise  # a check without series reads none

    noises = {**series.sigma, **series.input_sigma}
    sigma = {name: value for name, value in noises.items() if value is not None}
    enough = len(series.t) >= WINDOW.traced
    noise = estimate_noise([series]) if enough else {}
    shows = {name for name, values in series.values.items() if values.min() < values.max()}
    seen = {n: estimate for n, estimate in noise.items() if n in shows and n not in sigma}
    estimated = {name: estimate.level for name, estimate in seen.items()}
    how = {name: f", estimated ({estimate.method})" for name, estimate in seen.items()}
    told = [
        f"{name}: noise of σ = {s / factor:.4g} {unit}".rstrip() + how.get(name, "")
        for name, s in {**sigma, **estimated}.items()
        for unit, factor in [model.users_unit(name)]
    ]
    short = []
    if not enough:
        words = f"{len(series.t)} samples: a trace needs {WINDOW.traced} at least"
        short.append(words)
    return {
        "name": series.name,
        "series": series.series,
        "use": series.use,
        "file": series.file,
        "samples": len(series.t),
        "from": float(series.t[0]),
        "to": float(series.t[-1]),
        "signals": list(series.values),
        "inputs": list(series.inputs),
        "sigma": sigma,
        "estimated_sigma": estimated,
        "steps": list(series.steps),
        "noise": told,
        "remarks": [*series.remarks, *short],
    }


def contents_text(found: Mapping[str, object], measured: Sequence[Mapping[str, object]]) -> str:
    """`contents` and the measured series as lines."""
    lines = [str(found["title"])]
    lines.append(f"  blocks      {found['blocks']}")
    for key in ("states", "recorded", "presets"):
        lines.append(f"  {key:<12}{_listed(found[key])}")
    lines.append(f"  parameters  {found['parameters']}; free in a fit: {_listed(found['free'])}")
    if found["events"]:
        lines.append(f"  events      {found['events']}")
    remarks = found["remarks"]
    assert isinstance(remarks, Sequence)
    lines += [f"  !           {remark}" for remark in remarks]
    told: set[tuple[object, str]] = set()  # the windows of a series have most steps in common
    for series in measured:
        use = f" ({series['use']})"
        name = str(series["name"])
        lines.append(
            f"  measured    {name}{'' if name.endswith(use) else use}: {series['samples']} samples "
            f"from {series['from']:g} to {series['to']:g} s of {_listed(series['signals'])}"
        )
        for key, sign in (("steps", "-"), ("noise", "-"), ("remarks", "!")):
            texts = series[key]
            assert isinstance(texts, Sequence)
            fresh = [text for text in texts if (series["series"], text) not in told]
            told |= {(series["series"], text) for text in fresh}
            lines += [f"              {sign} {text}" for text in fresh]
    return "\n".join(lines)


def tree(diagram: Diagram) -> list[dict[str, object]]:
    """Blocks of a diagram, with what they read, and what is inside of subsystems."""
    found: list[dict[str, object]] = []
    for use in diagram.blocks.values():
        reads = {
            port: [("-" if wire.negative else "") + wire.signal for wire in wires]
            for port, wires in use.inputs.items()
        }
        entry: dict[str, object] = {"name": use.name, "type": use.type, "reads": reads}
        if use.subsystem is not None:
            entry["blocks"] = tree(use.subsystem)
        found.append(entry)
    return found


def tree_text(diagram: Diagram, indent: str = "") -> str:
    """Blocks of a diagram, one a line: name, type, and what its inputs read."""
    names = max((len(name) for name in diagram.blocks), default=0)
    types = max((len(use.type) for use in diagram.blocks.values()), default=0)
    lines = []
    for use in diagram.blocks.values():
        reads = ", ".join(
            f"{port}: " + " ".join(("-" if w.negative else "") + w.signal for w in wires)
            for port, wires in use.inputs.items()
        )
        lines.append(f"{indent}{use.name:<{names}}  {use.type:<{types}}  {reads}".rstrip())
        if use.subsystem is not None:
            lines.append(tree_text(use.subsystem, indent + "    "))
    return "\n".join(lines)


# --- runs ---------------------------------------------------------------------------------------


def with_label(run: Run, name: str) -> str:
    """A signal in a table: its name, which commands take, and its label in figures."""
    label = run.look(name).label
    return name if label == name else f"{name} ({label})"


def run_table(run: Run) -> Table:
    """Recorded signals of a run: start, end, least and greatest sample."""
    rows = tuple(
        (with_label(run, name), run.look(name).unit, *map(shown, extremes(run.as_shown(name))))
        for name in run.signals
    )
    header = ("signal", "unit", "start", "end", "min", "max")
    return Table(run.title, header, rows, frozenset({2, 3, 4, 5}))


def events_table(run: Run, events: Sequence[Event] | None = None) -> Table:
    """The log of events, all unless some are given, with the states that jumped."""
    rows = []
    for event in run.events if events is None else events:
        jumps = [
            f"{name}: {shown(event.before[name] / run.look(name).factor)}"
            f" -> {shown(after / run.look(name).factor)}"
            for name, after in event.after.items()
            if after != event.before[name]
        ]
        where = f"{tidy_formula(event.guard)} {event.direction}".strip()
        rows.append((f"{event.time:.9g}", event.kind, event.block, where, ", ".join(jumps)))
    return Table(
        "events", ("t [s]", "kind", "block", "guard", "jumps"), tuple(rows), frozenset({0})
    )


def run_text(run: Run) -> str:
    """What happened in a run and what it cost, in two lines."""
    counts = ", ".join(f"{count} {kind}" for kind, count in event_counts(run).items())
    cost = run.statistics
    return (
        f"events: {counts or 'none'}\n"
        f"{run.t[-1] - run.t[0]:g} s simulated in {cost.seconds:.3g} s: {cost.steps} steps, "
        f"{cost.rejected} rejected, {cost.evaluations} evaluations"
    )


def run_data(run: Run, samples: bool = False) -> dict[str, object]:
    """A run as data; the samples only where they are asked for."""
    signals = {}
    for name in run.signals:
        start, end, least, greatest = extremes(run[name])
        unit = run.units.get(name, "")
        signals[name] = {"unit": unit, "start": start, "end": end, "min": least, "max": greatest}
    data: dict[str, object] = {
        "title": run.title,
        "span": [float(run.t[0]), float(run.t[-1])],
        "parameters": run.parameters,
        "start": run.start,
        "final": run.final,
        "signals": signals,
        "event_counts": event_counts(run),
        "events": run.events,
        "statistics": run.statistics,
        "warnings": run.warnings,
    }
    return data | {"samples": {"t": run.t, **run.signals}} if samples else data


def event_counts(run: Run) -> dict[str, int]:
    """How many events of each kind there were."""
    return dict(Counter(event.kind for event in run.events))


def extremes(values: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """The first, the last, the least and the greatest of samples (N,)."""
    return float(values[0]), float(values[-1]), float(values.min()), float(values.max())


def _values(model: Model) -> dict[str, float]:
    from tracewire.solve import parameter_values

    return parameter_values(model, {})


def _bounds(bounds: tuple[float, float]) -> str:
    free = bounds == (float("-inf"), float("inf"))
    return "free" if free else f"{shown(bounds[0])} to {shown(bounds[1])}"


def _listed(names: object) -> str:
    assert isinstance(names, Sequence)
    few = ", ".join(map(str, names[:8]))
    return (few or "none") + (f" and {len(names) - 8} more" if len(names) > 8 else "")
