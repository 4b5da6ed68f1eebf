"""From a diagram, as it is written, to the graph of its picture."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from tracewire.diagram import (
    BlockUse,
    Diagram,
    Event,
    Points,
    Wire,
    find_signal,
    find_state,
    split_index,
)
from tracewire.draw.details import details_of, event_text, input_details, settings_text
from tracewire.draw.font import shorten
from tracewire.draw.graph import Connection, Graph, Look, Mark, Node, Plot, Port
from tracewire.draw.limits import LETTER
from tracewire.draw.needed import Needed
from tracewire.draw.numbers import inner_numbers, numbers_of, setting_numbers
from tracewire.draw.orient import orient
from tracewire.draw.sensors import sensor_nodes
from tracewire.draw.shapes import Drawn, port_width, shape_of, subsystem_look, tag_look
from tracewire.errors import Problem
from tracewire.formula import Call, Name, Number, names_of
from tracewire.library import Block

SIGNED = {"sum"}
"""Types whose inputs carry their sign inside, a plus as well; elsewhere only a minus is written."""
ORDERED = {"mux", "solve", "divide", "switch", "atan2", "compare", "select", "jk_flip_flop"}
"""Types of which the ports stay in the order of their declaration."""
UNNAMED = {"sum", "product", "mux", "max", "min", "dot", "and", "or", "xor"}
"""Types whose inputs need no names inside: they are alike, or their order says what they are."""
NUMBERED = {"select"}
"""Types that tell the wires of one input by their numbers, which stand inside."""


@dataclass(frozen=True)
class DrawOptions:
    """What a picture shows.

    depth: how many levels of subsystems are open. names, units: what stands on the wires.
    measured: whether signals with a sensor are marked, and the sensors that have terms are drawn.
    effects: blocks in colour, `sensors`: measured signals whose sensors are. needed: what data need
    at blocks, by their full names.
    """

    depth: int = 0
    names: bool = False
    units: bool = False
    measured: bool = False
    effects: Collection[str] = ()
    sensors: Collection[str] = ()
    needed: Mapping[str, Needed] = field(default_factory=dict)


def graph_of(
    diagram: Diagram, options: DrawOptions = DrawOptions(), problems: Sequence[Problem] = ()
) -> Graph:
    """The graph of a diagram. Blocks that a problem names, and wires from nowhere, are marked."""
    builder = _Builder(diagram, options, problems)
    own: dict[str, str] = {name: f"{name}>" for name in diagram.inputs}
    tags = tuple(builder.tag(diagram, name) for name in diagram.inputs)
    nodes, wires = builder.level(diagram, "", "", own, numbers_of(diagram, {}), options.depth)
    events = tuple(event_text(event) for event in diagram.events)
    told = tuple(map(_in_short, problems))
    nodes, wires = orient((*tags, *nodes), wires)
    return Graph(diagram.title or diagram.file.stem, nodes, wires, events, told)


@dataclass
class _Level:
    """One diagram while its blocks become nodes: where its signals come from."""

    diagram: Diagram
    path: str
    inputs: Mapping[str, str]
    strangers: dict[str, Node] = field(default_factory=dict)
    wires: list[Connection] = field(default_factory=list)


class _Builder:
    def __init__(self, diagram: Diagram, options: DrawOptions, problems: Sequence[Problem]) -> None:
        self.diagram = diagram
        self.options = options
        self.closed_on_sensors = set(_closed_on(diagram, options))
        self.wrong = {problem.place.block for problem in problems if problem.place.block}
        names = [name for series in diagram.measured.values() for name in series.channels]
        self.measured = {split_index(name)[0] for name in names}

    def tag(self, diagram: Diagram, name: str) -> Node:
        """The node of an input of the top diagram."""
        return Node(
            name, "", "input", tag_look(name), (Port(f"{name}>", "east"),),
            input_details(diagram.inputs[name]), mark=self.mark(name, name, ""),
            plot=self.plot(name),
        )  # fmt: skip

    def level(
        self,
        diagram: Diagram,
        path: str,
        definition: str,
        inputs: Mapping[str, str],
        numbers: Mapping[str, float],
        depth: int,
    ) -> tuple[tuple[Node, ...], tuple[Connection, ...]]:
        """The nodes and wires of a diagram, in the order of its blocks.

        path: the full name before its blocks. definition: the same by the names of definitions, as
        messages have it. inputs: the ports from which its inputs come.
        """
        level = _Level(diagram, path, inputs)
        reset = {
            (find_state(diagram, name) or name).partition(".")[0]
            for event in diagram.events
            for name in event.set
        }
        nodes = []
        for use in diagram.blocks.values():
            node = self.node(level, use, definition, numbers, depth)
            if use.name in reset:
                events = tuple(event_text(e) for e in _resets(diagram, use.name))
                node = replace(node, has_event=True, details=(*node.details, *events))
            nodes.append(node)
        if self.options.measured:
            for sensor, wire in sensor_nodes(self.diagram, diagram, path, self.options.sensors):
                nodes.append(sensor)
                level.wires += self.wire(level, wire, sensor.ports[0].id, sensor.ports[0].id)
        return (*nodes, *level.strangers.values()), tuple(level.wires)

    def node(
        self,
        level: _Level,
        use: BlockUse,
        definition: str,
        numbers: Mapping[str, float],
        depth: int,
    ) -> Node:
        """The node of a block; its input wires are noted."""
        full = level.path + use.name
        block = _block(level.diagram, use)
        ports = self.connect(level, use, full)
        if use.subsystem is not None:
            outputs = tuple(use.subsystem.outputs)
        else:
            outputs = tuple(output.name for output in block.outputs) if block else ("",)
        named = use.subsystem is not None or len(outputs) > 1
        # the signal of a block with one output has the name of the block alone
        ports += [
            Port(f"{full}>{o if named else ''}", "east", _short(sign + o) if named else "")
            for o, sign in zip(outputs, _signs(use, outputs, is_open=depth > 0), strict=True)
        ]
        given = setting_numbers(use, numbers, block)
        count = max(sum(port.side == side for port in ports) for side in ("west", "east"))
        labels = _label_widths(ports)
        where = ".".join(part for part in (definition, use.name) if part)
        node = Node(
            id=full,
            name=shorten(use.name, LETTER.most_name),
            type=use.type,
            look=Look("box", 0, 0),
            ports=tuple(ports),
            details=details_of(use, block),
            ordered=use.type in ORDERED,
            is_subsystem=use.subsystem is not None,
            labels=labels,
            mark=self.mark(full, where, use.type if use.subsystem else ""),
            measured=self.options.measured and self.is_measured(full),
            plot=self.plot(full),
        )
        if use.subsystem is None:
            look = shape_of(Drawn(use.type, settings_text(use), given, count, block, _points(use)))
            if look.outline in ("box", "pill"):
                look = replace(look, width=look.width + sum(labels))
            return replace(node, look=look)
        title = use.subsystem.title or use.type
        look = subsystem_look(title, count, labels, closed=depth <= 0)
        if depth <= 0:
            return replace(node, look=look)
        inside = inner_numbers(use, numbers)
        own = {name: f"{full}<{name}" for name in use.subsystem.inputs}
        nodes, wires = self.level(use.subsystem, f"{full}.", use.type, own, inside, depth - 1)
        level_inside = _Level(use.subsystem, f"{full}.", own)
        ends = tuple(
            wire
            for name, output in use.subsystem.outputs.items()
            for wire in self.wire(level_inside, output, f"{full}>{name}", f"{full}>{name}")
        )
        knots, ends = _knotted(ends, own.values())
        nodes, wires = orient((*nodes, *knots, *level_inside.strangers.values()), (*wires, *ends))
        return replace(node, look=replace(look, outline="frame"), nodes=nodes, wires=wires)

    def mark(self, full: str, where: str, type_name: str) -> Mark:
        if full in self.options.effects or full in self.closed_on_sensors:
            return "effect"
        inside = type_name and any(name.startswith(f"{type_name}.") for name in self.wrong)
        if where in self.wrong or full in self.wrong or inside:
            return "wrong"
        needed = self.options.needed.get(full)
        return "" if needed is None or needed.explained else "needed"

    def plot(self, full: str) -> Plot | None:
        """What data need at a block."""
        needed = self.options.needed.get(full)
        return None if needed is None else needed.plot()

    def is_measured(self, full: str) -> bool:
        return any(signal == full or signal.startswith(f"{full}.") for signal in self.measured)

    def connect(self, level: _Level, use: BlockUse, full: str) -> list[Port]:
        """The input ports of a block, a wire to each; signals of its formulas have a port, too."""
        ports = []
        single = len(use.inputs) == 1
        for port, wires in use.inputs.items():
            for number, wire in enumerate(wires):
                id = f"{full}<{port}" + (f".{number}" if len(wires) > 1 else "")
                numbered = use.type in NUMBERED and len(wires) > 1
                text = self.text_at(use, str(number) if numbered else port, wire, single)
                ports.append(Port(id, "west", text))
                level.wires += self.wire(level, wire, id, id)
        for number, name in enumerate(_signals_in_formulas(level.diagram, use)):
            id = f"{full}<formula.{number}"
            ports.append(Port(id, "west", _short(name)))
            level.wires += self.wire(level, Wire(name), id, id)
        return ports

    def text_at(self, use: BlockUse, port: str, wire: Wire, single: bool) -> str:
        """What stands inside of a block beside an input."""
        index = f"[{','.join(map(str, wire.index))}]" if wire.index else ""
        sign = "−" if wire.negative else "+" if use.type in SIGNED else ""
        bare = use.type in UNNAMED or (single and use.subsystem is None)
        return _short(f"{sign}{index}" if bare else f"{sign}{port}{index}")

    def wire(self, level: _Level, wire: Wire, target: str, id: str) -> Iterator[Connection]:
        """The wire to a port; nothing where it names no signal at all."""
        if not wire.signal:
            return
        diagram = level.diagram
        found = find_signal(diagram, wire.signal)
        name, _ = split_index(found or wire.signal)
        if name in level.inputs:
            # the wire that comes to an open subsystem has a label already
            label = "" if level.path else self.label(level, name)
            yield Connection(id, level.inputs[name], target, level.path + name, label)
            return
        head, _, _ = name.partition(".")
        use = diagram.blocks.get(head)
        if found is None or use is None:
            stranger = self.stranger(level, wire.signal)
            yield Connection(id, stranger.ports[0].id, target, name, mark="wrong")
            return
        full = level.path + name
        source = f"{level.path}{head}>{name.partition('.')[2]}"
        if use.subsystem is None and use.type not in diagram.library:
            source = f"{level.path}{head}>"
        yield Connection(id, source, target, full, self.label(level, name))

    def stranger(self, level: _Level, signal: str) -> Node:
        """A red node for a signal that does not exist."""
        name, _ = split_index(signal)
        if name not in level.strangers:
            id = f"?{level.path}{name}"
            details = (f"there is no signal '{name}'",)
            port = Port(f"{id}>", "east")
            look = tag_look(f"{name}?")
            level.strangers[name] = Node(id, "", "unknown", look, (port,), details, mark="wrong")
        return level.strangers[name]

    def label(self, level: _Level, name: str) -> str:
        """What stands on the wires of a signal: its name, its unit, both or nothing."""
        head = name.partition(".")[0]
        use = level.diagram.blocks.get(head)
        source = use or level.diagram.inputs[head]
        shown = source.shown
        parts = []
        if self.options.names:
            parts.append(shown.label or name)
        unit = shown.unit or source.unit
        if self.options.units and unit:
            parts.append(f"[{unit}]")
        return shorten(" ".join(parts), LETTER.most_name, LETTER.small)


def _closed_on(diagram: Diagram, options: DrawOptions) -> Iterator[str]:
    """The closed subsystems in which a sensor that is drawn in colour would be seen if opened."""
    for signal in options.sensors:
        parts = signal.split(".")
        if find_signal(diagram, signal) is None and len(parts) > options.depth + 1:
            yield ".".join(parts[: options.depth + 1])


def _in_short(problem: Problem) -> str:
    """A mistake without what exists instead, and with the file's name for its path."""
    place = replace(problem.place, file=Path(problem.place.file).name)
    return str(replace(problem, exists=(), place=place))


