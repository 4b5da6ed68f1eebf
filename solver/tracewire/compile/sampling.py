"""Sampled ports: a block with a clock reads what its wire carried when the clock last ticked.

u[k], the value of a port at tick k, is the formula of its wire, in which

- what the same clock holds has its value after the tick: of several blocks in a row with one clock
  each reads what those before it have put out at this tick, and no delay adds up;
- all else (states that flow, the time, measured inputs, what another clock holds) has the value
  that it had just before the tick. It is kept in a state, which the event of the tick sets.

So a wire that the clock holds altogether passes, one that flows is sampled, and in the difference
of a held reference and a measurement that flows only the measurement is sampled.

Clocks are the same where their formulas are, with the numbers that blocks give: two blocks with
`period: {value: 10, unit: ms}` have one clock. A run that gives one of these numbers another value
would need another model, and is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tracewire.compile.flat import FlatEvent, FlatMemory, FlatParameter, FlatState
from tracewire.diagram import Condition
from tracewire.errors import Location
from tracewire.formula import Call, Expression, Name, Number, has_delay, names_of, rename

APART = (
    "Blocks that give this number have one clock: write one parameter of the diagram in all of"
    " them, and change that."
)


@dataclass(frozen=True)
class SampledPort:
    """A port by its full name, what its wire carries, and the event of its clock by its name."""

    name: str
    wire: Expression
    event: str
    place: Location


def sample_ports(
    ports: Sequence[SampledPort],
    signals: dict[str, Expression],
    states: dict[str, FlatState],
    events: list[FlatEvent],
    memories: Sequence[FlatMemory],
    inputs: Iterable[str],
    parameters: Mapping[str, FlatParameter],
) -> list[Condition]:
    """Add to the signals, states and events of a model what its sampled ports are.

    Returns the conditions under which the clocks that were taken for one are one.
    """
    clocks = {event.name: event.when for event in events if event.clocked}
    flowing = {"t", *inputs} | {memory.name for memory in memories}
    flowing |= {name for m in memories for move in m.transitions for name in move.set}
    clock_of_port = {port.name: clocks[port.event] for port in ports}
    setters: dict[str, list[Expression | None]] = {}  # of a state, the clocks that set it
    for event in events:
        for name in {name.partition("[")[0] for name in event.set}:
            setters.setdefault(name, []).append(event.when if event.clocked else None)
    same = _SameClock(parameters)
    holds = _Holds(dict(signals), dict(states), setters, flowing, clock_of_port, same)
    for port in ports:
        sampling = _Sampling(port, clocks[port.event], holds)
        signals |= sampling.signals
        states |= sampling.states
        for number, event in enumerate(events):
            if event.name == port.event:
                events[number] = replace(event, set={**event.set, **sampling.taken})
    return same.conditions()


class _SameClock:
    """Tells whether two clocks are one, and by which values of parameters they are."""

    def __init__(self, parameters: Mapping[str, FlatParameter]) -> None:
        self.parameters = parameters
        self.fixed: set[str] = set()

    def __call__(self, clock: Expression, other: Expression) -> bool:
        if clock == other:
            return True
        one = self.plain(clock) == self.plain(other)
        if one:
            self.fixed |= {name for name in names_of(clock) + names_of(other) if self.own(name)}
        return one

    def plain(self, clock: Expression) -> Expression:
        """The clock with the numbers that stand in blocks in the place of their names."""
        return rename(
            clock,
            lambda name: (
                self.plain(self.parameters[name].formula) if self.own(name) else Name(name)
            ),
        )

    def own(self, name: str) -> bool:
        """Whether a parameter is that of a block or a subsystem, and no fit changes it."""
        return "." in name and name in self.parameters and self.parameters[name].fit is None

    def conditions(self) -> list[Condition]:
        """That the parameters have the values by which clocks are one."""
        found = []
        for name in sorted(self.fixed):
            own, value = Name(name), self.parameters[name].formula
            equal = Call("and", (Call("<=", (own, value)), Call(">=", (own, value))))
            found.append(Condition(equal, self.parameters[name].place, APART))
        return found


class _Sampling:
    """What one port adds: signals that are computed of samples, states that keep these."""

    def __init__(self, port: SampledPort, clock: Expression, holds: _Holds) -> None:
        self.port, self.clock, self.holds = port, clock, holds
        self.signals: dict[str, Expression] = {}
        self.states: dict[str, FlatState] = {}
        self.taken: dict[str, Expression] = {}
        held, flows = holds.reads(port.wire, clock)
        if flows and not held:
            self.take(port.name, port.wire)
        else:
            self.signals[port.name] = rename(port.wire, self.sample)

    def take(self, name: str, carried: Expression) -> Name:
        """A state that keeps what a formula was at the tick."""
        zeros = Call("zeros_like", (carried,))
        self.states[name] = FlatState(name, zeros, Number(0.0), "", self.port.place)
        self.taken[name] = carried
        return Name(name)

    def sample(self, name: str) -> Expression:
        """What stands for a signal or a state in the formula of the port."""
        held, flows = self.holds.reads(Name(name), self.clock)
        own = f"{self.port.name}.{name}"
        if not flows or own in self.signals or own in self.states:
            return Name(own if flows else name)
        if not held:
            return self.take(own, Name(name))
        self.signals[own] = Name(own)  # it may be met again, in an algebraic loop
        self.signals[own] = rename(self.holds.signals[name], self.sample)
        return Name(own)


@dataclass(frozen=True)
class _Holds:
    """Tells what clocks hold; `flowing` are names of what no clock holds."""

    signals: Mapping[str, Expression]
    states: Mapping[str, FlatState]
    setters: Mapping[str, Sequence[Expression | None]]
    flowing: set[str]
    ports: Mapping[str, Expression]
    same: _SameClock

    def reads(self, formula: Expression, clock: Expression) -> tuple[bool, bool]:
        """Whether a formula reads, by signals, what the clock holds; and what it does not hold."""
        seen: set[str] = set()
        due = list(names_of(formula))
        held = flows = False
        while due:
            name = due.pop()
            if name in seen:
                continue
            seen.add(name)
            if name in self.flowing:
                flows = True
            elif name in self.ports:
                own = self.same(self.ports[name], clock)
                held, flows = held or own, flows or not own
            elif name in self.states:
                own = self.stands(name) and all(
                    setter is not None and self.same(setter, clock)
                    for setter in self.setters.get(name, ())
                )
                held, flows = held or own, flows or not own
            elif name in self.signals and has_delay(self.signals[name]):
                flows = True  # it changes at other times than what it reads
            elif name in self.signals:
                due += names_of(self.signals[name])
        return held, flows

    def stands(self, name: str) -> bool:
        """Whether a state has no rate."""
        rate = self.states[name].rate
        return rate == Number(0.0) or (isinstance(rate, Call) and rate.function == "zeros_like")
