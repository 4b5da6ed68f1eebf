"""What a name or a path means in a diagram: signals, states, parameters, and their full names."""

from __future__ import annotations

from tracewire.diagram.diagram import BlockUse, Diagram, Value
from tracewire.formula import Name
from tracewire.library import Block, Library


def outputs_of(use: BlockUse, library: Library) -> tuple[str, ...] | None:
    """The outputs of a block; None where its type is not known."""
    if use.subsystem is not None:
        return tuple(use.subsystem.outputs)
    if use.type in library:
        return tuple(output.name for output in library[use.type].outputs)
    return None


def signals(diagram: Diagram) -> list[str]:
    """The signals that are visible in a diagram, each as one would write it."""
    found = list(diagram.inputs)
    for use in diagram.blocks.values():
        outputs = outputs_of(use, diagram.library) or ("",)
        found += [use.name] if len(outputs) == 1 else [f"{use.name}.{port}" for port in outputs]
    return found


def find_signal(diagram: Diagram, name: str) -> str | None:
    """The full name of a signal of this diagram (not of a subsystem's inside), or None.

    A block with one output is its own signal; the output of a subsystem is always `block.port`.
    Of a block whose type is not known any output is taken to exist.
    """
    if name in diagram.inputs:
        return name
    head, _, port = name.partition(".")
    use = diagram.blocks.get(head)
    if use is None:
        return None
    outputs = outputs_of(use, diagram.library)
    if outputs is None:
        return name
    if not port and len(outputs) == 1:
        port = outputs[0]
    if port not in outputs:
        return None
    return head if use.subsystem is None and len(outputs) == 1 else f"{head}.{port}"


def find_recorded(diagram: Diagram, path: str) -> str | None:
    """The full name of a signal or state by its path, which may lead into subsystems, or None."""
    found = find_signal(diagram, path) or find_state(diagram, path)
    if found is not None:
        return found
    head, _, rest = path.partition(".")
    use = diagram.blocks.get(head)
    if use is None or use.subsystem is None or rest in use.subsystem.inputs:
        return None
    inner = find_recorded(use.subsystem, rest) if rest else None
    return None if inner is None else f"{head}.{inner}"


def recordable(diagram: Diagram) -> list[str]:
    """The signals of a diagram, and those one level down."""
    found = signals(diagram)
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            inner = [s for s in signals(use.subsystem) if s not in use.subsystem.inputs]
            found += [f"{use.name}.{name}" for name in inner]
    return found


def state_names(block: Block, path: str) -> dict[str, str]:
    """Full names of a block's states; a single state that is the output has the block's name."""
    if len(block.states) == 1 and len(block.outputs) == 1:
        state = block.states[0].name
        if block.formulas[block.outputs[0].name] == Name(state):
            return {state: path}
    return {state.name: f"{path}.{state.name}" for state in block.states}


def find_state(diagram: Diagram, path: str) -> str | None:
    """The full name of a state, given as its block (where that has one state) or block.state.

    The path may lead into subsystems. None: there is no such state.
    """
    head, _, rest = path.partition(".")
    use = diagram.blocks.get(head)
    if use is None:
        return None
    if use.subsystem is not None:
        inner = find_state(use.subsystem, rest) if rest else None
        return None if inner is None else f"{head}.{inner}"
    if use.type not in diagram.library:
        return path
    names = state_names(diagram.library[use.type], head)
    if not rest and len(names) == 1:
        return next(iter(names.values()))
    return names.get(rest)


def states(diagram: Diagram) -> list[str]:
    """The full names of the states of a diagram and of its subsystems, one level down."""
    found: list[str] = []
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            found += [f"{use.name}.{name}" for name in _own_states(use.subsystem)]
        else:
            found += _own_states(diagram, use)
    return found


def _own_states(diagram: Diagram, *some: BlockUse) -> list[str]:
    uses = some or diagram.blocks.values()
    known = [use for use in uses if use.subsystem is None and use.type in diagram.library]
    return [n for use in known for n in state_names(diagram.library[use.type], use.name).values()]


def find_parameter(diagram: Diagram, path: str) -> Value | None:
    """The value of a parameter by its path, or None.

    A parameter is one of the diagram, one of a subsystem's use (`bearing.slip`; what the use gives
    goes before the definition), or a setting of a block written as a mapping (`drag.c`).
    """
    head, _, rest = path.partition(".")
    if not rest:
        return diagram.parameters.get(head)
    use = diagram.blocks.get(head)
    if use is None:
        return None
    given = use.settings.get(rest)
    if use.subsystem is None:
        return given if isinstance(given, Value) and given.named else None
    if rest in use.subsystem.parameters:
        return given if isinstance(given, Value) else use.subsystem.parameters[rest]
    return find_parameter(use.subsystem, rest)


def parameters(diagram: Diagram) -> list[str]:
    """The parameters of a diagram, and those one level down."""
    found = list(diagram.parameters)
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            found += [f"{use.name}.{name}" for name in use.subsystem.parameters]
        else:
            named = [n for n, v in use.settings.items() if isinstance(v, Value) and v.named]
            found += [f"{use.name}.{name}" for name in named]
    return found
