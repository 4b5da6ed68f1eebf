"""Modes that may hold their guard at zero: a mode that moves the rate of its own guard.

While such a mode slides (friction that sticks), what reads it is no choice of two values, but any
between them: it moves without an event. So what reads it is compared by a guard that is located.
What a friction that sticks takes is all that the rate of its guard has besides, and the force of
a contact is all that presses it: so a mode also moves what only a friction or a contact hands on.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from tracewire.compile.differentiate import differentiate
from tracewire.compile.lowered import Lowered, Reset
from tracewire.compile.tape import Tape


def moving(low: Lowered, rates: Sequence[int], flow: Mapping[int, int]) -> list[frozenset[int]]:
    """The modes that move the guard of each mode: those that its rate reads, those that move what
    is held by one of these, and those that move the force of a contact on what the guard reads.

    `rates` are the derivatives of the guards along the flow.
    """
    found = [frozenset(modes_read(low.tape, [rate])) for rate in rates]
    contacts = [reset for reset in low.resets if may_rest(low, reset, rates)]
    if contacts:
        forces = _movers_of_forces(low, contacts, rates, flow)
        for number, mode in enumerate(low.modes):
            read = low.tape.needed([mode.guard])
            found[number] = found[number].union(
                *(
                    force
                    for reset, force in zip(contacts, forces, strict=True)
                    if not _pushed(low, reset).isdisjoint(read)
                )
            )
    while True:
        held = holding(low, found)
        more = [own.union(*(found[i] for i in own & held)) for own in found]
        if more == found:
            return found
        found = more


def _movers_of_forces(
    low: Lowered, contacts: Sequence[Reset], rates: Sequence[int], flow: Mapping[int, int]
) -> list[frozenset[int]]:
    """The modes that move the force of each contact, also by those of others that press it."""
    read = [low.tape.needed([rates[reset.trigger]]) for reset in contacts]
    pressing = [
        [n for n, other in enumerate(contacts) if not _pushed(low, other).isdisjoint(own)]
        for own in read
    ]
    bends = differentiate(low.tape, [rates[reset.trigger] for reset in contacts], flow)
    found = [frozenset(modes_read(low.tape, [bend])) for bend in bends]
    while True:
        more = [
            own.union(*(found[n] for n in numbers))
            for own, numbers in zip(found, pressing, strict=True)
        ]
        if more == found:
            return found
        found = more


def _pushed(low: Lowered, contact: Reset) -> frozenset[int]:
    """The entries of the states that the force of a contact acts on."""
    return frozenset(low.states[state] for state in contact.values)


def holding(low: Lowered, moved: Sequence[Collection[int]]) -> frozenset[int]:
    """The numbers of the modes that may hold their guards: those that are among their own movers,
    which `moving` tells."""
    return frozenset(
        number
        for number, mode in enumerate(low.modes)
        if number in moved[number] and mode.kind == "sign" and not mode.timed
    )


def may_rest(low: Lowered, reset: Reset, rates: Sequence[int]) -> bool:
    """Whether a reset may be that of a contact: it writes a rate of its guard, and no place."""
    trigger = reset.trigger
    if trigger < 0 or low.modes[trigger].kind != "sign":
        return False
    written = _pushed(low, reset)
    turns = not written.isdisjoint(low.tape.needed([rates[trigger]]))
    return turns and written.isdisjoint(low.tape.needed([low.modes[trigger].guard]))


def modes_read(tape: Tape, roots: Sequence[int]) -> set[int]:
    """The numbers of the modes that entries read."""
    if "mode" not in tape.leaves(roots):
        return set()
    entries = (tape.entries[index] for index in tape.needed(roots))
    return {int(entry.payload) for entry in entries if entry.op == "mode"}


def reads(tape: Tape, roots: Sequence[int], modes: Collection[int]) -> bool:
    """Whether entries read one of these modes."""
    return bool(modes) and not modes_read(tape, roots).isdisjoint(modes)