def _block(diagram: Diagram, use: BlockUse) -> Block | None:
    """The library block of a use; None for a subsystem, or a type that does not exist."""
    if use.type in diagram.library:
        return diagram.library[use.type]
    return None


def _points(use: BlockUse) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The points of a block that is a table."""
    tables = [value for value in use.settings.values() if isinstance(value, Points)]
    return (tables[0].x, tables[0].y) if tables else ((), ())


def _signs(use: BlockUse, outputs: Sequence[str], is_open: bool) -> list[str]:
    """A minus for each output of an open subsystem that turns the sign of what is inside."""
    if use.subsystem is None or not is_open:
        return [""] * len(outputs)
    return ["−" if use.subsystem.outputs[name].negative else "" for name in outputs]


def _knotted(
    wires: Sequence[Connection], inputs: Collection[str]
) -> tuple[tuple[Node, ...], tuple[Connection, ...]]:
    """Wires to the outputs of a frame; one from an input of it gets a knot that is inside.

    ELK leads a wire between two ports of one frame around the outside of it.
    """
    knots: list[Node] = []
    found: list[Connection] = []
    for wire in wires:
        if wire.source not in inputs:
            found.append(wire)
            continue
        id = f"{wire.id}="
        west, east = Port(f"{id}<", "west"), Port(f"{id}>", "east")
        knots.append(Node(id, "", "wire", Look("bar", 3.0, 3.0), (west, east), (wire.signal,)))
        found.append(replace(wire, id=west.id, target=west.id))
        found.append(replace(wire, source=east.id))
    return tuple(knots), tuple(found)


def _short(text: str) -> str:
    return shorten(text, LETTER.most_port, LETTER.small)


def _label_widths(ports: Sequence[Port]) -> tuple[float, float]:
    west = max((port_width(port.text) for port in ports if port.side == "west"), default=0.0)
    east = max((port_width(port.text) for port in ports if port.side == "east"), default=0.0)
    return west, east


def _signals_in_formulas(diagram: Diagram, use: BlockUse) -> list[str]:
    """The signals that the formulas of a block read, in their order.

    `t`, parameters and constants are no signals; a name that nothing has is none either: the
    message about it is enough.
    """
    found: dict[str, None] = {}
    for value in use.settings.values():
        if isinstance(value, Number | Name | Call):
            for name in names_of(value):
                vector, _ = split_index(name)
                signal = find_signal(diagram, vector)
                if name not in diagram.parameters and (signal or vector in diagram.blocks):
                    found.setdefault(signal or vector)
    return list(found)


def _resets(diagram: Diagram, block: str) -> list[Event]:
    """The events that set a state of a block."""
    return [
        event
        for event in diagram.events
        if any((find_state(diagram, n) or n).partition(".")[0] == block for n in event.set)
    ]
