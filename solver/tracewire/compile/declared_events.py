"""What blocks and diagrams declare to happen, as flat events and memories."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tracewire.compile.flat import FlatEvent, FlatMemory, FlatTransition
from tracewire.compile.limits import MODEL
from tracewire.diagram import Condition, Crosses, Event, Value
from tracewire.errors import Location
from tracewire.formula import Call, Expression, Name, Number, parse, parse_condition, to_text
from tracewire.library import Block

NEAR = "Give the clock an offset between 0 and its period: the ticks are at offset + k*period."
Write = Callable[[Expression], Expression]
"""A formula of a block with its names replaced by full ones."""


def memory_name(block: Block, path: str) -> dict[str, Expression]:
    """The full name of what the formulas of a block with memory know as `mode`."""
    return {"mode": Name(f"{path}.mode")} if block.modes else {}


def block_events(
    block: Block, path: str, states: Mapping[str, str], write: Write, place: Location
) -> list[FlatEvent]:
    """The events of a block; one with several guards is several, of one name."""
    found: list[FlatEvent] = []
    for event in block.events:
        if event.every is None:
            whens = [write(parse(guard)) for guard in event.guards]
        else:
            whens = [clock(write(parse(event.every)), write(parse(event.offset)))]
        for when in whens:
            found.append(
                FlatEvent(
                    name=f"{path}.{event.name}",
                    when=when,
                    crosses="up" if event.every else event.crosses,
                    set={
                        states[name]: write(block.read(formula))
                        for name, formula in event.set.items()
                    },
                    place=place,
                    kind=event.kind,
                    clocked=event.every is not None,
                    block=path,
                )
            )
    return found


def block_memory(
    block: Block, path: str, states: Mapping[str, str], write: Write, place: Location
) -> list[FlatMemory]:
    """The memory of a block that has modes, else nothing."""
    transitions = tuple(
        FlatTransition(
            source=block.number(transition.source),
            target=block.number(transition.target),
            when=write(parse_condition(transition.when)),
            set={states[name]: write(parse(formula)) for name, formula in transition.set.items()},
        )
        for transition in block.transitions
    )
    modes = tuple(mode.name for mode in block.modes)
    start = write(block.start_mode)
    return [FlatMemory(f"{path}.mode", modes, start, transitions, place)] if modes else []


def diagram_events(
    event: Event,
    name: str,
    values: Mapping[str, Expression],
    read: Callable[[Expression | Value], Expression],
    path: str,
    known: Sequence[FlatEvent],
) -> list[FlatEvent]:
    """The event of a diagram; one that names a block's event happens wherever that one does.

    read: a formula or value of the diagram with its names replaced by full ones. known: the events
    of its blocks, and perhaps others.
    """

    def made(when: Expression, crosses: Crosses, clocked: bool, block: str = "") -> FlatEvent:
        return FlatEvent(name, when, crosses, values, event.place, "reset", clocked, block)

    if event.every is not None:
        offset = Number(0.0) if event.offset is None else read(event.offset)
        return [made(clock(read(event.every), offset), "up", True)]
    if event.when is None:
        raise AssertionError("an event has 'when' or 'every'")
    if isinstance(event.when, Name) and "." in event.when.name:
        named = path + event.when.name
        same = [other for other in known if other.name == named]
        if same:
            return [made(e.when, e.crosses, e.clocked, e.block) for e in same]
    return [made(read(event.when), event.crosses, False)]


def clock(period: Expression, offset: Expression) -> Expression:
    """The formula that is a whole number where a clock ticks: at offset + k*period.

    Where the offset is above zero it is the time of the first tick: up to half a period before it
    the formula is -1/2.
    """
    if offset == Number(0.0):
        return Call("/", (Name("t"), period))
    periods = Call("/", (Call("-", (Name("t"), offset)), period))
    waiting = Call("max", (periods, Number(-0.5)))
    if isinstance(offset, Number):
        return waiting if offset.value > 0 else periods
    return Call("if", (Call(">", (offset, Number(0.0))), waiting, periods))


def near_ticks(period: Expression, offset: Expression, place: Location) -> list[Condition]:
    """What keeps the ticks of a clock apart: beyond, offset + k*period is the same for many k."""
    if offset == Number(0.0):
        return []
    most = Call("*", (Number(MODEL.most_periods), period))
    return [Condition(Call("<=", (Call("abs", (offset,)), most)), place, NEAR)]


def describe_clock(formula: Expression) -> str:
    """What the formula of a clock says, in words."""
    condition, first = "", ""
    if isinstance(formula, Call) and formula.function == "if":
        condition, formula = f" if {to_text(formula.arguments[0])}", formula.arguments[1]
    if isinstance(formula, Call) and formula.function == "max":
        formula = formula.arguments[0]
        if isinstance(formula, Call) and isinstance(formula.arguments[0], Call):
            first = f", first at t = {to_text(formula.arguments[0].arguments[1])}{condition}"
    return f"{to_text(formula)} is a whole number{first}"
