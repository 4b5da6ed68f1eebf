"""Where the value of a parameter of a run is written: in which body, and there in which line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tracewire.diagram.choose import NUMBER, is_chosen
from tracewire.diagram.diagram import BlockUse, Diagram, Value
from tracewire.diagram.names import find_parameter, parameters, split_index
from tracewire.errors import Location, OptionError, unknown
from tracewire.formula import read_unit, to_text


@dataclass(frozen=True)
class Written:
    """A value: a parameter of a body, or where there is a `use` a setting of that block in it.

    is_shared: the setting does not stand there yet, because the block has the value of a definition
    that other blocks share.
    """

    body: Diagram
    use: BlockUse | None
    name: str
    value: Value
    is_shared: bool = False

    @property
    def factor(self) -> float:
        """The factor to SI of a number that takes the place of the value, which may be a formula:
        that is in SI, whatever its unit."""
        return read_unit(self.value.written or self.value.unit).factor


def find_written(
    top: Diagram,
    path: str,
    uses: Mapping[Location, int],
    bodies_with: Callable[[Diagram, BlockUse, str], int],
) -> Written:
    """Where the parameter of a path is written. Raises OptionError: nowhere, or not for one block.

    uses: how many parts of the diagram each definition is (`count_uses`). bodies_with: how many
    bodies of a subsystem, of which a parameter chooses one, have the very parameter of a block.
    """
    value = find_parameter(top, path)
    if value is None:
        raise OptionError([unknown("parameter", path, parameters(top))])
    inside, rest = top, path
    while "." in rest:
        head, _, rest = rest.partition(".")
        use = inside.blocks[head]
        if use.row and rest.partition(".")[0] not in getattr(use.subsystem, "blocks", ()):
            what = f"'{path}' belongs to a block of the row '{use.row}', which have one line"
            hint = "Make it a parameter of the diagram, and name that in the line."
            raise OptionError.one(what, use.place, hint=hint)
        given = use.settings.get(rest)
        if isinstance(given, Value) and (rest == NUMBER or is_chosen(inside)):
            what = f"'{path}' is given by the parameter '{to_text(given.formula)}'"
            raise OptionError.one(what, use.place, hint="Change that one.")
        own = rest if use.subsystem is not None else split_index(rest)[0]
        if own in use.settings:
            return Written(inside, use, rest, value)
        assert use.subsystem is not None
        is_shared = uses[use.subsystem.place] > 1
        if is_chosen(inside):  # the line of a body stands in no text
            is_shared = uses[inside.place] > 1 or bodies_with(inside, use, rest) > 1
        if rest in use.subsystem.parameters and not (is_shared and is_chosen(inside)):
            if is_shared:
                return Written(inside, use, rest, value, is_shared=True)
            return Written(use.subsystem, None, rest, value)
        if is_shared:
            what = f"'{path}' stands in '{use.type}', which several blocks are"
            hint = f"Make it a parameter of '{use.type}'."
            raise OptionError.one(what, use.subsystem.place, hint=hint)
        inside = use.subsystem
    return Written(inside, None, rest, value)


def count_uses(top: Diagram) -> tuple[dict[Location, int], dict[Location, Diagram]]:
    """How many parts of the whole diagram are made from each definition, and one of them."""
    inner_first: dict[Location, Diagram] = {}

    def visit(diagram: Diagram) -> None:
        for use in diagram.blocks.values():
            if use.subsystem is not None and use.subsystem.place not in inner_first:
                visit(use.subsystem)
        inner_first[diagram.place] = diagram

    visit(top)
    counts = dict.fromkeys(inner_first, 0) | {top.place: 1}
    for diagram in reversed(inner_first.values()):
        for use in diagram.blocks.values():
            if use.subsystem is not None:
                counts[use.subsystem.place] += counts[diagram.place]
    return counts, inner_first
