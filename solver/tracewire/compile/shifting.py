"""Signals of t alone at another time: `shifted(u, time)` is u(t - time), before the start, too.

What such a signal was needs no memory: it is the same formula at another time. So a run may begin
anywhere, its steps may be longer than `time`, and a jump of an input comes at a known time.
"""

from __future__ import annotations

from tracewire.compile.flat import Flat
from tracewire.formula import CONSTANTS, OPERATIONS, Call, Expression, Name, names_of, to_text


class ShiftError(Exception):
    """Why a signal cannot be shifted, and what to do."""

    def __init__(self, what: str, hint: str) -> None:
        super().__init__(what)
        self.hint = hint


def shift_signals(flat: Flat, signal: Expression, time: Expression) -> dict[str, Expression]:
    """The formula of a signal `time` ago behind those of all signals that it reads, by names of
    their own.

    Raises ShiftError: it reads more than t, inputs and parameters, or the time changes.
    """
    if not flat.parameters.keys() | CONSTANTS.keys() >= set(names_of(time)):
        what = f"the shift '{to_text(time)}' of '{to_text(signal)}' changes during a run"
        raise ShiftError(what, "Use a block of type variable_delay.")
    then = Call("-", (Name("t"), time))
    looped = {name for loop in flat.loops for name in loop.names}
    needed, due = dict[str, str](), list(names_of(signal))
    while due:
        name = due.pop()
        if name in flat.signals and name not in looped and name not in needed:
            needed[name] = f"{name} at {to_text(then)}"
            due += names_of(flat.signals[name])

    def moved(node: Expression) -> Expression:
        if isinstance(node, Name):
            return _at(flat, node, then, needed)
        if not isinstance(node, Call):
            return node
        if node.function in ("delayed", "is_held"):
            raise _no_function_of_time(node)
        keeps = OPERATIONS[node.function].reads if node.function in OPERATIONS else ""
        values = node.arguments[:-1] if keeps else node.arguments
        return Call(node.function, (*map(moved, values), *node.arguments[len(values) :]))

    in_order = [name for name in flat.signals if name in needed]
    found = {needed[name]: moved(flat.signals[name]) for name in in_order}
    return {**found, to_text(Call("shifted", (signal, time))): moved(signal)}


def _at(flat: Flat, name: Name, then: Expression, needed: dict[str, str]) -> Expression:
    """A name of a formula at another time."""
    if name.name == "t":
        return then
    if name.name in flat.parameters or name.name in CONSTANTS:
        return name
    if name.name in flat.inputs:
        return Call("interp", (then, name))
    if name.name in needed:
        return Name(needed[name.name])
    raise _no_function_of_time(name)


def _no_function_of_time(read: Expression) -> ShiftError:
    what = f"'{to_text(read)}' is read as it was some time ago, and is no function of t alone"
    return ShiftError(what, "Use a block of type delay, which remembers it.")
