"""Changes of a diagram as values, which are applied to its objects or patched into its text.

A search applies changes and reads no text; what it has found is patched into the text once, so that
comments and layout stay. Both say the same:

    read(patch(text, changes)) == apply(read(text), changes)

but for the places of the parts. Values in a body that a parameter chooses, and how many blocks
there are, can be changed in the text only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from tracewire.diagram.body import Body
from tracewire.diagram.channels import unit_of_term
from tracewire.diagram.diagram import Array, BlockUse, Diagram, Points, Value, Wire
from tracewire.diagram.edit import add_addend, many_port, with_addend, with_bodies
from tracewire.diagram.edit_own import add_own, declared_parameter, free_starts, having_free_starts
from tracewire.diagram.edit_sensors import add_sensor, series_of
from tracewire.diagram.edit_values import apply_values, patch_values
from tracewire.diagram.names import find_signal, split_index
from tracewire.diagram.owned import apply_own, patch_own
from tracewire.diagram.problems import Problems
from tracewire.diagram.rewire import add_to_drive, readers_of, rewired, seen_name, sole_wire
from tracewire.diagram.rewrite import as_written
from tracewire.diagram.uses import check_bounds, check_conditions, in_unit_of, shape_of
from tracewire.diagram.values import Axis, points_of_file
from tracewire.diagram.yaml_text import mapping_text, quote
from tracewire.errors import DiagramError, Location, OptionError, unknown
from tracewire.formula import Number, Unit, number_text, to_text
from tracewire.library import SENSOR_TERMS, Block


@dataclass(frozen=True)
class PointsFile:
    """The points of a table: two columns of a file, whose path is as the diagram has it."""

    file: str
    x: str
    y: str


@dataclass(frozen=True)
class AddBlock:
    """A new block, whose output goes into a sum, or is added to a drive before all that reads it.

    inputs: the signal that each port reads. settings: values as a line of the text has them, in the
    units of the block. to: a sum by its definition (`torque`, `bearing.total` for the sum `total`
    in the definition of the subsystem `bearing`), or a drive, which is a named input or a source.
    element: of a sum of vectors the number of the element that it is added to, and how many there
    are: a gain behind the block makes a vector of it. own: the path of the block whose subsystem
    has the sum, where an included file defines that: it gets a definition of its own (`owned`).
    comment: what the text says behind the line of the block, where it has one of its own.
    """

    name: str
    type: str
    inputs: Mapping[str, str]
    settings: Mapping[str, Value | PointsFile]
    to: str
    drive: bool = False
    element: tuple[int, int] | None = None
    own: str = ""
    comment: str = ""


@dataclass(frozen=True)
class AddSensorTerm:
    """An offset, gain, delay, quad or drift of a measured signal, with its bounds, in SI."""

    signal: str
    kind: str
    value: float
    fit: tuple[float, float] | None = None


@dataclass(frozen=True)
class AddOwn:
    """Values of parameters that hold in single series, in SI: series -> path -> value; those in
    `fit` with their bounds. None may have a value there yet."""

    values: Mapping[str, Mapping[str, float]]
    fit: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class FreeStarts:
    """States that begin free in each measured series that has a free start: what a new block
    remembers where a record begins. None may be there yet."""

    states: tuple[str, ...]


@dataclass(frozen=True)
class SetValues:
    """Other values, in SI, by the names that a fit has for them: of parameters (`k`, `drag.c`), of
    sensors (`offset.theta`, where a series leaves it free), of one series (`phase@run_1`)."""

    values: Mapping[str, float]


Change = AddBlock | AddSensorTerm | AddOwn | FreeStarts | SetValues


def patch(diagram: Diagram, changes: Sequence[Change]) -> Diagram:
    """The diagram with changes made in its text, and read anew.

    Raises DiagramError: the text cannot be edited by program, or is no diagram any more;
    OptionError: what should be changed does not exist.
    """
    for change in changes:
        match change:
            case AddBlock(name, to=to, drive=True, comment=comment):
                diagram = add_to_drive(diagram, to, name, _line(change), comment)
            case AddBlock(name, to=to, element=element, own=own, comment=comment):
                if own:
                    diagram, to = patch_own(diagram, own, to)
                line = _line(change)
                diagram = add_addend(diagram, to, name, line, element=element, comment=comment)
            case AddSensorTerm(signal, kind, value, fit):
                diagram = add_sensor(diagram, signal, kind, value, fit)
            case AddOwn(values, fit):
                diagram = add_own(diagram, values, fit)
            case FreeStarts(states):
                diagram = free_starts(diagram, states)
            case SetValues(values):
                diagram = patch_values(diagram, values)
    return diagram


def apply(diagram: Diagram, changes: Sequence[Change]) -> Diagram:
    """The diagram with changes made in its objects; its text stays as it is.

    Raises DiagramError, as reading the text with these changes would; OptionError: what should be
    changed does not exist.
    """
    for change in changes:
        match change:
            case AddBlock(to=to, drive=drive, own=own):
                if own:
                    diagram, to = apply_own(diagram, own, to)
                diagram = (_to_drive if drive else _to_sum)(diagram, to, change)
            case AddSensorTerm():
                diagram = _with_sensor_term(diagram, change)
            case AddOwn():
                diagram = _with_own(diagram, change)
            case FreeStarts(states):
                diagram = _with_free_starts(diagram, states)
            case SetValues(values):
                diagram = apply_values(diagram, values)
    return diagram


# --- in the text ----------------------------------------------------------------------------------


def _line(change: AddBlock) -> str:
    parts = [f"type: {change.type}"]
    parts += [f"{port}: {quote(name)}" for port, name in change.inputs.items()]
    parts += [f"{name}: {_setting(value)}" for name, value in change.settings.items()]
    return f"{{{', '.join(parts)}}}"


def _setting(value: Value | PointsFile) -> str:
    if isinstance(value, PointsFile):
        return mapping_text({key: quote(text) for key, text in vars(value).items()})
    number = to_text(value.formula)
    if not value.named:
        return number
    ends = "" if value.fit is None else ", ".join(map(number_text, value.fit))
    return f"{{value: {number}, fit: [{ends}]}}" if ends else f"{{value: {number}}}"


# --- in the objects -------------------------------------------------------------------------------


def _to_sum(diagram: Diagram, path: str, change: AddBlock, negative: bool = False) -> Diagram:
    """The diagram with a new block, and its output in a sum."""
    where, _, name = path.rpartition(".")
    inside = _body(diagram, where, name)
    old = inside.blocks[name]
    if old.row:
        what = f"block '{name}' is one of the row '{old.row}', which have one line"
        hint = "Edit that line, or write the blocks out: tracewire show --text."
        raise OptionError.one(what, old.place, hint=hint)
    many_port(old, inside)  # refuses what is no sum
    new = _use(diagram, inside, change)
    gain = None if change.element is None else _alone(new.name, change.element)

    def edit(body: Diagram) -> Diagram:
        wired = with_addend(body, name, Wire(gain.name if gain else new.name, negative))
        blocks = _with_block(wired.blocks, name, new)
        return replace(body, blocks=_with_block(blocks, new.name, gain) if gain else blocks)

    return _changed(diagram, inside.place, old.place, name, edit) if where else edit(diagram)


def _alone(name: str, element: tuple[int, int]) -> BlockUse:
    """The gain that makes a vector of a signal, which is one element of it."""
    shares = tuple(Value(Number(float(n == element[0]))) for n in range(element[1]))
    return BlockUse(f"{name}_alone", "gain", {"of": (Wire(name),)}, {"k": Array(shares)})


def _to_drive(diagram: Diagram, drive: str, change: AddBlock) -> Diagram:
    """The diagram with a new block, whose output is added to a drive, as in `add_to_drive`."""
    readers, events = readers_of(diagram, drive)
    sole = sole_wire(diagram, drive, readers, events)
    if sole is not None:
        return _to_sum(diagram, readers[0].name, change, negative=sole.negative)
    name = seen_name(diagram, drive)
    seen = BlockUse(name, "sum", {"of": (Wire(drive),)}, {})
    anchor = drive if drive in diagram.blocks else readers[0].name if readers else ""
    diagram = rewired(diagram, drive, name)
    diagram = replace(diagram, blocks=_with_block(diagram.blocks, anchor, seen))
    return _to_sum(diagram, name, change)


def _use(top: Diagram, inside: Diagram, change: AddBlock) -> BlockUse:
    """The new block as the reader would make it of its line. Raises DiagramError."""
    problems, name, place = Problems(), change.name, Location(str(top.file), block=change.name)
    body = Body(problems)
    kind: Block | Diagram | None = inside.subsystems.get(change.type)
    kind = kind or top.subsystems.get(change.type) or inside.library.blocks.get(change.type)
    if kind is None:
        known = [*top.subsystems, *inside.library]
        raise DiagramError([unknown("block type", change.type, known, place)])
    if isinstance(kind, Diagram) and kind.place == inside.place:
        problems.add(f"subsystem '{change.type}' contains itself", place)
    if name in {*inside.inputs, *inside.parameters, *inside.blocks, *inside.subsystems}:
        problems.add(f"two definitions of '{name}'", place, (), "Rename one.")
    ports, parameters = shape_of(kind)
    for key in {**change.inputs, **change.settings}:
        if key not in ports and key not in parameters:
            problems.unknown(f"input or parameter of '{change.type}'", key, [*ports, *parameters],
                             place)  # fmt: skip
    inputs: dict[str, tuple[Wire, ...]] = {}
    for port in ports.values():
        signal, index = split_index(change.inputs.get(port.name, ""))
        if signal and signal != name and find_signal(inside, signal) is None:
            problems.unknown("signal", signal, inside.blocks, place)
        if signal:
            inputs[port.name] = (Wire(signal, index=index),)
        elif port.default is None:
            problems.add(f"input '{port.name}' is not connected", place)
    settings: dict[str, Value | Points] = {}
    for key, parameter in parameters.items():
        given: Value | Points | PointsFile | None = change.settings.get(key)
        if given is None and parameter.default is None:
            problems.add(f"parameter '{key}' is not given", place)
        elif isinstance(given, PointsFile):
            path, x, y = top.file.parent / given.file, Axis(given.x), Axis(given.y)
            given = points_of_file(path, x, y, body, place)
        if isinstance(given, Value) and isinstance(kind, Diagram):
            given = in_unit_of(given, kind.parameters[key])
        if given is not None:
            check_bounds(replace(given, place=place), parameter, body)
            settings[key] = given
    if isinstance(kind, Block):
        check_conditions(kind, settings, body, place)
    problems.raise_found(str(top.file))
    subsystem = kind if isinstance(kind, Diagram) else None
    return BlockUse(name, change.type, inputs, settings, subsystem=subsystem)


def _with_block(blocks: Mapping[str, BlockUse], after: str, new: BlockUse) -> dict[str, BlockUse]:
    """Blocks with a new one behind another one, or at the end."""
    names = list(blocks)
    names.insert(names.index(after) + 1 if after in blocks else len(names), new.name)
    return {name: new if name == new.name else blocks[name] for name in names}


def _body(diagram: Diagram, path: str, block: str) -> Diagram:
    """The definition of a subsystem by its path, in the variant that is used. The definition of a
    nested one may be named without those around it where that is clear. Raises OptionError."""
    definitions = _definitions(diagram)
    ends = [known for known in definitions if known.endswith(f".{path}")]
    found = [path] if path in definitions else ends
    if len(found) > 1:
        what = f"'{path}.{block}' may mean several blocks"
        raise OptionError.one(what, exists=[f"{other}.{block}" for other in found])
    if not found:
        raise OptionError([unknown("subsystem", path, (p for p in definitions if p))])
    usual = definitions[found[0]]
    body = next((b for b in _bodies(diagram) if b.place == usual.place), usual) if path else usual
    if block not in body.blocks:
        raise OptionError([unknown("block", block, body.blocks)])
    return body


def _definitions(diagram: Diagram, path: str = "") -> dict[str, Diagram]:
    """The definitions of subsystems by their path; '' is the diagram itself."""
    found = {path: diagram}
    for name, inside in diagram.subsystems.items():
        found |= _definitions(inside, f"{path}.{name}" if path else name)
    return found


def _bodies(diagram: Diagram) -> list[Diagram]:
    """The subsystems that blocks are, at all levels."""
    own = [use.subsystem for use in diagram.blocks.values() if use.subsystem is not None]
    return [body for inside in own for body in (inside, *_bodies(inside))]


def _changed(
    diagram: Diagram, place: Location, line: Location, name: str, edit: Callable[[Diagram], Diagram]
) -> Diagram:
    """The diagram with each body of a definition edited that has the block of this line: a block
    may stand in several variants."""
    if diagram.place == place and name in diagram.blocks and diagram.blocks[name].place == line:
        diagram = edit(diagram)

    return with_bodies(diagram, lambda inside: _changed(inside, place, line, name, edit))


def _with_sensor_term(diagram: Diagram, change: AddSensorTerm) -> Diagram:
    signal, having = series_of(diagram, change.signal, change.kind)
    measured = dict(diagram.measured)
    for series in having:
        channel = series.channels[signal]
        unit = Unit(channel.unit, channel.factor) if channel.declared else Unit("", 1.0)
        unit = unit_of_term(change.kind, unit)
        factor = SENSOR_TERMS[change.kind].factor(series.unit_of(series.channels[signal])[1])
        number, fit = as_written(change.value, factor, change.fit)
        fit = fit and (fit[0] * unit.factor, fit[1] * unit.factor)
        term: dict[str, Any] = {
            change.kind: Value(Number(number), unit.text, unit.factor, fit, named=True)
        }
        channels = {**series.channels, signal: replace(channel, **term)}
        measured[series.name] = replace(series, channels=channels)
    return replace(diagram, measured=measured)


def _with_own(diagram: Diagram, change: AddOwn) -> Diagram:
    measured = dict(diagram.measured)
    for name, own in change.values.items():
        if name not in measured:
            raise OptionError([unknown("measured series", name, measured)])
        parameters = dict(measured[name].parameters)
        for path, value in own.items():
            declared = declared_parameter(diagram, path)
            number, fit = as_written(value, declared.factor, change.fit.get(path))
            written = Value(Number(number), fit=fit, named=fit is not None)
            parameters[path] = in_unit_of(written, declared)
        measured[name] = replace(measured[name], parameters=parameters)
    return replace(diagram, measured=measured)


def _with_free_starts(diagram: Diagram, states: Sequence[str]) -> Diagram:
    measured = dict(diagram.measured)
    for series in having_free_starts(diagram):
        start = {**series.start, **dict.fromkeys(states)}
        measured[series.name] = replace(series, start=start)
    return replace(diagram, measured=measured)
