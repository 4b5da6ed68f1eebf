"""The compiled model: flat equations as functions of time, states, modes and parameters."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property

from tracewire.arguments import checked
from tracewire.compile.differentiate import gradients
from tracewire.compile.flat import Flat
from tracewire.compile.flatten import flatten
from tracewire.compile.holding import modes_read
from tracewire.compile.lower import lower
from tracewire.compile.lowered import Lowered, Mode, Reset
from tracewire.compile.memory import describe_memories
from tracewire.compile.routines import BACKENDS, PREPARE, Backend, Routines
from tracewire.compile.scene import resolve_scene
from tracewire.compile.vectors import element_names
from tracewire.diagram import Diagram, ScenePart, find_recorded
from tracewire.errors import OptionError, unknown
from tracewire.formula import Expression, evaluation_order, names_of, to_text


@dataclass(frozen=True)
class Model:
    """A diagram compiled to a flat ODE with events; parameters and start values stay arguments.

    Its functions are `routines`, with C addresses, compiled when they are first asked for. `source`
    is the Python text of the same functions.
    """

    diagram: Diagram
    flat: Flat
    lowered: Lowered
    recorded: tuple[str, ...]
    scene: tuple[ScenePart, ...]
    """The parts of the scene of the diagram, over the signals by their full names."""
    read_by_scene: tuple[str, ...]
    """The signals that the scene reads: `record` of `compile` takes them."""
    backend: Backend

    def __repr__(self) -> str:  # with its diagram and library it would fill many screens
        shown = f"states {', '.join(self.states) or 'none'}; {len(self.parameters)} parameters"
        return f"Model({self.flat.title!r}: {shown})"

    def __getstate__(self) -> dict[str, object]:
        """What pickle keeps: the equations. Machine code is made where it is needed."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @cached_property
    def states(self) -> tuple[str, ...]:
        """The names of the states, in the order of the state vector."""
        return tuple(state.name for state in self.flat.states)

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names of the parameters, in the order of the parameter vector."""
        return tuple(self.flat.parameters)

    def parameter_formulas(self, preset: str = "") -> Mapping[str, Expression]:
        """The formula of each parameter, with a preset applied, each after those that it reads."""
        found = self._parameter_formulas.get(preset)
        if found is None:
            formulas = {name: parameter.formula for name, parameter in self.flat.parameters.items()}
            formulas |= self.flat.presets[preset] if preset else {}
            reads = {
                name: [read for read in names_of(formula) if read in formulas]
                for name, formula in formulas.items()
            }
            order = evaluation_order(reads)
            assert order is not None  # a diagram whose parameters need each other is not compiled
            found = {name: formulas[name] for name in order}
            self._parameter_formulas[preset] = found
        return found

    @cached_property
    def _parameter_formulas(self) -> dict[str, dict[str, Expression]]:
        return {}

    def users_unit(self, signal: str) -> tuple[str, float]:
        """The unit in which a user has a signal or an input, and its factor to SI: that of the
        measured files, else that in which figures show it, else the one in SI."""
        flat = self.flat
        unit, factor = self.diagram.users_unit(signal, "")
        if not unit and signal in flat.shown and flat.shown[signal].unit:
            return flat.shown[signal].unit, flat.shown[signal].factor
        return unit or flat.units.get(signal, ""), factor

    @cached_property
    def is_linear(self) -> bool:
        """Whether the rates are linear in the states at each time, with no event that reads a
        state."""
        low = self.lowered
        if low.resets or low.transitions or any(mode.timed is None for mode in low.modes):
            return False
        found = gradients(low.tape, low.rates, low.states)
        slopes = [entry for gradient in found for entry in gradient.values()]
        return "state" not in low.tape.leaves(slopes)

    @cached_property
    def compared_signals(self) -> tuple[int, ...]:
        """The signal of each mode as a number: modes of kind sign whose guards are the same, up to
        sign, have one. Empty where no mode compares."""
        entries, numbers = self.lowered.tape.entries, dict[tuple[int, ...], int]()
        if not any(mode.compares for mode in self.modes):
            return ()
        found = []
        for own, mode in enumerate(self.modes):
            entry = entries[guard := mode.guard]
            while entry.op == "neg":
                entry = entries[guard := entry.operands[0]]
            signal = tuple(sorted(entry.operands)) if entry.op == "-" else (guard,)
            if mode.kind != "sign":
                signal = (-1, own)
            found.append(numbers.setdefault(signal, len(numbers)))
        return tuple(found)

    @cached_property
    def shared_triggers(self) -> dict[int, list[Reset]]:
        """The resets of each mode that triggers more than one, in their order."""
        found: dict[int, list[Reset]] = {}
        for reset in self.lowered.resets:
            found.setdefault(reset.trigger, []).append(reset)
        return {mode: resets for mode, resets in found.items() if mode >= 0 and len(resets) > 1}

    @cached_property
    def only_triggers(self) -> frozenset[int]:
        """The numbers of the modes that do nothing but trigger events."""
        low = self.lowered
        roots = [*low.rates, *low.entries.values(), *(mode.guard for mode in low.modes)]
        roots += [entry for reset in low.resets for entry in reset.values.values()]
        roots += [delay.signal for delay in low.delays]
        read = modes_read(low.tape, roots) | {move.trigger for move in low.transitions}
        return frozenset({reset.trigger for reset in low.resets if reset.trigger >= 0} - read)

    @cached_property
    def read_parameters(self) -> frozenset[str]:
        """The parameters that the model's functions read, and not only formulas of others."""
        low = self.lowered
        roots = [*low.rates, *low.starts, *(mode.guard for mode in low.modes)]
        roots += [entry for reset in low.resets for entry in reset.values.values()]
        roots += [low.entries[name] for name in self.recorded]
        roots += [delay.signal for delay in low.delays]
        read = set(low.tape.needed(roots))
        return frozenset(name for name in self.parameters if low.entries[name] in read)

    @property
    def reads_past(self) -> bool:
        """Whether a signal is read as it was some time ago."""
        return bool(self.lowered.delays) or self.lowered.shifts

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
        return "\n".join([*lines, *describe_memories(self.flat)])

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

    @cached_property
    def routines(self) -> Routines:
        """The functions of the model: their addresses, and the lengths of their arrays."""
        outputs = [self.lowered.entries[name] for name in self.recorded]
        return Routines(self.lowered, outputs, self._labels, self.backend)

    @cached_property
    def source(self) -> str:
        """The Python text of the model's functions."""
        return self.routines.text([PREPARE, *self.routines.eager])

    def derivative(self, of: str, by: Sequence[str]) -> str:
        """The name of the function d(function `of`) / d(`by`), for `routines`.

        of: a function that is no derivative itself (`rhs`, `guards`, `starts`, ...). by: names of
        states, parameters, or `t`; behind them come what each delayed signal was, and its rates.
        out: [length of `of`, number of these], row by row; modes are frozen.
        """
        leaves = [self.lowered.entries[name] for name in by]
        for op in ("history", "history_rate"):
            delays = range(len(self.lowered.delays))
            leaves += [self.lowered.tape.push(op, payload=number) for number in delays]
        return self.routines.add_derivative(of, leaves)

    def all_signals(
        self,
        t: float,
        x: Sequence[float],
        m: Sequence[float],
        p: Sequence[float],
        k: Sequence[float],
    ) -> tuple[list[str], tuple[float, ...]]:
        """Every signal by name, in the order of computation: to find what went wrong.

        The arguments are those of the C functions, with the parameters p for the constants; behind
        them what is known of the past of delayed signals, where there are any.
        """
        names = [*self.flat.signals, *(f"{state.name}'" for state in self.flat.states)]
        low = self.lowered
        entries = [*(low.entries[name] for name in self.flat.signals), *low.rates]
        self.routines.add("signals", len(entries), lambda: dict(enumerate(entries)))
        return names, self.routines.evaluate("signals", t, x, m, p, k)


