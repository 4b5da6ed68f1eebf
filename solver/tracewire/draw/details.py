"""What a picture says in words: settings inside of blocks, tooltips, and the notes on events."""

from __future__ import annotations

from tracewire.diagram import Array, BlockUse, Event, InputPort, Points, Value
from tracewire.formula import Call, Expression, Number, to_text
from tracewire.library import Block

ARROW = {"up": "rises through 0", "down": "falls through 0", "both": "crosses 0"}
SIGNS = {"<", "<=", ">", ">=", "and", "or", "not"}


def settings_text(use: BlockUse) -> dict[str, str]:
    """The settings of a block as they are written, without units."""
    return {name: _setting(value) for name, value in use.settings.items()}


def _setting(value: Value | Array | Points | Expression) -> str:
    if isinstance(value, Value):
        return value_text(value)
    if isinstance(value, Array):
        return f"[{', '.join(map(value_text, value.items))}]"
    if isinstance(value, Points):
        return f"{len(value.x)} points"
    return to_text(value)


def value_text(value: Value) -> str:
    """A value as a formula; a number is in SI."""
    if isinstance(value.formula, Number):
        return f"{value.formula.value * value.factor:.6g}"
    return to_text(value.formula)


def details_of(use: BlockUse, block: Block | None) -> tuple[str, ...]:
    """The lines of a block's tooltip: name and type, what it is, its settings, its unit."""
    lines = [f"{use.name}: {use.type}"]
    if block is not None:
        lines.append(block.doc)
    elif use.subsystem is not None and use.subsystem.title:
        lines.append(use.subsystem.title)
    for name, value in use.settings.items():
        unit = f" {value.unit}" if isinstance(value, Value) and value.unit else ""
        lines.append(f"{name} = {_setting(value)}{unit}")
    if use.unit:
        lines.append(f"unit: {use.shown.unit or use.unit}")
    return tuple(lines)


def input_details(port: InputPort) -> tuple[str, ...]:
    """The lines of the tooltip of an input."""
    lines = [f"{port.name}: an input of the diagram"]
    if port.unit:
        lines.append(f"unit: {port.shown.unit or port.unit}")
    if port.default is not None:
        lines.append(f"default = {value_text(port.default)}")
    return tuple(lines)


def event_text(event: Event) -> str:
    """An event in a line: when it happens, and what it sets."""
    if event.every is not None:
        when = f"every {value_text(event.every)} s"
    elif event.when is None:
        when = "event"
    elif isinstance(event.when, Call):
        compares = event.when.function in SIGNS
        when = f"when {to_text(event.when)}" + ("" if compares else f" {ARROW[event.crosses]}")
    elif "." in to_text(event.when):  # the event of a block
        when = f"at {to_text(event.when)}"
    else:
        when = f"when {to_text(event.when)} {ARROW[event.crosses]}"
    values = ", ".join(f"{name} := {to_text(formula)}" for name, formula in event.set.items())
    return f"{when}: {values}" if values else when
