"""Other values of parameters and of sensors: in the text of a diagram, or in its objects."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from tracewire.diagram.body import Body
from tracewire.diagram.channels import check_term
from tracewire.diagram.diagram import Array, BlockUse, Diagram, Value
from tracewire.diagram.edit import with_bodies
from tracewire.diagram.edit_sensors import factor_of, own_value, set_sensors
from tracewire.diagram.names import find_parameter, is_count, split_index
from tracewire.diagram.override import localise
from tracewire.diagram.problems import Problems
from tracewire.diagram.rewrite import digits, reread, rounded
from tracewire.diagram.source_map import SourceMap
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.text_edits import entry_last, replace_node
from tracewire.diagram.uses import check_bounds, check_conditions
from tracewire.diagram.written import Written, count_uses, find_written
from tracewire.diagram.yaml_text import inline, mapping_text
from tracewire.errors import DiagramError, Location, OptionError
from tracewire.formula import Number
from tracewire.library import SENSOR_TERMS


def patch_values(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other values in its text: of parameters, and of what sensors do."""
    own, sensors = _apart(diagram, values)
    diagram = set_values(diagram, own) if own else diagram
    return set_sensors(diagram, sensors) if sensors else diagram


def apply_values(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other values in its objects: of parameters, and of what sensors do."""
    own, sensors = _apart(diagram, values)
    for path, value in own.items():  # what does not exist is refused first, as in the text
        at = _find(diagram, path)
        _in_its_unit(path, value, at.value, at.factor)
    for path, value in own.items():
        diagram = _with_value(diagram, path, value)
    for path, value in sensors.items():
        diagram = _with_sensor(diagram, path, value)
    return diagram


def _apart(
    diagram: Diagram, values: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, float]]:
    """Values of parameters, and values of sensors and of series."""
    measured = {name for series in diagram.measured.values() for name in series.channels}
    sensors = {}
    for path, value in values.items():
        kind, _, signal = path.partition(".")
        of_sensor = kind in SENSOR_TERMS and signal in measured
        if "@" in path or (of_sensor and find_parameter(diagram, path) is None):
            sensors[path] = value
    return {path: value for path, value in values.items() if path not in sensors}, sensors


# --- in the text ----------------------------------------------------------------------------------


def set_values(diagram: Diagram, values: Mapping[str, float]) -> Diagram:
    """The diagram with other values of parameters: path -> value in SI.

    A path is that of a run's parameter: `stiffness`, `bearing.slip` (a parameter of the subsystem
    that the block `bearing` is), `drag.c` (a setting written as a mapping). The text gets the value
    in the user's unit, with six digits. Where several blocks share the subsystem, `bearing.slip` is
    written into the block, not into the definition.
    """
    source_map = SourceMap(diagram)
    locations = [source_map.parameter(path) for path in values]
    diagram = localise(
        diagram, source_map, (location.into or location.node for location in locations)
    )
    source_map = SourceMap(diagram)
    changes = []
    for path, value in values.items():
        location = source_map.parameter(path)
        number = digits(*_in_its_unit(path, value, location.value, location.factor))
        node = location.node
        if (
            location.into is not None
        ):  # the definition is shared: a copy of its value goes to the use
            copy = _copy(node, number)
            changes.append(entry_last(diagram.text, location.into, location.name, copy))
        else:
            scalar = node.values["value"] if isinstance(node, Entries) else node
            changes.append(replace_node(scalar, number))
    return reread(diagram, changes)


def written_units(diagram: Diagram, paths: Iterable[str]) -> dict[str, str]:
    """The unit in which the text writes each parameter of a run, by its path.

    Left out are those without a unit there, and those whose text is in another file.
    """
    source_map = SourceMap(diagram)
    found: dict[str, str] = {}
    for path in paths:
        try:
            node = source_map.parameter(path).node
        except OptionError:
            continue
        unit = node.values.get("unit") if isinstance(node, Entries) else None
        if isinstance(unit, Scalar):
            found[path] = unit.text
    return found


def _in_its_unit(
    path: str, value: float, known: Value, factor: float
) -> tuple[float, float, float]:
    """A value in SI, and its bounds, in the unit with this factor. Raises OptionError."""
    if not math.isfinite(value):
        raise OptionError.one(f"parameter '{path}' cannot become {value}")
    low, high = known.fit or (-math.inf, math.inf)
    return value / factor, low / factor, high / factor


def _copy(node: Node, number: str) -> str:
    """The text of a value with another number, on one line."""
    if not isinstance(node, Entries):
        return number
    parts = {name: inline(part) for name, _, part in node}
    return mapping_text({**parts, "value": number})


# --- in the objects -------------------------------------------------------------------------------


def _find(diagram: Diagram, path: str) -> Written:
    """Where a value is written that can be changed in the objects. Raises OptionError."""

    def refuse(chosen: Diagram, use: BlockUse, name: str) -> int:
        what = f"'{path}' belongs to a body of '{chosen.name}', of which a parameter chooses one"
        raise OptionError.one(what, use.place, hint="Change it in the text.")

    if is_count(diagram, path):
        what = f"'{path}' says how many blocks there are, and another number makes others"
        raise OptionError.one(what, hint="Change it in the text.")
    return find_written(diagram, path, count_uses(diagram)[0], refuse)


def _with_value(diagram: Diagram, path: str, value: float) -> Diagram:
    """The diagram with another value of a parameter, as the reader would make it of the text."""
    at = _find(diagram, path)
    new = _numbered(path, value, at.value, at.factor)
    if at.use is None:
        parameters = {**at.body.parameters, at.name: new}
        return _with_body(diagram, at.body, replace(at.body, parameters=parameters))
    use, kind = at.use, at.use.subsystem
    name, index = split_index(at.name) if kind is None else (at.name, ())
    given = use.settings.get(name)
    if isinstance(given, Array):
        items = [new if (n,) == index else item for n, item in enumerate(given.items)]
        changed: Value | Array = replace(given, items=tuple(items))
    else:
        changed = new
    use = replace(use, settings={**use.settings, name: changed})
    if kind is None:
        _check(diagram, use, name)
    blocks = {**at.body.blocks, use.name: use}
    return _with_body(diagram, at.body, replace(at.body, blocks=blocks))


def _numbered(path: str, value: float, known: Value, factor: float) -> Value:
    """A value with another number. Raises DiagramError where that is out of its bounds."""
    number, low, high = _in_its_unit(path, value, known, factor)
    return replace(known, formula=_within(number, low, high, known.place), factor=factor)


def _within(number: float, low: float, high: float, place: Location) -> Number:
    """A number as a text has it. Raises DiagramError where it is out of its bounds."""
    number = rounded(number, low, high)
    if not low <= number <= high:
        what = f"the value {number:g} is outside of its bounds {low:g} to {high:g}"
        raise DiagramError.one(what, place, hint="Widen 'fit', or change the value.")
    return Number(number)


def _check(diagram: Diagram, use: BlockUse, name: str) -> None:
    """Raises DiagramError where a setting is none that the block may have."""
    problems = Problems()
    body, block, value = Body(problems), diagram.library.blocks[use.type], use.settings[name]
    if isinstance(value, Value):
        check_bounds(value, {p.name: p for p in block.parameters}[name], body)
    check_conditions(block, use.settings, body, use.place)
    problems.raise_found(str(diagram.file))


def _with_body(diagram: Diagram, old: Diagram, new: Diagram) -> Diagram:
    """The diagram with a body in the place of another one, wherever that is."""
    if (diagram.place, diagram.variant) == (old.place, old.variant):
        return new
    return with_bodies(diagram, lambda inside: _with_body(inside, old, new))


def _with_sensor(diagram: Diagram, path: str, value: float) -> Diagram:
    """The diagram with another number of a sensor, or of a parameter in one series."""
    parameter, of_series, name = path.partition("@")
    measured = dict(diagram.measured)
    if of_series:
        series = measured[name]
        known = own_value(diagram, parameter, name)
        given = {**series.parameters, parameter: _numbered(path, value, known, known.factor)}
        return replace(diagram, measured={**measured, name: replace(series, parameters=given)})
    kind, _, signal = path.partition(".")
    problems = Problems()
    for series in diagram.measured.values():
        channel = series.channels.get(signal)
        term: Value | None = getattr(channel, kind, None)
        if channel is None or term is None or term.fit is None:
            continue
        low, high = (end / term.factor for end in term.fit)  # as the text has them
        number = _within(value / factor_of(term, kind, series, signal), low, high, term.place)
        new = replace(term, formula=number)
        check_term(kind, new, term.place, problems)
        changed: dict[str, Any] = {kind: new}
        channels = {**series.channels, signal: replace(channel, **changed)}
        measured[series.name] = replace(series, channels=channels)
    problems.raise_found(str(diagram.file))
    return replace(diagram, measured=measured)
