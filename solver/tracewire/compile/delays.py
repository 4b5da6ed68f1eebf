"""Delays: how far a jump gets through them.

`delayed(u, time, before)` is u(t - time), and before the start of the run what `before` is, a
formula of t, at t - time. The mode of a delay is the number of the smooth stretch of u that is
read: its guard t - time reaches the next one `time` after u has jumped, which is a known time.

A jump in the derivative of order r of what is read is one of order r + k of what follows from it
through k integrators. What a slide or a contact holds jumps with all that it balances. So each
delay is told, of each mode and state, the least number of integrators on the way from there to its
signal (A. Bellen, M. Zennaro, Numerical Methods for Delay Differential Equations, section 2.2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tracewire.compile.lowered import Lowered
from tracewire.compile.tape import Tape

NO_WAY = 1_000


def jump_orders(
    lowered: Lowered, fractions: Mapping[int, int], forces: Mapping[int, Sequence[int]]
) -> list[list[int]]:
    """Of each mode and behind them each state: by how many orders its jump is smoother in the
    signal of each delay; NO_WAY where it does not get there.

    fractions: of the leaf of a mode that may slide, the entry by which its fraction is found.
    forces: of a state, those by which the forces of contacts are found that may push it.
    """
    leaves = [*(mode.leaf for mode in lowered.modes), *lowered.states]
    rates: dict[int, list[int]] = {
        state: [rate, *forces.get(state, ())]
        for state, rate in zip(lowered.states, lowered.rates, strict=True)
    }
    found = [_orders(lowered.tape, delay.signal, fractions, rates) for delay in lowered.delays]
    return [[column.get(leaf, NO_WAY) for column in found] for leaf in leaves]


def _orders(
    tape: Tape, signal: int, fractions: Mapping[int, int], rates: Mapping[int, Sequence[int]]
) -> Mapping[int, int]:
    """The least number of integrators between a leaf and a signal, of the leaves it depends on."""
    found: dict[int, int] = {}
    due, order = {signal}, 0
    while due:
        later: set[int] = set()
        while due:
            read = [index for index in tape.needed(due) if index not in found]
            found |= dict.fromkeys(read, order)
            due = {fractions[index] for index in read if index in fractions}
            later |= {rate for index in read for rate in rates.get(index, ())}
        due, order = later - found.keys(), order + 1
    return found
