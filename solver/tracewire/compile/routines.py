"""The functions of a model: what each computes, and its address once a back end has made it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from threading import RLock
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.compile.constants import Constants
from tracewire.compile.delays import jump_orders
from tracewire.compile.differentiate import differentiate, gradients
from tracewire.compile.holding import holding, may_rest, moving, reads
from tracewire.compile.lowered import Lowered
from tracewire.compile.machine import MachineWriter
from tracewire.compile.pace import pace
from tracewire.compile.pointers import FORWARD, UNREAD, address_of, as_c, place_of, when_called
from tracewire.compile.sizes import sizes
from tracewire.compile.source import Function, Writer, guarded, load
from tracewire.compile.straight import weights

Backend = Literal["llvm", "quick", "python"]
BACKENDS: tuple[Backend, ...] = ("llvm", "quick", "python")
ORDERS = {"guard_second": 2, "guard_third": 3, "guard_fourth": 4}
SIZES = {
    "guard_rate_sizes": "guard_rates",
    "guard_second_sizes": "guard_second",
    "guard_third_sizes": "guard_third",
    "guard_fourth_sizes": "guard_fourth",
    "rate_sizes": "rhs",
}
PREPARE = "prepare"
Addresses = NDArray[np.int64]


@dataclass(frozen=True)
class Sizes:
    """The lengths of a model's arrays.

    x[states], m[2*modes], c[constants] of which the first `parameters` are the parameters; out of
    `outputs` [outputs], of `timed` [2*timed], of `resets` [resets].
    """

    states: int
    modes: int
    parameters: int
    constants: int
    outputs: int
    timed: int
    resets: int


@dataclass(frozen=True)
class Routine:
    """What a function computes: the entry at each place of its `out`, 0 where there is none."""

    doc: str
    size: int
    roots: Mapping[int, int]


def _dense(doc: str, entries: Sequence[int]) -> Routine:
    return Routine(doc, len(entries), dict(enumerate(entries)))


class Routines:
    """The functions of one tape by name, made when they are first needed.

    The eager ones (`rhs`, `outputs`, ...) are made together and share the constants of `prepare`.
    The lazy ones (`jacobian`, ...) have the address of a callback until they are made: the first
    call makes them. That callback needs Python: threads that were started by compiled code must not
    be the first to call it, see `compiled_address`.
    """

    def __init__(
        self, lowered: Lowered, outputs: Sequence[int], labels: Mapping[int, str], backend: Backend
    ) -> None:
        low = self.lowered = lowered
        self.tape, self.labels, self.backend = low.tape, labels, backend
        self.states, self.modes = len(low.states), len(low.modes)
        self.lock = RLock()
        parameters = sum(e.op == "param" for e in low.tape.entries)
        self.constants = Constants(low.tape, parameters, bool(low.delays))
        self.flow = dict(zip(low.states, low.rates, strict=True))
        self.flow[low.entries["t"]] = low.tape.constant(1.0)
        guards = [mode.guard for mode in low.modes]
        self.guard_rates = self.along_the_flow(guards, 1)
        self.holding = holding(low, moving(low, self.guard_rates, self.flow))
        self._weights = weights(low.tape, guards)
        self.eager: dict[str, Routine] = {
            "rhs": _dense("Rates of the states.", low.rates),
            "outputs": _dense("Recorded signals.", outputs),
            "guards": _dense("Guards of the modes.", guards),
            "guard_sizes": _dense("Sizes of the guards.", sizes(low.tape, guards, self.states)),
            "guard_rates": _dense("Rates of the guards.", self.guard_rates),
            "timed": _dense(
                "Slope and value at t = 0 of each guard that reads only t.",
                [entry for mode in low.modes for entry in mode.timed or ()],
            ),
            "starts": _dense("Start values of the states.", low.starts),
            "delayed": _dense(
                "Signals that are read with a delay.", [d.signal for d in low.delays]
            ),
            "lags": _dense(
                "Delays, and the longest they may be.",
                [*(d.lag for d in low.delays), *(d.longest for d in low.delays)],
            ),
            "pace": _dense("Largest pace of the guards, and of what is held.", self._paces()),
            "resets": _dense(
                "New values of all resets, one after the other.",
                [entry for reset in low.resets for entry in reset.values.values()],
            ),
            "guard_weights": _dense(
                "Weights of the states in the guards that are straight, one after the other.",
                [entry for found in self._weights for entry in (found or {}).values()],
            ),
        }
        for routine in self.eager.values():
            self.constants.collect(routine.roots.values())
        n, number = self.states, self.modes
        every = [*low.states, low.entries["t"]]
        self.lazy: dict[str, tuple[int, Callable[[], Mapping[int, int]]]] = {
            "jacobian": (n * (n + 1), partial(self.rows, "rhs", every)),
            "guard_gradients": (number * n, partial(self.rows, "guards", low.states)),
            "guard_curves": (number * (n + 1), partial(self.rows, "guard_rates", every)),
        }
        for name, order in ORDERS.items():
            self.lazy[name] = number, partial(self._guards_along_the_flow, order)
        for name, of in SIZES.items():
            self.lazy[name] = self.size(of), partial(self._sizes, of)
        self._made: dict[str, Routine] = {}
        self._addresses: dict[str, int] = {}
        self._callbacks: dict[str, int] = {}
        # a tuple of names that was asked for, of how many compiled functions, and the answer
        self._last: tuple[Sequence[str], int, Addresses] = ((), -1, np.empty(0, dtype=np.int64))
        self._evaluated: dict[str, dict[str, Function]] = {}
        self._kept: list[Any] = []  # machine code and callbacks, which live as long as this does

    @cached_property
    def sizes(self) -> Sizes:
        """The lengths of the arrays."""
        size = {name: routine.size for name, routine in self.eager.items()}
        return Sizes(
            states=self.states,
            modes=self.modes,
            parameters=self.constants.parameters,
            constants=self.constants.size,
            outputs=size["outputs"],
            timed=size["timed"] // 2,
            resets=size["resets"],
        )

    def size(self, name: str) -> int:
        """The length of a function's `out`."""
        if name == PREPARE:
            return self.constants.size
        return self.eager[name].size if name in self.eager else self.lazy[name][0]

    def along_the_flow(self, entries: Sequence[int], order: int) -> list[int]:
        """The total derivatives of entries along the flow with frozen modes."""
        for _ in range(order):
            entries = differentiate(self.tape, entries, self.flow)
        return list(entries)

    def _guards_along_the_flow(self, order: int) -> dict[int, int]:
        rates = list(self.eager["guard_rates"].roots.values())
        return dict(enumerate(self.along_the_flow(rates, order - 1)))

    def _sizes(self, of: str) -> dict[int, int]:
        """The sizes of what a function computes."""
        roots = self.routine(of).roots
        entries = sizes(self.tape, list(roots.values()), self.states)
        return dict(zip(roots, entries, strict=True))

    def _paces(self) -> list[int]:
        """The largest pace of what is searched for zeros: of the guards, and of the fractions of
        slides and the forces of contacts while these hold. Steps that follow the states do not see
        how often a force turns that reads the cosine of a state."""
        low = self.lowered
        searched = [m.guard for m in low.modes if not m.timed and m.kind != "memory"]
        hit = sorted(
            {reset.trigger for reset in low.resets if may_rest(low, reset, self.guard_rates)}
        )
        forces = self.along_the_flow([self.guard_rates[i] for i in hit], 1)
        forces += [self.guard_rates[i] for i in sorted(self.holding)]
        return [pace(self.tape, entries, self.flow) for entries in (searched, forces)]

    @cached_property
    def watched_delays(self) -> frozenset[int]:
        """The numbers of the delays that are read by guards, or by what a slide may hold: steps
        follow these, where no state feels them."""
        low = self.lowered
        roots = [m.guard for m in low.modes if not m.timed and m.kind != "memory"]
        roots += [self.guard_rates[i] for i in self.holding]
        read = (self.tape.entries[index] for index in self.tape.needed(roots))
        return frozenset(int(entry.payload) for entry in read if entry.op == "history")

    def jump_orders(self) -> list[list[int]]:
        """Of each mode, and behind them each state: by how many orders of the derivative its jump
        is smoother in the signal of each delay."""
        low = self.lowered
        fractions = {low.modes[i].leaf: self.guard_rates[i] for i in self.holding}
        forces: dict[int, list[int]] = {}
        for reset in low.resets:
            if may_rest(low, reset, self.guard_rates):
                bends = self.along_the_flow([self.guard_rates[reset.trigger]], 1)
                for state in reset.values:
                    forces.setdefault(low.states[state], []).extend(bends)
        return jump_orders(low, fractions, forces)

    @property
    def straight(self) -> tuple[tuple[int, ...] | None, ...]:
        """Of each guard that is a sum of states times what only reads parameters, the states, in
        the order of the `guard_weights`; None of the others."""
        return tuple(None if found is None else tuple(found) for found in self._weights)

    @property
    def has_pace(self) -> tuple[bool, bool]:
        """Whether guards, and whether what is held, may turn faster than the states say: the two
        numbers of `pace` are not always 0."""
        guards, held = (self.tape.value(e) != 0.0 for e in self.eager["pace"].roots.values())
        return guards, held

    @property
    def reads_held(self) -> bool:
        """Whether a guard reads what a slide may hold: a friction that sticks has any force."""
        return reads(self.tape, [mode.guard for mode in self.lowered.modes], self.holding)

    def rows(self, of: str, leaves: Sequence[int]) -> dict[int, int]:
        """The entries of d out / d leaf of an eager function, row by row; zeros are left out."""
        routine, width = self.eager[of], len(leaves)
        columns = {leaf: column for column, leaf in enumerate(leaves)}
        found = gradients(self.tape, routine.roots.values(), leaves)
        return {
            row * width + columns[leaf]: entry
            for row, gradient in zip(routine.roots, found, strict=True)
            for leaf, entry in sorted(gradient.items())
        }

    def add_derivative(self, of: str, leaves: Sequence[int]) -> str:
        """The name of the lazy function d(out of an eager function) / d(leaves), row by row."""
        name = f"{of}.by.{'.'.join(map(str, leaves))}"
        with self.lock:
            self.add(name, self.size(of) * len(leaves), partial(self.rows, of, tuple(leaves)))
        return name

    def add(self, name: str, size: int, roots: Callable[[], Mapping[int, int]]) -> None:
        """A further lazy function: the length of its `out`, and what gives its roots by place."""
        self.lazy.setdefault(name, (size, roots))

    def routine(self, name: str) -> Routine:
        """What an eager or lazy function computes."""
        with self.lock:
            found = self.eager.get(name) or self._made.get(name)
            if found is None:
                size, roots = self.lazy[name]
                kept = {p: e for p, e in roots().items() if self.tape.value(e) != 0.0}
                found = self._made[name] = Routine(name.replace("_", " "), size, kept)
            return found

    @cached_property
    def usual_modes(self) -> Vector:
        """The values of the modes before a run has decided them, and behind them that none is
        held."""
        usual = [mode.at_zero for mode in self.lowered.modes]
        return np.array([*usual, *[0.0] * len(usual)], dtype=float)

    def constants_from(self, parameters: Sequence[float]) -> Vector:
        """What the model computes from its parameters alone, with room for the past of signals."""
        given = np.array([*parameters, 0.0])  # never empty
        out = np.zeros(max(1, self.sizes.constants))
        self._prepare(0.0, place_of(given), UNREAD, UNREAD, UNREAD, place_of(out))
        return out

    def starts(self, constants: Vector, tables: Vector) -> Vector:
        """The start states (n,) that the diagram has."""
        out, modes = np.zeros(self.states), place_of(self.usual_modes)
        self._starts(0.0, UNREAD, modes, place_of(constants), place_of(tables), place_of(out))
        return out

    # what Python calls; to make one takes longer than the call

    @cached_property
    def _prepare(self) -> Callable[..., None]:
        return FORWARD(self.address(PREPARE))

    @cached_property
    def _starts(self) -> Callable[..., None]:
        return FORWARD(self.address("starts"))

    def address(self, name: str) -> int:
        """The address of a function, good as long as this lives; of a lazy one that was never
        called, that of its callback.

            void f(double t, const double *x, const double *m, const double *c, const double *k,
                   double *out)

        x[n]: states. m[2*M]: the values of the modes, and behind them 1.0 for each guard that is
        held at zero. c: what `prepare` makes of the parameters, which it takes as x; behind these
        what is known of the past of delayed signals (see `past`), where there are any. k: the
        tables, k[j] is the offset of table j; there: count N, x[N], y[N], slope[N-1]. `out` is
        zeroed by the caller. Functions, with the length of out: prepare (C), rhs (n), outputs (R),
        guards (M), guard_rates (M), timed (2T), starts (n), resets, delayed (D: signals that are
        read with a delay), lags (2D: the delays, and the longest they may be), pace (2: of the
        guards, and while something is held), guard_weights (of the states in `straight`
        guards), and guard_sizes (M), as all `sizes` a function of x[2n]: states, and behind them
        their sizes; compiled when they are first called:
        jacobian (n*(n+1): d rate/d x, d rate/d t), guard_gradients (M*n), guard_curves
        (M*(n+1): gradient of the guard's rate, its change with t), guard_second, guard_third,
        guard_fourth (M: derivatives of the guards along the flow), and the sizes of these,
        guard_rate_sizes, guard_second_sizes, ..., and rate_sizes (n).
        """
        known = self._addresses.get(name)
        if known is not None:
            return known
        with self.lock:
            if name in self._addresses or name not in self.lazy:
                return self.compiled_address(name)
            if name not in self._callbacks:
                callback = when_called(partial(self.compiled_address, name), self.size(name))
                self._kept.append(callback)
                self._callbacks[name] = address_of(callback)
            return self._callbacks[name]

    def addresses(self, names: Sequence[str]) -> Addresses:
        """The addresses of several functions."""
        asked, compiled, found = self._last
        if asked is names and compiled == len(self._addresses):
            return found
        with self.lock:
            known, compiled = self._addresses, len(self._addresses)
            some = [known[name] if name in known else self.address(name) for name in names]
            found = np.array(some, dtype=np.int64)
            self._last = tuple(names), compiled, found
            return found

    def compiled_address(self, name: str) -> int:
        """The address of a function, compiled now where it has not been.

        For threads of compiled code: the callback behind the other address would wait for Python.
        """
        return self.compiled_addresses([name])[0]

    def compiled_addresses(self, names: Sequence[str]) -> list[int]:
        """The addresses of several functions; those that have not been are compiled together."""
        with self.lock:
            missing = [name for name in dict.fromkeys(names) if name not in self._addresses]
            if missing:
                make = self._callback if self.backend == "python" else self._machine
                lazy = [name for name in missing if name in self.lazy]
                eager = [] if len(lazy) == len(missing) else [PREPARE, *self.eager]
                self._addresses |= make([*eager, *lazy])
            return [self._addresses[name] for name in names]

    def machine_ir(self, names: Sequence[str]) -> str:
        """The LLVM IR of functions."""
        roots = {
            _symbol(name): None if name == PREPARE else self.routine(name).roots for name in names
        }
        return MachineWriter(self.tape, self.constants, self.modes).text(roots)

    def _machine(self, names: Sequence[str]) -> dict[str, int]:
        from tracewire.compile.native import assemble  # LLVM is loaded by those who compile

        symbols = [_symbol(name) for name in names]
        native = assemble(self.machine_ir(names), symbols, quickly=self.backend == "quick")
        self._kept.append(native)
        return {name: native.addresses[_symbol(name)] for name in names}

    def _callback(self, names: Sequence[str]) -> dict[str, int]:
        found = self.python(names)
        addresses = {}
        for name in names:
            if name == PREPARE:
                prepare = found[name]
                places: Sequence[int] = range(self.constants.size)
                callback = as_c(
                    lambda t, x, m, c, k, prepare=prepare: prepare(x),
                    places,
                    self.constants.parameters,
                    0,
                    0,
                )
            else:
                states = 2 * self.states if name.endswith("sizes") else self.states
                places = tuple(self.routine(name).roots)
                callback = as_c(found[name], places, states, self.modes, self.constants.size)
            self._kept.append(callback)
            addresses[name] = address_of(callback)
        return addresses

    def text(self, names: Sequence[str], careful: bool = False) -> str:
        """The Python text of functions; each returns what is not always 0, in order of place."""
        writer = Writer(self.tape, self.constants, self.labels, self.modes)
        parts = []
        for name in names:
            if name == PREPARE:
                parts.append(writer.prepare(careful))
            else:
                routine = self.routine(name)
                roots = list(routine.roots.values())
                parts.append(writer.function(_symbol(name), routine.doc, roots, careful))
        return "\n\n".join(parts)

    def python(self, names: Sequence[str]) -> dict[str, Function]:
        """The Python functions that are written in `text`, careful where the plain ones raise."""
        fast, careful = (load(self.text(names, c), c) for c in (False, True))
        return {name: guarded(fast[_symbol(name)], careful[_symbol(name)]) for name in names}

    def evaluate(
        self,
        name: str,
        t: float,
        x: Sequence[float],
        m: Sequence[float],
        p: Sequence[float],
        k: Sequence[float],
    ) -> tuple[float, ...]:
        """All values of a lazy function by its Python text, whatever the back end: for messages."""
        with self.lock:
            if name not in self._evaluated:
                self._evaluated[name] = self.python([PREPARE, name])
            found, routine = self._evaluated[name], self.routine(name)
        # numbers of numpy would warn where those of Python raise
        lists = [[float(value) for value in array] for array in (x, m, p, k)]
        count = self.constants.parameters
        constants = [*found[PREPARE](lists[2][:count])]
        constants[count : len(lists[2])] = lists[2][count:]  # where the past of delays is
        values = [0.0] * routine.size
        given = found[name](float(t), lists[0], lists[1], constants, lists[3])
        for place, value in zip(routine.roots, given, strict=True):
            values[place] = value
        return tuple(values)


def _symbol(name: str) -> str:
    return name.replace(".", "_")
