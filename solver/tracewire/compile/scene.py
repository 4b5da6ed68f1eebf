"""What a scene reads of a model: numbers, each by the name under which a run records it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from tracewire.compile.vectors import element_names
from tracewire.diagram import Diagram, ScenePart, element_name, find_signal, split_index
from tracewire.errors import DiagramError, Problem
from tracewire.formula import CONSTANTS, Call, Expression, Name, Number, names_of, rename


def resolve_scene(
    diagram: Diagram, shapes: Mapping[str, tuple[int, ...]]
) -> tuple[tuple[ScenePart, ...], tuple[str, ...]]:
    """The parts of a diagram's scene with the full names of signals, and the signals they read.

    shapes: the vectors and matrices of the model. Raises DiagramError where a part reads one of
    them as a number, or an element that is not there.
    """
    problems: list[Problem] = []
    signals: dict[str, None] = {}

    def full(name: str) -> Expression:
        return Name(find_signal(diagram, name) or name)

    parts = []
    for part in diagram.scene:
        points = {
            key: (rename(_joined(x), full), rename(_joined(y), full))
            for key, (x, y) in part.points.items()
        }
        sizes = {key: rename(_joined(size), full) for key, size in part.sizes.items()}
        parts.append(replace(part, points=points, sizes=sizes))
        for name in names_of(Call("", tuple(parts[-1].formulas.values()))):
            if name in diagram.parameters or name in CONSTANTS or name == "t":
                continue
            signals[name] = None
            problem = _wrong(name, part, shapes)
            if problem is not None:
                problems.append(problem)
    if problems:
        raise DiagramError(problems)
    return tuple(parts), tuple(signals)


def _joined(formula: Expression) -> Expression:
    """The formula in which an element of a vector is a name: `q[1]`."""
    if not isinstance(formula, Call):
        return formula
    if formula.function != "[]":
        return Call(formula.function, tuple(map(_joined, formula.arguments)))
    vector, *index = formula.arguments
    assert isinstance(vector, Name)
    numbers = [int(i.value) for i in index if isinstance(i, Number)]
    return Name(element_name(vector.name, numbers))


def _wrong(name: str, part: ScenePart, shapes: Mapping[str, Sequence[int]]) -> Problem | None:
    """What is wrong with a signal of a part: it is a vector, or has no such element."""
    signal, index = split_index(name)
    shape = tuple(shapes.get(signal, ()))
    there = tuple(element_names(signal, shape))
    if name in there:
        return None
    what = f"'{signal}' has elements, and a {part.kind} is drawn from numbers"
    if index and shape:
        what = f"'{name}' is no element of '{signal}'"
    elif index:
        what = f"'{signal}' is a number, and has no elements"
    return Problem(what, part.place, there, "Name one of them.")
