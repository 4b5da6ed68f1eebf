"""Effects: what a trace may add to a diagram, of the library or of the diagram's own subsystems."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tracewire.diagram.diagram import Diagram
from tracewire.errors import FormulaError
from tracewire.formula import Expression, evaluate, parse
from tracewire.library import Block, Effect


@dataclass(frozen=True)
class EffectType:
    """A type of block that may be tried as a missing effect.

    name: the `type` by which a diagram uses it. ports: its inputs. parameters: the default of each
    parameter that is a number, in SI; None: it has none, and a trace must give it. output: what
    stands behind the name of a use in the name of its signal: nothing, or `.port`. One of block and
    subsystem is what the type stands for.
    """

    name: str
    effect: Effect
    ports: tuple[str, ...]
    parameters: Mapping[str, float | None]
    output: str = ""
    block: Block | None = field(default=None, compare=False)
    subsystem: Diagram | None = field(default=None, compare=False)


def effects_of(diagram: Diagram) -> list[EffectType]:
    """Every effect that may be added to a diagram: of its library, and subsystems that say so."""
    found = [_of_block(name, block) for name, block in diagram.library.effects().items()]
    return found + [
        _of_subsystem(name, inside, inside.effect)
        for name, inside in diagram.subsystems.items()
        if inside.effect is not None
    ]


def _of_block(name: str, block: Block) -> EffectType:
    if block.effect is None:
        raise AssertionError("the library's effects are blocks that have one")
    given: dict[str, Expression | float] = {}
    numbers = [p for p in block.parameters if p.kind == "number"]
    for parameter in numbers:
        default = parameter.default
        if default is not None:
            given[parameter.name] = parse(default) if isinstance(default, str) else default
    known = _worked_out(given)
    parameters = {p.name: known.get(p.name) for p in numbers}
    ports = tuple(port.name for port in block.inputs)
    return EffectType(name, block.effect, ports, parameters, block=block)


def _of_subsystem(name: str, inside: Diagram, effect: Effect) -> EffectType:
    factors = {key: value.factor for key, value in inside.parameters.items()}
    given = {key: value.formula for key, value in inside.parameters.items()}
    known = _worked_out(given, factors)
    parameters = {key: known.get(key) for key in inside.parameters}
    (port,) = inside.outputs
    return EffectType(
        name, effect, tuple(inside.inputs), parameters, output=f".{port}", subsystem=inside
    )


def _worked_out(
    given: Mapping[str, Expression | float], factors: Mapping[str, float] | None = None
) -> dict[str, float]:
    """The numbers of formulas that may read each other, in any order."""
    known: dict[str, float] = {}
    for _ in given:
        for name, formula in given.items():
            if name in known:
                continue
            try:
                value = formula if isinstance(formula, int | float) else evaluate(formula, known)
            except (KeyError, FormulaError):
                continue
            known[name] = float(value) * (factors or {}).get(name, 1.0)
    return known
