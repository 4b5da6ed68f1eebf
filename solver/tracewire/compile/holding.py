"""Modes that may hold their guard at zero: a mode that moves the rate of its own guard.

While such a mode slides (friction that sticks), what reads it is no choice of two values, but any
between them: it moves without an event. So what reads it is compared by a guard that is located.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tracewire.compile.lowered import Mode
from tracewire.compile.tape import Tape


def holding(tape: Tape, modes: Sequence[Mode], rates: Sequence[int]) -> frozenset[int]:
    """The numbers of these modes; `rates` are the derivatives of the guards along the flow."""
    found = set()
    for number, (mode, rate) in enumerate(zip(modes, rates, strict=True)):
        may = mode.kind == "sign" and not mode.timed and "mode" in tape.leaves([rate])
        if may and mode.leaf in tape.needed([rate]):
            found.add(number)
    return frozenset(found)


def modes_read(tape: Tape, roots: Sequence[int]) -> set[int]:
    """The numbers of the modes that entries read."""
    if "mode" not in tape.leaves(roots):
        return set()
    entries = (tape.entries[index] for index in tape.needed(roots))
    return {int(entry.payload) for entry in entries if entry.op == "mode"}


def reads(tape: Tape, roots: Sequence[int], modes: Collection[int]) -> bool:
    """Whether entries read one of these modes."""
    return bool(modes) and not modes_read(tape, roots).isdisjoint(modes)
