"""Probes: a diagram whose places take small test signals, for the linearisation along a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tracewire.diagram import BlockUse, Diagram, InputPort, Value, Wire, rewired, with_addend
from tracewire.formula import Call, Expression, Name, Number
from tracewire.trace.candidates.places import Place


def add_probes(
    diagram: Diagram, places: Sequence[Place], hats: int
) -> tuple[Diagram, tuple[tuple[str, ...], ...]]:
    """The diagram with sum_j p_j*h_j added at each sum and drive place, and the names p_j by place.

    h_j are `hats` new inputs with the default 0, shared by all places; p_j are new parameters with
    the value 0, so that a run is that of the diagram, and its sensitivities to p_j are its answers
    to h_j at the place. What is added at a drive is seen by all that read it, but by no record of
    it. A sensor gets none: its tuple is empty. The diagram is made without a text: it is to be
    compiled, not edited.
    """
    taken = {*diagram.inputs, *diagram.parameters, *diagram.blocks, *diagram.subsystems}
    prefix = "probe"
    while any(name.startswith(prefix) for name in taken):
        prefix += "_"
    inputs = [f"{prefix}_input_{number}" for number in range(hats)]
    zero = Value(Number(0.0))
    diagram = replace(
        diagram,
        inputs={**diagram.inputs, **{name: InputPort(name, default=zero) for name in inputs}},
    )
    names: list[tuple[str, ...]] = []
    for number, place in enumerate(places):
        if place.kind == "sensor":
            names.append(())
            continue
        parameters = tuple(f"{prefix}_{number}_{hat}" for hat in range(hats))
        names.append(parameters)
        diagram = replace(
            diagram, parameters={**diagram.parameters, **dict.fromkeys(parameters, zero)}
        )
        terms = [
            Call("*", (Name(parameter), Name(name)))
            for parameter, name in zip(parameters, inputs, strict=True)
        ]
        diagram = _add_formula(diagram, place, f"{prefix}_{number}", _total(terms))
    return diagram, tuple(names)


def _add_formula(diagram: Diagram, place: Place, name: str, formula: Expression) -> Diagram:
    """The diagram with a formula added at a place."""
    if place.kind == "drive":
        formula = Call("+", (Name(place.definition), formula))
        diagram = rewired(diagram, place.definition, name)
    else:
        if place.element is not None:
            number, count = place.element
            nothing = Number(0.0)
            parts = (formula if n == number else nothing for n in range(count))
            formula = Call("stack", tuple(parts))
        within = place.within.split(".") if place.within else []
        diagram = _lead_in(diagram, within, place.definition.rpartition(".")[2], name)
    probe = BlockUse(name, "expression", {}, {"formula": formula})
    return replace(diagram, blocks={**diagram.blocks, name: probe})


def _lead_in(diagram: Diagram, within: Sequence[str], sum_name: str, signal: str) -> Diagram:
    """The diagram with one more signal in a sum, through an input of each subsystem around it."""
    if not within:
        return with_addend(diagram, sum_name, Wire(signal))
    use = diagram.blocks[within[0]]
    assert use.subsystem is not None
    port = InputPort(signal, default=Value(Number(0.0)))
    inside = replace(use.subsystem, inputs={**use.subsystem.inputs, signal: port})
    inside = _lead_in(inside, within[1:], sum_name, signal)
    use = replace(use, subsystem=inside, inputs={**use.inputs, signal: (Wire(signal),)})
    return replace(diagram, blocks={**diagram.blocks, within[0]: use})


def _total(terms: Sequence[Expression]) -> Expression:
    """The sum of the terms, added by halves: a formula may not nest deep."""
    if not terms:
        return Number(0.0)
    if len(terms) == 1:
        return terms[0]
    middle = len(terms) // 2
    return Call("+", (_total(terms[:middle]), _total(terms[middle:])))