@checked
def compile(diagram: Diagram, record: Sequence[str] = (), backend: Backend = "llvm") -> Model:
    """The model of a diagram.

    `record` names signals to record beside those of the diagram. `backend` makes the functions:
    "llvm" machine code, "quick" such that takes less time to make and more to run, for a model of a
    few short runs, "python" the readable source. Raises DiagramError: an algebraic loop
    without a solution, vectors that do not go together, a start value that reads a signal, a scene
    that reads a vector as a number;
    OptionError: a recorded signal or a back end that does not exist.
    """
    if backend not in BACKENDS:
        raise OptionError([unknown("backend", backend, BACKENDS)])
    flat = flatten(diagram)
    scene, read_by_scene = resolve_scene(diagram, flat.shapes)
    lowered = lower(flat)
    known = [
        *(state.name for state in flat.states),
        *flat.signals,
        *flat.inputs,
        *flat.parameters,
        "t",
    ]
    found = {name: name if name in known else find_recorded(diagram, name) for name in record}
    more = {n: element_names(f, flat.shapes.get(f, ())) for n, f in found.items() if f is not None}
    there = set(known)
    wrong = [name for name in record if name not in more or not there.issuperset(more[name])]
    if wrong:
        raise OptionError([unknown("signal", name, known) for name in dict.fromkeys(wrong)])
    names = (*flat.record, *(element for elements in more.values() for element in elements))
    recorded = tuple(dict.fromkeys(names))
    return Model(diagram, flat, lowered, recorded, scene, read_by_scene, backend)
