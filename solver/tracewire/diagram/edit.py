"""Edits of a diagram: changes of its text that keep comments and layout, each read anew.

An edit returns a new diagram with the same file and another text, and raises DiagramError where
that text is no diagram any more. OptionError says that what should be edited does not exist.
"""

from __future__ import annotations

import contextlib
import difflib
import math
from collections.abc import Mapping

from tracewire.data import column_unit
from tracewire.diagram.diagram import BlockUse, Diagram, Series, Value
from tracewire.diagram.names import find_recorded
from tracewire.diagram.outline import Outline
from tracewire.diagram.read import read_text
from tracewire.diagram.splice import (
    Change,
    changed,
    end_of,
    entry_after,
    entry_last,
    item_last,
    replaced,
    without_entry,
    without_items,
)
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.errors import DiagramError, FormulaError, OptionError, unknown
from tracewire.formula import read_unit
from tracewire.formula.text import number_text


def add_addend(diagram: Diagram, sum_name: str, block_name: str, block_line: str) -> Diagram:
    """The diagram with a new block, on a line behind the sum's, and its output in the sum.

    sum_name: the sum by its definition: `torque` at the top, `bearing.total` for the sum `total` in
    the definition of the subsystem `bearing`.
    block_line: what stands behind the name, such as `{type: viscous, rate: omega, c: 0}`.
    """
    outline = Outline(diagram)
    inside, blocks, name = outline.block(sum_name)
    port, node = _addends(inside.blocks[name], inside, blocks)
    line = block_line.strip().removeprefix(f"{block_name}:").strip()
    text = diagram.text
    if isinstance(node, Items):
        wired = item_last(text, node, block_name)
    else:
        assert isinstance(node, Scalar)
        wired = replaced(node, f"[{text[node.start : node.end]}, {block_name}]")
    new = _reread(diagram, [entry_after(text, blocks, name, block_name, line), wired])
    _expect(new, sum_name, port, [*_signals(inside.blocks[name], port), block_name])
    return new


def remove_addend(diagram: Diagram, sum_name: str, addend: str) -> Diagram:
    """The diagram without a wire of a sum, and without its block where nothing else needs that.

    addend: the signal as the sum names it, without its sign, or its block.
    """
    outline = Outline(diagram)
    inside, blocks, name = outline.block(sum_name)
    port, node = _addends(inside.blocks[name], inside, blocks)
    before = _signals(inside.blocks[name], port)
    taken = [i for i, s in enumerate(before) if addend in (s, s.partition(".")[0])]
    if not taken:
        raise OptionError([unknown(f"addend of '{sum_name}'", addend, before)])
    entries = blocks.values[name]
    assert isinstance(entries, Entries)
    if isinstance(node, Items):
        wires = without_items(diagram.text, entries.keys[port], node, taken)
    else:
        wires = [replaced(node, "[]")]
    kept = [signal for i, signal in enumerate(before) if i not in taken]
    block = before[taken[0]].partition(".")[0]
    new = _reread(diagram, wires)
    if block in blocks.keys:
        with contextlib.suppress(DiagramError):  # it stays where something else reads it
            new = _reread(diagram, [*wires, without_entry(diagram.text, blocks, block)])
    _expect(new, sum_name, port, kept)
    return new


def set_values(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other values of parameters: path -> value in SI.

    A path is that of a run's parameter: `stiffness`, `bearing.slip` (a parameter of the subsystem
    that the block `bearing` is), `drag.c` (a setting written as a mapping). The text gets the value
    in the user's unit, with six digits. Where several blocks share the subsystem, `bearing.slip` is
    written into the block, not into the definition.
    """
    outline = Outline(diagram)
    changes = []
    for path, value in values.items():
        if not math.isfinite(value):
            raise OptionError.one(f"parameter '{path}' cannot become {value}")
        spot = outline.parameter(path)
        low, high = spot.value.fit or (-math.inf, math.inf)
        number = _digits(value / spot.factor, low / spot.factor, high / spot.factor)
        node = spot.node
        if spot.into is not None:  # the definition is shared: a copy of its value goes to the use
            copy = _copy(diagram.text, node, number)
            changes.append(entry_last(diagram.text, spot.into, spot.name, copy))
        else:
            scalar = node.values["value"] if isinstance(node, Entries) else node
            changes.append(replaced(scalar, number))
    return _reread(diagram, changes)


def add_offset(
    diagram: Diagram, signal: str, value: float, fit: tuple[float, float] | None = None
) -> Diagram:
    """The diagram with an offset of a measured signal, in every series that has the signal.

    value, fit: the offset and its bounds in SI; the text gets them in the unit of the column.
    """
    full = find_recorded(diagram, signal)
    having = {
        name: series
        for name, series in diagram.measured.items()
        if full in series.channels and series.channels[str(full)].column
    }
    if not having:
        measured = {name for series in diagram.measured.values() for name in series.channels}
        raise OptionError([unknown("measured signal", signal, measured)])
    root = Outline(diagram).root
    changes = [_offset(diagram, root, series, str(full), value, fit) for series in having.values()]
    return _reread(diagram, changes)


def set_sensors(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other offsets, gains and delays of sensors that are free in a fit.

    `values` has them by `offset.SIGNAL`, `gain.SIGNAL`, `delay.SIGNAL` in SI; every series in which
    one is free gets it, in the unit that its text has.
    """
    root = Outline(diagram).root
    changes = []
    for path, value in values.items():
        kind, _, signal = path.partition(".")
        for series in diagram.measured.values():
            channel = series.channels.get(signal)
            known: Value | None = getattr(channel, kind, None)
            if channel is None or known is None or known.fit is None:
                continue
            node = _channel(diagram, root, series, signal)
            assert isinstance(node, Entries)
            entry = node.values[kind]
            assert isinstance(entry, Entries)
            bare = kind == "offset" and not known.unit
            factor = known.factor * (_factor(series, signal) if bare else 1.0)
            low, high = (end / factor for end in known.fit)
            number = _digits(value / factor, low, high)
            if "value" in entry.values:
                changes.append(replaced(entry.values["value"], number))
            else:
                changes.append(entry_last(diagram.text, entry, "value", number))
    return _reread(diagram, changes)


