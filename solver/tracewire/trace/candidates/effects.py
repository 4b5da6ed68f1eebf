"""How large an effect is, and between which bounds its parameters may be."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from tracewire.compile import compile
from tracewire.diagram import BlockUse, Diagram, EffectType, InputPort, Value, Wire
from tracewire.errors import TracewireError
from tracewire.formula import Number, evaluate
from tracewire.trace.candidates.signal_scales import SignalScale


def bounds_of(kind: EffectType, parameter: str) -> tuple[float, float]:
    """The bounds in SI of a parameter of an effect."""
    if kind.subsystem is not None:
        return kind.subsystem.parameters[parameter].fit or (-math.inf, math.inf)
    known = {p.name: p for p in kind.block.parameters} if kind.block is not None else {}
    low, high = known[parameter].low, known[parameter].high
    return -math.inf if low is None else low, math.inf if high is None else high


def scale_of(
    kind: EffectType,
    inputs: Mapping[str, SignalScale],
    shapes: Mapping[str, Sequence[float]],
    size: float,
    at: float,
    duration: float,
    parts: Sequence[float],
) -> float:
    """The coefficient at which the output of an effect is about as large as `size`.

    The output of an effect without memory is looked at where its inputs have their usual size; of
    others the coefficient is taken to be a force. inputs: by port. duration: of the record in s.
    parts: of the root mean square of the inputs, where the output is looked at.
    """
    whole = size if size > 0 else 1.0
    if kind.block is not None and (kind.block.states or kind.block.modes):
        return whole
    numbers = {name: grid[len(grid) // 2] for name, grid in shapes.items()}
    numbers[kind.effect.coefficient] = at
    squares = []
    for part in parts:
        given = {port: part * scale.rms for port, scale in inputs.items()}
        given["t"] = abs(part) * duration / 2
        try:
            squares.append(_output(kind, numbers, given) ** 2)
        except (TracewireError, ArithmeticError, KeyError):
            continue
    found = math.sqrt(sum(squares) / len(squares)) / at if squares else 0.0
    return whole / found if math.isfinite(found) and found > 0 else whole


def _output(kind: EffectType, numbers: Mapping[str, float], given: Mapping[str, float]) -> float:
    """The output of an effect with these parameters, at inputs that are numbers.

    Raises KeyError, FormulaError: it depends on more than those, as on a state.
    """
    if kind.block is not None:
        defaults = {name: value for name, value in kind.parameters.items() if value is not None}
        (formula,) = kind.block.formulas.values()
        return float(evaluate(formula, {**defaults, **numbers, **given}))
    inside = kind.subsystem
    assert inside is not None
    at = "effect" + "_" * sum(port.startswith("effect") for port in inside.inputs)
    use = BlockUse(
        at,
        kind.name,
        {port: (Wire(port),) for port in inside.inputs},
        {name: Value(Number(value)) for name, value in numbers.items()},
        subsystem=inside,
    )
    model = compile(
        Diagram(
            name="effect",
            file=inside.file,
            text="",
            library=inside.library,
            inputs={port: InputPort(port, default=Value(Number(0.0))) for port in inside.inputs},
            blocks={at: use},
        )
    )
    known = dict(given)
    formulas = {**model.parameter_formulas(), **model.flat.signals}
    for name, formula in formulas.items():
        known[name] = float(evaluate(formula, known))
    return known[f"{at}{kind.output}"]
