"""What a name or a path means in a diagram: signals, states, parameters, and their full names."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from tracewire.diagram.diagram import Array, BlockUse, Diagram, Value
from tracewire.formula import Name
from tracewire.library import Block, Event, Library

ROW_END = re.compile(r"(?<![\w.])([A-Za-z_]\w*)\.(first|last)(?!\w)", re.ASCII)
INDEX = re.compile(r"\s*\[\s*(\d+(?:\s*,\s*\d+)*)\s*\]$")


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


def split_index(name: str) -> tuple[str, tuple[int, ...]]:
    """The name of a vector or matrix and the index of an element, of `q[1]` or `M[0, 1]`.

    The index is empty where the name ends with none.
    """
    found = INDEX.search(name)
    if found is None:
        return name, ()
    return name[: found.start()], tuple(int(part) for part in found[1].split(","))


def element_name(name: str, index: Sequence[int]) -> str:
    """The full name of an element: `q[1]`, or `M[0,1]`; without an index the name itself."""
    return f"{name}[{','.join(map(str, index))}]" if index else name


def find_signal(diagram: Diagram, name: str) -> str | None:
    """The full name of a signal of this diagram (not of a subsystem's inside), or None.

    A block with one output is its own signal; the output of a subsystem is always `block.port`.
    Of a block whose type is not known any output is taken to exist. An index behind the name is
    kept as it is: how many elements a signal has is known when the diagram is compiled.
    """
    name, index = split_index(name)
    if index:
        vector = find_signal(diagram, name)
        return None if vector is None else element_name(vector, index)
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


def row_ends(diagram: Diagram, text: str) -> str:
    """A path or formula with the blocks in place of the ends of rows: chain.last.x is chain_9.x."""
    if ".first" not in text and ".last" not in text:
        return text
    lengths = Counter(use.row for use in diagram.blocks.values() if use.row)

    def block(found: re.Match[str]) -> str:
        row, end = found[1], found[2]
        return f"{row}_{1 if end == 'first' else lengths[row]}" if row in lengths else found[0]

    return ROW_END.sub(block, text)


def find_recorded(diagram: Diagram, path: str) -> str | None:
    """The full name of a signal or state by its path, which may lead into subsystems, or None."""
    path = row_ends(diagram, path)
    found = find_signal(diagram, path) or find_state(diagram, path)
    if found is not None:
        return found
    head, _, rest = path.partition(".")
    use = diagram.blocks.get(head)
    if use is None or use.subsystem is None or split_index(rest)[0] in use.subsystem.inputs:
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
    path, index = split_index(path)
    if index:
        vector = find_state(diagram, path)
        return None if vector is None else element_name(vector, index)
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


def find_event(diagram: Diagram, name: str) -> Event | None:
    """The event of a block by block.event, not of one inside a subsystem; None: there is none."""
    head, _, rest = name.partition(".")
    use = diagram.blocks.get(head)
    if use is None or use.subsystem is not None or use.type not in diagram.library:
        return None
    events = (event for event in diagram.library[use.type].events if event.name == rest)
    return next(events, None)


def events(diagram: Diagram) -> list[str]:
    """The events of the blocks of a diagram, each as one would write it."""
    library = diagram.library
    plain = [use for use in diagram.blocks.values() if use.subsystem is None]
    known = [use for use in plain if use.type in library]
    return [f"{use.name}.{event.name}" for use in known for event in library[use.type].events]


def own_states(diagram: Diagram) -> list[str]:
    """The states of the blocks of a diagram, not of its subsystems."""
    return [name for use in diagram.blocks.values() for name in _states_of(diagram, use)]


def states(diagram: Diagram) -> list[str]:
    """The full names of the states of a diagram and of its subsystems, one level down."""
    found: list[str] = []
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            found += [f"{use.name}.{name}" for name in own_states(use.subsystem)]
        else:
            found += _states_of(diagram, use)
    return found


def _states_of(diagram: Diagram, use: BlockUse) -> list[str]:
    if use.subsystem is not None or use.type not in diagram.library:
        return []
    return [*state_names(diagram.library[use.type], use.name).values()]


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
    if use.subsystem is None:
        return _named(use).get(rest)
    given = use.settings.get(rest)
    if rest in use.subsystem.parameters:
        return given if isinstance(given, Value) else use.subsystem.parameters[rest]
    return find_parameter(use.subsystem, rest)


def is_count(diagram: Diagram, path: str) -> bool:
    """Whether a parameter, by its path, says how many blocks there are."""
    head, _, rest = path.partition(".")
    if not rest:
        return head in diagram.counts
    inside = diagram.blocks[head].subsystem if head in diagram.blocks else None
    return inside is not None and is_count(inside, rest)


def parameters(diagram: Diagram) -> list[str]:
    """The parameters of a diagram, and those one level down."""
    found = list(diagram.parameters)
    for use in diagram.blocks.values():
        if use.subsystem is not None:
            found += [f"{use.name}.{name}" for name in use.subsystem.parameters]
        else:
            found += [f"{use.name}.{name}" for name in _named(use)]
    return found


def _named(use: BlockUse) -> dict[str, Value]:
    """The settings of a block that are parameters of their own; those in a list by their index."""
    found: dict[str, Value] = {}
    for name, given in use.settings.items():
        if isinstance(given, Value):
            found[name] = given
        elif isinstance(given, Array):
            found |= {element_name(name, (n,)): item for n, item in enumerate(given.items)}
    return {name: value for name, value in found.items() if value.named}
