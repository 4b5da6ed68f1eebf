"""From a diagram to flat equations: subsystems dissolved, wires replaced by what they carry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tracewire.compile.asked import asked_of_clock, asked_of_top, unit_text
from tracewire.compile.continuous import ContinuousPort, jump_problems
from tracewire.compile.curves import curve_tables
from tracewire.compile.declared_events import (
    block_events,
    block_memory,
    diagram_events,
    memory_name,
    near_ticks,
)
from tracewire.compile.dimensions import complete_units
from tracewire.compile.expand import expand_vectors
from tracewire.compile.flat import (
    Flat,
    FlatAsked,
    FlatBlock,
    FlatEvent,
    FlatMemory,
    FlatParameter,
    FlatState,
)
from tracewire.compile.loops import order_signals
from tracewire.compile.many import write_wires
from tracewire.compile.name_clashes import find_name_clashes
from tracewire.compile.realise import without_zero_products
from tracewire.compile.sampling import SampledPort, sample_ports
from tracewire.compile.vectors import has_vectors
from tracewire.diagram import (
    Array,
    BlockUse,
    Condition,
    Diagram,
    Points,
    Shown,
    Value,
    Wire,
    element_name,
    find_state,
    split_index,
    state_names,
)
from tracewire.errors import DiagramError, Location
from tracewire.formula import CONSTANTS, Call, Expression, Name, Number, names_of, parse, rename
from tracewire.library import Block, Parameter


def flatten(diagram: Diagram) -> Flat:
    """The flat equations of a checked diagram.

    Raises DiagramError where the shapes of vectors do not go together, where a port that must not
    get a jump is wired to one, and where a parameter has the name of something else.
    """
    flattener = _Flattener(diagram)
    flat = expand_vectors(flattener.flat(), flattener.places, tuple(diagram.record.values()))
    places = {**flattener.places, **{name: block.place for name, block in flat.blocks.items()}}
    signals, loops = order_signals(flat.signals, flat.guesses, flat.blocks, places)
    measured = {name: None for series in diagram.measured.values() for name in series.channels}
    if problems := find_name_clashes(flat, measured):
        raise DiagramError(problems)
    flat = replace(flat, signals=signals, loops=loops)
    return replace(flat, units=complete_units(flat))


def _bounds(parameter: Parameter, value: Expression) -> list[Expression]:
    """What the bounds of a parameter ask of its value, or of each element of a list."""
    if isinstance(value, Call) and value.function == "stack":
        return [bound for element in value.arguments for bound in _bounds(parameter, element)]
    limits = ((">", parameter.above), (">=", parameter.low), ("<=", parameter.high))
    return [Call(name, (value, Number(limit))) for name, limit in limits if limit is not None]


def _scaled(formula: Expression, factor: float) -> Expression:
    if factor == 1.0:
        return formula
    if isinstance(formula, Number):
        return Number(formula.value * factor)
    return Call("*", (formula, Number(factor)))


def _signal_of(wire: Expression | None) -> str:
    """The signal that a wire carries, also with a sign; '' where it carries another formula."""
    source = wire.arguments[0] if isinstance(wire, Call) else wire
    return source.name if isinstance(source, Name) else ""


class _Flattener:
    def __init__(self, diagram: Diagram) -> None:
        self.top = diagram
        self.states: dict[str, FlatState] = {}
        self.signals: dict[str, Expression] = {}
        self.parameters: dict[str, FlatParameter] = {}
        self.tables: dict[str, Points] = {}
        self.events: list[FlatEvent] = []
        self.memories: list[FlatMemory] = []
        self.blocks: dict[str, FlatBlock] = {}
        self.units: dict[str, str] = {}
        self.units_of: dict[str, str] = {}  # signals that have the unit of another one
        self.asked: list[FlatAsked] = []
        self.shown: dict[str, Shown] = {}
        self.guesses: dict[str, Expression] = {}
        self.places: dict[str, Location] = {}  # of the outputs of subsystems
        self.sampled: list[SampledPort] = []
        self.continuous: list[ContinuousPort] = []
        self.told: list[str] = []  # the states that a run keeps where nothing says which
        self.require: list[Condition] = []  # of blocks

    def flat(self) -> Flat:
        top = self.top
        inputs = {name: Name(name) for name in top.inputs}
        self.units |= {name: port.unit for name, port in top.inputs.items()}
        for name, port in top.inputs.items():
            self.show(name, name, port.shown)
        self.add_parameters(top, "", {})
        self.add_diagram(top, "", "", inputs)
        self.add_units()
        self.add_samples()
        self.refuse_jumps()
        scope = _Scope(top, "", inputs)
        self.asked += asked_of_top(top, lambda value: self.value(value, scope))
        span = top.span or (Value(Number(0.0)), Value(Number(1.0)))
        record = tuple(top.record) or tuple(self.told) or tuple(self.states)
        return Flat(
            title=top.title or top.file.stem,
            states=tuple(self.states.values()),
            signals=self.signals,
            guesses=self.guesses,
            parameters=self.parameters,
            inputs={
                name: None if port.default is None else self.value(port.default, scope)
                for name, port in top.inputs.items()
            },
            tables=self.tables,
            events=tuple(self.events),
            record=tuple(self.recorded(name, scope) for name in record),
            span=(self.value(span[0], scope), self.value(span[1], scope)),
            every=None if top.every is None else self.value(top.every, scope),
            max_step=None if top.max_step is None else self.value(top.max_step, scope),
            presets={
                name: {key: self.value(value, scope) for key, value in preset.items()}
                for name, preset in top.presets.items()
            },
            blocks=self.blocks,
            units=self.units,
            asked=tuple(self.asked),
            shown=self.shown,
            memories=tuple(self.memories),
            require=tuple(self.require),
        )

    def add_units(self) -> None:
        """The units that outputs of blocks have from their inputs, as a filter has."""
        for name in self.units_of:
            source, seen = name, set[str]()
            while not self.units.get(source) and source in self.units_of and source not in seen:
                seen.add(source)
                source = self.units_of[source]
            self.units[name] = unit = self.units.get(source, "")
            if name in self.states:
                self.states[name] = replace(self.states[name], unit=unit)

    def add_samples(self) -> None:
        """The ports that a clock samples, when everything is known that they may read."""
        if self.sampled:
            self.require += sample_ports(
                self.sampled,
                self.signals,
                self.states,
                self.events,
                self.memories,
                self.top.inputs,
                self.parameters,
            )

    def refuse_jumps(self) -> None:
        """Raises DiagramError: a port that must not get a jump is wired to one."""
        found = jump_problems(
            self.continuous,
            self.signals,
            self.states,
            self.events,
            self.memories,
            self.parameters,
        )
        if found:
            raise DiagramError(found)

    def show(self, name: str, path: str, shown: Shown) -> None:
        """Note how a signal of the block at `path` is shown, if it is not by its name in SI."""
        if shown != Shown():
            own = shown.label and shown.label + name.removeprefix(path)
            self.shown[name] = replace(shown, label=own)

    def value(self, value: Value, scope: _Scope) -> Expression:
        return _scaled(rename(value.formula, scope.resolve), value.factor)

    def recorded(self, name: str, scope: _Scope) -> str:
        if name in self.signals or name in self.states or name in self.top.inputs:
            return name
        name, index = split_index(name)
        resolved = scope.resolve(name)
        return element_name(resolved.name if isinstance(resolved, Name) else name, index)

    def add_parameters(
        self, diagram: Diagram, path: str, given: Mapping[str, tuple[Value, _Scope]]
    ) -> None:
        """The parameters of a diagram; those of a subsystem may be given by its use."""
        own = _Scope(diagram, path, {})
        for name, default in diagram.parameters.items():
            value, scope = given.get(name, (default, own))
            self.parameters[path + name] = FlatParameter(
                name=path + name,
                formula=self.value(value, scope),
                unit=value.unit or default.unit,
                fit=value.fit,
                factor=value.factor,
                place=value.place,
                written=value.written,
            )

    def add_diagram(
        self, diagram: Diagram, path: str, definition: str, inputs: Mapping[str, Expression]
    ) -> None:
        scope = _Scope(diagram, path, inputs)
        self.require += [
            replace(known, formula=rename(known.formula, scope.resolve))
            for known in diagram.require
        ]
        for name, count in diagram.counts.items():
            hint = f"'{name}' says how many blocks there are: change it in the diagram."
            for relation in (">=", "<="):  # formulas have no equality
                fixed = Call(relation, (Name(path + name), Number(count)))
                self.require.append(Condition(fixed, diagram.parameters[name].place, hint))
        for use in diagram.blocks.values():
            if use.subsystem is not None:
                self.add_subsystem(use, use.subsystem, scope)
            else:
                self.add_block(use, diagram.library[use.type], scope, definition)
        for number, event in enumerate(diagram.events):
            values = {
                scope.state(name): rename(formula, scope.resolve)
                for name, formula in event.set.items()
            }

            def read(given: Expression | Value) -> Expression:
                if isinstance(given, Value):
                    return self.value(given, scope)
                return rename(given, scope.resolve)

            name = f"{path}events[{number}]"
            self.events += diagram_events(event, name, values, read, path, self.events)
            self.asked += asked_of_clock(event, read)
            if event.every is not None and event.offset is not None:
                every, offset = read(event.every), read(event.offset)
                self.require += near_ticks(every, offset, event.place)

    def add_subsystem(self, use: BlockUse, inside: Diagram, scope: _Scope) -> None:
        path = f"{scope.path}{use.name}."
        given = {
            name: (value, scope) for name, value in use.settings.items() if isinstance(value, Value)
        }
        self.add_parameters(inside, path, given)
        inputs: dict[str, Expression] = {}
        inner = _Scope(inside, path, inputs)
        for name, port in inside.inputs.items():
            if name in use.inputs:
                inputs[name] = scope.wire(use.inputs[name][0])
            elif port.default is not None:
                inputs[name] = self.value(port.default, inner)
        self.add_diagram(inside, path, f"{use.type}.", inputs)
        for port_name, wire in inside.outputs.items():
            name, carried = path + port_name, inner.wire(wire)
            itself = carried == Name(name) and (name in self.states or name in self.blocks)
            if not itself:  # a port may have the name of the block that it carries
                self.signals[name] = carried
                self.places[name] = wire.place
            self.units[name] = use.unit or self.units.get(_signal_of(carried), "")
            self.show(name, path[:-1], use.shown)

    def add_block(self, use: BlockUse, block: Block, scope: _Scope, definition: str) -> None:
        path = scope.path + use.name
        place = Location(use.place.file, use.place.line, use.place.column, path)
        names: dict[str, Expression] = {}
        manies: dict[str, list[Expression]] = {}
        for parameter in block.parameters:
            names[parameter.name] = self.setting(use, parameter, scope)
        for parameter in block.parameters:  # a default may be a formula of other parameters
            if isinstance(parameter.default, str) and parameter.name not in use.settings:
                names[parameter.name] = rename(
                    block.defaults[parameter.name], lambda name: names.get(name, Name(name))
                )
        states = state_names(block, path)
        names |= {inner: Name(outer) for inner, outer in states.items()}
        names |= memory_name(block, path)
        for port in block.inputs:
            wires = use.inputs.get(port.name, ())
            if port.many:
                manies[port.name] = [scope.wire(wire) for wire in wires]
            elif wires and port.sampled is not None:
                sample = f"{path}.{port.name}"
                names[port.name] = Name(sample)
                self.places[sample] = place
                event, wire = f"{path}.{port.sampled}", scope.wire(wires[0])
                self.sampled.append(SampledPort(sample, wire, event, place))
            elif wires:
                names[port.name] = wire = scope.wire(wires[0])
                if port.continuous:
                    self.continuous.append(ContinuousPort(port.name, block.name, wire, place))
            else:
                default = block.port_defaults[port.name]
                names[port.name] = rename(default, lambda name: names.get(name, Name(name)))

        for parameter in block.parameters:
            given = use.settings.get(parameter.name)
            if isinstance(given, Value) and given.named and parameter.unit_of in names:
                own, like = f"{path}.{parameter.name}", names[parameter.unit_of]
                self.asked.append(
                    FlatAsked(own, Name(own), place=given.place, like=like, given=unit_text(given))
                )

        def written(formula: Expression) -> Expression:
            full = rename(write_wires(formula, manies), lambda name: names.get(name, Name(name)))
            curve_tables(full, self.tables)
            return without_zero_products(full)

        conditions = [written(condition) for condition in block.conditions]
        for parameter in block.parameters:
            if not isinstance(use.settings.get(parameter.name), Points):
                conditions += _bounds(parameter, written(Name(parameter.name)))
        for given in conditions:
            if names_of(given) and not has_vectors(given):
                self.require.append(Condition(given, place, f"Its block '{block.name}' needs it."))
        one = len(block.outputs) == 1
        outputs = {path if one else f"{path}.{output.name}": output for output in block.outputs}
        for state in block.states:
            name = states[state.name]
            start = written(block.starts[state.name])
            rate = written(block.rates[state.name])
            # the unit that a use gives is that of its outputs, not of what is inside
            unit = (use.unit if name in outputs else "") or state.unit
            self.states[name] = FlatState(name, rate, start, unit, place)
            self.told += [] if state.hidden else [name]
            self.units[name] = unit
            self.show(name, path, use.shown if name in outputs else Shown(use.shown.label))
        for name, output in outputs.items():
            wired = _signal_of(names.get(output.unit_of))
            if wired and not (use.unit or output.factor in use.settings):
                self.units_of[name] = wired
            formula = written(block.formulas[output.name])
            self.blocks[name] = FlatBlock(
                name, use.type, definition + use.name, _resolved(use.local, scope), place
            )
            if use.guess is not None:
                self.guesses[name] = self.array(use.guess, scope)
            if formula != Name(name):  # an integrator's output is its state
                self.signals[name] = formula
                self.units[name] = use.unit or output.unit
                self.show(name, path, use.shown)
        self.events += block_events(block, path, states, written, place)
        for happening in block.events:
            if happening.every is not None:
                every, offset = written(parse(happening.every)), written(parse(happening.offset))
                self.require += near_ticks(every, offset, place)
        self.memories += block_memory(block, path, states, written, place)

    def setting(self, use: BlockUse, parameter: Parameter, scope: _Scope) -> Expression:
        value = use.settings.get(parameter.name)
        if isinstance(value, Points):
            table = f"{scope.path}{use.name}.{parameter.name}"
            self.tables[table] = value
            return Name(table)
        name = f"{scope.path}{use.name}.{parameter.name}"
        if isinstance(value, Array):
            names = (element_name(name, (number,)) for number in range(len(value.items)))
            items = zip(value.items, names, strict=True)
            return Call("stack", tuple(self.own(item, at, parameter, scope) for item, at in items))
        if isinstance(value, Value):
            return self.own(value, name, parameter, scope)
        if value is not None:
            return rename(value, scope.resolve)
        default = parameter.default
        return Number(float(default)) if isinstance(default, int | float) else Number(0.0)

    def own(self, value: Value, name: str, parameter: Parameter, scope: _Scope) -> Expression:
        """The formula of a value in a block; a named one is a parameter of the run."""
        formula = self.value(value, scope)
        if parameter.unit and (value.named or not isinstance(formula, Number)):
            meant = Name(name) if value.named else formula
            given = unit_text(value)
            self.asked.append(FlatAsked(name, meant, parameter.unit, value.place, given=given))
        if not value.named:
            return formula
        unit = value.unit or parameter.unit
        self.parameters[name] = FlatParameter(
            name, formula, unit, value.fit, value.factor, value.place, value.written
        )
        return Name(name)

    def array(self, value: Value | Array, scope: _Scope) -> Expression:
        if isinstance(value, Array):
            return Call("stack", tuple(self.value(item, scope) for item in value.items))
        return self.value(value, scope)


def _resolved(local: Mapping[str, str], scope: _Scope) -> dict[str, str]:
    found = {symbol: scope.resolve(name) for symbol, name in local.items()}
    return {symbol: node.name for symbol, node in found.items() if isinstance(node, Name)}


class _Scope:
    """The names that are visible in one diagram, and the full names that they stand for."""

    def __init__(self, diagram: Diagram, path: str, inputs: Mapping[str, Expression]) -> None:
        self.diagram, self.path, self.inputs = diagram, path, inputs

    def wire(self, wire: Wire) -> Expression:
        carried = self.resolve(wire.signal)
        if wire.index:
            carried = Call("[]", (carried, *(Number(float(i)) for i in wire.index)))
        return Call("neg", (carried,)) if wire.negative else carried

    def state(self, name: str) -> str:
        return self.path + (find_state(self.diagram, name) or name)

    def resolve(self, name: str) -> Expression:
        if name in self.inputs:
            return self.inputs[name]
        if name == "t" or name in CONSTANTS:
            return Name(name)
        head, _, rest = name.partition(".")
        use = self.diagram.blocks.get(head)
        if use is None:
            return Name(self.path + name)
        if use.subsystem is not None:
            port = rest or next(iter(use.subsystem.outputs), "")
            return Name(f"{self.path}{head}.{port}")
        if len(self.diagram.library[use.type].outputs) == 1:
            return Name(self.path + head)
        return Name(self.path + name)
