"""The compiled model: flat equations as functions of time, states, modes and parameters."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from tracewire.compile.differentiate import differentiate
from tracewire.compile.flat import Flat
from tracewire.compile.flatten import flatten
from tracewire.compile.lower import Lowered, Mode, lower
from tracewire.compile.source import Function, Writer, guarded, load
from tracewire.diagram import Diagram, find_recorded
from tracewire.errors import OptionError, unknown
from tracewire.formula import to_text


@dataclass(frozen=True)
class Model:
    """A diagram compiled to a flat ODE with events; parameters and start values stay arguments.

    `functions` holds `rhs`, `guards`, `guard_rates`, `timed`, `outputs`, `starts` and `reset_N`;
    `source` is their Python text. What not every run needs is written when it is asked for.
    """

    diagram: Diagram
    flat: Flat
    lowered: Lowered
    recorded: tuple[str, ...]

    def __repr__(self) -> str:  # with its diagram and library it would fill many screens
        shown = f"states {', '.join(self.states) or 'none'}; {len(self.parameters)} parameters"
        return f"Model({self.flat.title!r}: {shown})"

    @property
    def states(self) -> tuple[str, ...]:
        """The names of the states, in the order of the state vector."""
        return tuple(state.name for state in self.flat.states)

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the parameters, in the order of the parameter vector."""
        return tuple(self.flat.parameters)

    @property
    def modes(self) -> Sequence[Mode]:
        """The modes of the model and their guards."""
        return self.lowered.modes

    @cached_property
    def equations(self) -> str:
        """The flat ODE with the user's names, one equation a line."""
        lines = [f"{name} = {to_text(formula)}" for name, formula in self.flat.signals.items()]
        lines += [f"{state.name}' = {to_text(state.rate)}" for state in self.flat.states]
        lines += [f"{state.name}(t0) = {to_text(state.start)}" for state in self.flat.states]
        for event in self.flat.events:
            sets = ", ".join(f"{name} := {to_text(value)}" for name, value in event.set.items())
            lines.append(f"when {to_text(event.when)} crosses {event.crosses}: {sets}")
        return "\n".join(lines)

    @cached_property
    def _roots(self) -> dict[str, tuple[str, list[int]]]:
        low = self.lowered
        tape = low.tape
        guards = [mode.guard for mode in low.modes]
        timed = [e for mode in low.modes for e in (mode.timed or ())]
        roots = {
            "rhs": ("Rates of the states.", low.rates),
            "outputs": ("Recorded signals.", [low.entries[name] for name in self.recorded]),
            "guards": ("Guards of the modes.", guards),
            "guard_rates": ("Rates of the guards.", differentiate(tape, guards, self._flow_seeds)),
            "timed": ("Slope and value at t = 0 of guards that read only t.", timed),
            "starts": ("Start values of the states.", low.starts),
        }
        for number, (_, _, values) in enumerate(low.resets):
            roots[f"reset_{number}"] = ("New values of a reset.", list(values.values()))
        return roots

    @cached_property
    def _labels(self) -> dict[int, str]:
        """Readable variable names for the entries that are signals."""
        labels: dict[int, str] = {}
        taken: set[str] = set()
        for name in self.flat.signals:
            label = "s_" + re.sub(r"\W", "_", name)
            entry = self.lowered.entries[name]
            computed = bool(self.lowered.tape.entries[entry].operands)
            if computed and entry not in labels and label not in taken:
                labels[entry] = label
                taken.add(label)
        return labels

    def _write(self, careful: bool) -> str:
        writer = Writer(self.lowered.tape, self._labels, self.parameters)
        texts = [
            writer.function(name, doc, roots, careful) for name, (doc, roots) in self._roots.items()
        ]
        return "\n\n".join([writer.prepare(careful), *texts])

    @cached_property
    def source(self) -> str:
        """The Python text of the model's functions."""
        return self._write(careful=False)

    def guard_derivative(self, mode: int, order: int) -> Function:
        """A derivative of a guard along the flow, of any order: (value,) of t, x, m, p, k."""

        def roots() -> list[int]:
            entry = self.lowered.modes[mode].guard
            for _ in range(order):
                entry = differentiate(self.lowered.tape, [entry], self._flow_seeds)[0]
            return [entry]

        return self._on_demand(("derivative", mode, order), roots)

    def guard_curve(self, mode: int) -> Function:
        """The gradient of a guard's rate in the states, and its change with t: of t, x, m, p, k."""

        def roots() -> list[int]:
            low = self.lowered
            rate = differentiate(low.tape, [low.modes[mode].guard], self._flow_seeds)
            return self._rows(rate, [*low.states, low.entries["t"]])

        return self._on_demand(("curve", mode), roots)

    @property
    def guard_gradients(self) -> Function:
        """The gradients of all guards in the states, row by row: of t, x, m, p, k."""
        guards = [mode.guard for mode in self.lowered.modes]
        return self._on_demand(("gradients",), lambda: self._rows(guards, self.lowered.states))

    @property
    def jacobian(self) -> Function:
        """d rate / d state and, at the end of each row, d rate / d t: of t, x, m, p, k."""
        low = self.lowered
        return self._on_demand(
            ("jacobian",), lambda: self._rows(low.rates, [*low.states, low.entries["t"]])
        )

    def _rows(self, roots: Sequence[int], leaves: Sequence[int]) -> list[int]:
        """The entries of d root / d leaf, row by row."""
        tape = self.lowered.tape
        columns = [differentiate(tape, roots, {leaf: tape.constant(1.0)}) for leaf in leaves]
        return [column[row] for row in range(len(roots)) for column in columns]

    def all_signals(
        self, t: float, x: object, m: object, p: object, k: object
    ) -> tuple[list[str], tuple[float, ...]]:
        """Every signal by name, in the order of computation: to find what went wrong."""
        names = [*self.flat.signals, *(f"{state.name}'" for state in self.flat.states)]
        low = self.lowered
        values = self._on_demand(
            ("signals",),
            lambda: [*(low.entries[name] for name in self.flat.signals), *low.rates],
        )
        return names, values(t, x, m, p, k)

    def _on_demand(self, key: tuple[object, ...], roots: Callable[[], list[int]]) -> Function:
        """A function that not every run needs, written when it is first asked for."""
        found = self._written.get(key)
        if found is None:
            entries, both = roots(), []
            for careful in (False, True):
                writer = Writer(self.lowered.tape, {}, self.parameters)
                text = writer.function("values", "Asked for.", entries, careful)
                both.append(load("\n\n".join([writer.prepare(careful), text]), careful))
            prepare, values = (guarded(*(made[n] for made in both)) for n in ("prepare", "values"))
            last: list[object] = [None, ()]  # the parameters, and the constants made of them

            def found(t: float, x: object, m: object, p: object, k: object) -> tuple[float, ...]:
                if last[0] is not p:
                    last[:] = p, prepare(p)
                return values(t, x, m, last[1], k)

            self._written[key] = found
        return found

    @cached_property
    def _written(self) -> dict[tuple[object, ...], Function]:
        return {}

    @cached_property
    def _flow_seeds(self) -> dict[int, int]:
        """The derivatives of the states and of t along the flow."""
        low = self.lowered
        return dict(zip(low.states, low.rates, strict=True)) | {
            low.entries["t"]: low.tape.constant(1.0)
        }

    @cached_property
    def functions(self) -> Mapping[str, Function]:
        """The model's functions, by name."""
        fast = load(self.source, careful=False)
        careful = load(self._write(careful=True), careful=True)
        names = ["prepare", *self._roots]
        return {name: guarded(fast[name], careful[name]) for name in names}


def compile(diagram: Diagram, record: Sequence[str] = ()) -> Model:
    """The model of a diagram.

    `record` names signals to record beside those of the diagram. Raises DiagramError: an algebraic
    loop, a start value that reads a signal; OptionError: a recorded signal that does not exist.
    """
    flat = flatten(diagram)
    lowered = lower(flat)
    known = [
        *(state.name for state in flat.states),
        *flat.signals,
        *flat.inputs,
        *flat.parameters,
        "t",
    ]
    found = {name: name if name in known else find_recorded(diagram, name) for name in record}
    problems = [unknown("signal", name, known) for name, full in found.items() if full is None]
    if problems:
        raise OptionError(problems)
    more = [full for full in found.values() if full is not None]
    return Model(diagram, flat, lowered, tuple(dict.fromkeys((*flat.record, *more))))
