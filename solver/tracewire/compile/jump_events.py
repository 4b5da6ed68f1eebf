"""Events whose guard only jumps: it is constant between events, and never passes through zero.

Such a guard is a square wave, the output of a relay, a counter. There is nothing to locate: it
changes with something else that happens, and the event belongs to that instant. So it becomes
transitions of a memory of its own, one for each direction, whose trigger is the `side` of zero that
the guard is on: 0 below, 1 at zero, 2 above. Up, and down with the sides mirrored:

    below   -> reached  fires   the guard jumps to zero from below
    below   -> above    fires   over zero
    level   -> above    fires   from zero, where it began or to which it came from above
    level   -> below            back again
    reached -> above, reached -> below, above -> level, above -> below

so that a guard that goes -1, 0, 1 fires once, on its arrival, and one that goes 0, 1, 0, 1 each
time that it rises. The memory begins as `new`: a start fires nothing. The numbers of the modes fall
in each transition but those that fire, so that the log tells them apart.

Source: the rule for a jump from or to zero is that of triggered subsystems in Simulink.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from tracewire.compile.differentiate import differentiate
from tracewire.compile.flat import FlatEvent
from tracewire.compile.holding import reads
from tracewire.compile.lowered import Transition
from tracewire.compile.lowering import Lowering
from tracewire.formula import to_text

NAMES = ("below", "level", "above", "reached", "new")
BELOW, LEVEL, ABOVE, REACHED, NEW = range(len(NAMES))


@dataclass(frozen=True)
class Move:
    """A transition of the memory of an event: on a side of zero it goes from source to target."""

    source: int
    side: int
    target: int

    @property
    def fires(self) -> bool:
        """Whether it is what the event waits for."""
        return self.target > self.source


MOVES = (
    Move(NEW, 0, BELOW),
    Move(NEW, 1, LEVEL),
    Move(NEW, 2, ABOVE),
    Move(BELOW, 1, REACHED),
    Move(BELOW, 2, ABOVE),
    Move(LEVEL, 0, BELOW),
    Move(LEVEL, 2, ABOVE),
    Move(REACHED, 0, BELOW),
    Move(REACHED, 2, ABOVE),
    Move(ABOVE, 0, BELOW),
    Move(ABOVE, 1, LEVEL),
)


def only_jumps(lowering: Lowering, guard: int) -> bool:
    """Whether a guard is constant between events, and not only a formula of parameters.

    Its rate along the flow with frozen modes is identically zero, and no slide may hold what it
    reads.
    """
    tape = lowering.tape
    if tape.leaves([guard]) <= {"param", "const"}:
        return False
    rate = differentiate(tape, [guard], lowering.flow())[0]
    return tape.value(rate) == 0.0 and not reads(tape, [guard], lowering.holding())


def lower_jumps(lowering: Lowering, event: FlatEvent, guard: int, reset: int) -> None:
    """The memories and transitions of an event whose guard only jumps; `reset` is its reset."""
    out, tape = lowering.out, lowering.tape
    side = _side(lowering, guard, event)
    new, text = tape.constant(float(NEW)), to_text(event.when)
    ways: tuple[Literal["up", "down"], ...] = ("up", "down")
    for way in ways:
        if event.crosses not in (way, "both"):
            continue
        memory = int(tape.entries[lowering.memory(NAMES)].payload)
        out.modes[memory] = replace(out.modes[memory], guard=new, text=text, jumps=way)
        for move in MOVES:
            level = move.side if way == "up" else 2 - move.side
            number = reset if move.fires else -1
            out.transitions.append(
                Transition(memory, move.source, side, move.target, number, level)
            )


def _side(lowering: Lowering, guard: int, event: FlatEvent) -> int:
    """The number of the mode that tells on which side of zero a guard is: 0, 1 or 2."""
    tape, modes = lowering.tape, lowering.out.modes
    zero = tape.constant(0.0)
    at_least, above = (tape.push(op, guard, zero) for op in ("ge", "gt"))
    # half a unit away from where the floor would change
    number = tape.push("+", tape.push("+", at_least, above), tape.constant(0.5))
    mode = lowering.mode("floor", number, to_text(event.when))
    modes[mode] = replace(modes[mode], jumps="side")
    return mode
