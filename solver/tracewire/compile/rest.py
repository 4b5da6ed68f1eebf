"""A model at rest and a model opened at its delays: what steady states and slopes are found with.

At a steady state a delayed signal is what the signal is. Beside it the delay is an input of its
own: how the rates change with that, and how the signal that goes in changes, says all of a small
motion.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from tracewire.compile.flat import Flat, FlatParameter
from tracewire.compile.loops import order_signals
from tracewire.compile.lower import lower
from tracewire.compile.model import Model
from tracewire.formula import DELAYS, Call, Expression, Name, Number


@dataclass(frozen=True)
class AtRest:
    """A model of which each delay gives its input at once, and one of which each is an input.

    `outputs` are the parameters of `opened` that stand for what the delays give; `signals` and
    `times`, of both models, what goes in and the delay times in s.
    """

    settled: Model
    opened: Model
    outputs: tuple[str, ...]
    signals: tuple[str, ...]
    times: tuple[str, ...]


def at_rest(model: Model) -> AtRest:
    """Both models of a model with delays.

    Raises DiagramError: what a delay kept apart is a loop without a solution at a steady state.
    """
    flat = model.flat
    delays: dict[tuple[Expression, ...], int] = {}

    def note(node: Expression) -> Expression:
        if isinstance(node, Call):
            for part in node.arguments:
                note(part)
            if node.function in DELAYS:
                delays.setdefault(node.arguments, len(delays))
        return node

    _mapped(flat, note)
    outputs = tuple(f"delay {number}" for number in range(len(delays)))
    signals = tuple(f"{name}, in" for name in outputs)
    times = tuple(f"{name}, time" for name in outputs)
    more: dict[str, Expression] = {}
    for arguments, number in delays.items():
        time = arguments[1]
        more |= {signals[number]: arguments[0], times[number]: time}
    flat = replace(flat, signals={**flat.signals, **more})

    def settled(node: Expression) -> Expression:
        return _without(node, lambda call: settled(call.arguments[0]))

    def opened(node: Expression) -> Expression:
        return _without(node, lambda call: Name(outputs[delays[call.arguments]]))

    zeros = {name: FlatParameter(name, Number(0.0)) for name in outputs}
    cut = replace(_mapped(flat, opened), parameters={**flat.parameters, **zeros})
    rest = _model(model, _mapped(flat, settled))
    return AtRest(rest, _model(model, cut), outputs, signals, times)


def _without(node: Expression, change: Callable[[Call], Expression]) -> Expression:
    """A formula with something else in place of each signal that it reads with a delay."""
    if not isinstance(node, Call):
        return node
    if node.function in DELAYS:
        return change(node)
    return Call(node.function, tuple(_without(part, change) for part in node.arguments))


def _mapped(flat: Flat, change: Callable[[Expression], Expression]) -> Flat:
    """Flat equations with each formula of a run changed."""

    def all_of(formulas: Mapping[str, Expression]) -> dict[str, Expression]:
        return {name: change(formula) for name, formula in formulas.items()}

    return replace(
        flat,
        signals=all_of(flat.signals),
        states=tuple(replace(state, rate=change(state.rate)) for state in flat.states),
        events=tuple(
            replace(event, when=change(event.when), set=all_of(event.set)) for event in flat.events
        ),
        memories=tuple(
            replace(
                memory,
                transitions=tuple(
                    replace(one, when=change(one.when), set=all_of(one.set))
                    for one in memory.transitions
                ),
            )
            for memory in flat.memories
        ),
    )


def _model(model: Model, flat: Flat) -> Model:
    places = {name: block.place for name, block in flat.blocks.items()}
    signals, loops = order_signals(flat.signals, flat.guesses, flat.blocks, places)
    flat = replace(flat, signals=signals, loops=loops)
    return replace(model, flat=flat, lowered=lower(flat))
