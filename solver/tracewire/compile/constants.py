"""The constants of a run: what a model computes from its parameters alone, once for a whole run."""

from __future__ import annotations

from collections.abc import Iterable

from tracewire.compile.tape import Tape

OF_THE_PAST = 3
"""Places behind the parameters that say what delayed signals were."""


class Constants:
    """The entries that only read parameters, and their places in the array `c` of a run.

    c[0:P] are the parameters themselves; the entries that were collected stand behind them. A
    function written later uses those that are there, and computes what it needs beyond them. Where
    the model has delays, c[P] is the address of what their signals were, which a run writes there,
    c[P + 1] that of what a record tells of the time before the run, and c[P + 2] where that begins.
    """

    def __init__(self, tape: Tape, parameters: int, delays: bool = False) -> None:
        self.tape, self.parameters = tape, parameters
        self.delays = delays
        self.places: dict[int, int] = {}

    @property
    def size(self) -> int:
        """The length of `c`."""
        return self.parameters + OF_THE_PAST * int(self.delays) + len(self.places)

    def collect(self, roots: Iterable[int]) -> None:
        """Give a place to each entry on the way to `roots` that only reads parameters."""
        bits = self.tape.bits
        allowed = bits.get("param", 0) | bits.get("const", 0)
        seen: set[int] = set()
        found: list[int] = []
        stack = list(roots)
        while stack:
            index = stack.pop()
            operands = self.tape.entries[index].operands
            if index in seen or not operands:
                continue
            seen.add(index)
            if self.tape.kinds[index] & ~allowed:
                stack.extend(operands)
            else:
                found.append(index)
        for index in sorted(found):
            self.places.setdefault(index, self.size)

    def place(self, index: int) -> int | None:
        """Where in `c` an entry is; None where it is not there."""
        entry = self.tape.entries[index]
        return int(entry.payload) if entry.op == "param" else self.places.get(index)

    def order(self, roots: Iterable[int]) -> list[int]:
        """The entries that a function of these roots reads or computes, each after its operands."""
        return self.tape.needed(roots, lambda index: self.place(index) is not None)