def _channel(diagram: Diagram, root: Entries, series: Series, signal: str) -> Node:
    """The text of a measured signal in its series."""
    node: Node = root
    for key in ("measured", series.name, "signals"):
        assert isinstance(node, Entries)
        node = node.values[key]
    assert isinstance(node, Entries)
    return next(n for name, _, n in node if find_recorded(diagram, name) == signal)


def _copy(text: str, node: Node, number: str) -> str:
    """The text of a value with another number, on one line."""
    if not isinstance(node, Entries):
        return number
    parts = {name: text[part.start : end_of(part)] for name, _, part in node}
    parts["value"] = number
    return "{" + ", ".join(f"{name}: {part}" for name, part in parts.items()) + "}"


def _offset(
    diagram: Diagram,
    root: Entries,
    series: Series,
    signal: str,
    value: float,
    fit: tuple[float, float] | None,
) -> Change:
    given = _channel(diagram, root, series, signal)
    factor = _factor(series, signal)
    ends = fit or (-math.inf, math.inf)
    low, high = (end / factor for end in ends)
    text = f"{{value: {_digits(value / factor, low, high)}"
    if fit == (-math.inf, math.inf):
        text += ", fit: free"
    elif fit is not None:
        text += f", fit: [{_bound(low)}, {_bound(high)}]"
    text += "}"
    if isinstance(given, Scalar):
        column = diagram.text[given.start : given.end]
        return replaced(given, f"{{column: {column}, offset: {text}}}")
    assert isinstance(given, Entries)
    if "offset" in given.values:
        return replaced(given.values["offset"], text)
    return entry_last(diagram.text, given, "offset", text)


def _factor(series: Series, signal: str) -> float:
    """The factor to SI of a channel's offset: by its unit, else by that of the file's header."""
    channel = series.channels[signal]
    calibrated = {step.options.get("signal") for step in series.clean if step.step == "calibrate"}
    if channel.declared is not None or signal in calibrated:
        return channel.factor
    try:
        return read_unit(column_unit(series.file, channel.column, series.format.delimiter)).factor
    except FormulaError:  # brackets in the header that hold no unit
        return 1.0


def difference(old: Diagram, new: Diagram) -> str:
    """The lines in which the texts of two diagrams differ, as a unified diff; '' where none."""
    lines = difflib.unified_diff(
        old.text.splitlines(keepends=True),
        new.text.splitlines(keepends=True),
        str(old.file),
        str(new.file),
        n=1,
    )
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)


def _reread(diagram: Diagram, changes: list[Change]) -> Diagram:
    text = changed(diagram.text, changes)
    return read_text(text, diagram.file, library=diagram.library)


def _addends(use: BlockUse, inside: Diagram, blocks: Entries) -> tuple[str, Node]:
    """The input of a sum that takes several wires, and its node."""
    many: tuple[str, ...] = ()
    if use.type in inside.library:
        many = tuple(port.name for port in inside.library[use.type].inputs if port.many)
    line = blocks.values[use.name]
    if not many or use.subsystem is not None or not isinstance(line, Entries):
        what = f"block '{use.name}' is a {use.type}, and has no input for several signals"
        raise OptionError.one(what, use.place, hint="Name a sum.")
    return many[0], line.values[many[0]]


def _signals(use: BlockUse, port: str) -> list[str]:
    return [wire.signal for wire in use.inputs[port]]


def _expect(diagram: Diagram, sum_name: str, port: str, signals: list[str]) -> None:
    """Make sure that an edit did what it should, however the text was laid out."""
    inside, _, name = Outline(diagram).block(sum_name)
    use = inside.blocks[name]
    if _signals(use, port) != signals:
        what = "the list of addends is laid out in a way that cannot be edited by program"
        raise DiagramError.one(what, use.place, hint="Write it like [a, b].")


def _digits(value: float, low: float, high: float) -> str:
    """The value with six digits, or as many more as it takes to stay within its bounds."""
    for digits in (6, 9, 12, 15):
        rounded = float(f"{value:.{digits}g}")
        if low <= rounded <= high:
            return number_text(rounded)
    return number_text(value)


def _bound(value: float) -> str:
    return number_text(float(f"{value:.12g}")) if math.isfinite(value) else str(value)
