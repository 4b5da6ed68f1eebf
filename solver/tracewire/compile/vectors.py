"""Vector signals: their shapes are found, and their equations become equations of numbers.

Every formula works element by element. A single number goes with every element; two vectors must
have the same length. `stack` (a list in the file) makes a vector of numbers and a matrix of
vectors, `join` puts numbers and vectors end to end, `[]` takes an element, `dot` multiplies and
`solve` solves; `realise` has what linear systems need. A name has the shape of its formula; a state
that of its start or of its rate.
"""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import product

from tracewire.compile.elements import Elements, Mismatch, Shape, shape_text
from tracewire.compile.realise import REALISED
from tracewire.diagram import element_name
from tracewire.formula import FUNCTIONS, Call, Expression, Name, Number, calls_in, names_of, to_text

SHAPED = ("stack", "join", "[]", "dot", "solve", *REALISED)


class Unknown(Exception):
    """A shape that is not known yet."""


def _is_list(formula: Expression) -> bool:
    return isinstance(formula, Call) and formula.function in ("stack", "join", "solve")


def has_vectors(formula: Expression) -> bool:
    """Whether a formula has a part that only vectors need."""
    return any(call.function in SHAPED for call in calls_in(formula))


def element_names(name: str, shape: Shape) -> list[str]:
    """The names of the elements of a signal: `q[0]`, `q[1]`, ...; of a number its own name."""
    return [element_name(name, index) for index in product(*map(range, shape))]


def find_shapes(
    formulas: Mapping[str, Sequence[Expression]], failed: set[str] | None = None
) -> dict[str, Shape]:
    """The shapes of the names that are vectors or matrices.

    formulas: for each name those that give it its shape. Where names only depend on each other, the
    first of them that is no list is a number. Names whose formulas are wrong, and not only what
    they read, are added to `failed`.
    """
    shapes: dict[str, Shape] = {}
    unknown = dict.fromkeys(sorted(formulas, key=lambda name: any(map(_is_list, formulas[name]))))
    expansion = Expansion(shapes, unknown)
    readers: defaultdict[str, list[str]] = defaultdict(list)
    for name, given in formulas.items():
        for read in {read for formula in given for read in names_of(formula)}:
            readers[read].append(name)
    due = deque(formulas)
    while unknown:
        stuck = not due  # what is left only depends on what is left
        name = next(iter(unknown)) if stuck else due.popleft()
        if name not in unknown:
            continue
        try:
            found = expansion.expand(Call("same", tuple(formulas[name]))).shape
        except Mismatch:
            right = _by_one(formulas[name], expansion)
            found = right or ()
            others = {read for formula in formulas[name] for read in names_of(formula)} - {name}
            if right is None and failed is not None and not failed & others:
                failed.add(name)
        except Unknown:
            if not stuck:
                continue
            found = ()
        del unknown[name]
        if found:
            shapes[name] = found
        due.extend(readers[name])
    return shapes


def _by_one(formulas: Sequence[Expression], expansion: Expansion) -> Shape | None:
    """The shape that the first of several formulas gives that is right by itself."""
    for formula in formulas:
        with suppress(Mismatch, Unknown):
            return expansion.expand(formula).shape
    return None


class Expansion:
    """Turns formulas of vectors into formulas of their elements."""

    def __init__(self, shapes: Mapping[str, Shape], unknown: Collection[str] = ()) -> None:
        self.shapes, self.unknown = shapes, unknown

    def expand(self, formula: Expression) -> Elements:
        """The elements of a formula. Raises Mismatch; Unknown where it reads what is unknown."""
        if isinstance(formula, Name) and formula.name in self.unknown:
            raise Unknown
        if isinstance(formula, Name) and formula.name in self.shapes:
            shape = self.shapes[formula.name]
            return Elements(shape, tuple(map(Name, element_names(formula.name, shape))))
        if not isinstance(formula, Call):
            return Elements((), (formula,))
        function, given = formula.function, formula.arguments
        if function == "[]":
            return _element(formula, self.expand(given[0]), given[1:])
        if function in FUNCTIONS and FUNCTIONS[function].reads == "points":
            inner = self.expand(given[0])
            return Elements(inner.shape, tuple(Call(function, (i, given[1])) for i in inner.items))
        special: dict[str, Callable[[Sequence[Elements], str], Elements]]
        special = {"stack": _stacked, "join": _joined, "dot": _dotted, "solve": _solved}
        special |= REALISED
        parts, missing = self.known(given)
        if missing and function in special:
            return self.foreseen(function, given, parts)
        if function in special:
            return special[function](parts, to_text(formula))
        shape = _common(parts, formula)
        if missing and not shape:
            raise Unknown
        if missing:
            return Elements(shape, (Number(0.0),) * math.prod(shape))
        if not shape:
            return Elements((), (Call(function, tuple(part.items[0] for part in parts)),))
        count = math.prod(shape)
        items = (Call(function, tuple(part.at(i) for part in parts)) for i in range(count))
        return Elements(shape, tuple(items))

    def foreseen(
        self, function: str, given: Sequence[Expression], parts: Sequence[Elements]
    ) -> Elements:
        """What can be said of a list, or of a system, of which some parts are not known."""
        if function == "stack" and parts:
            shape = (len(given), *parts[0].shape)
        elif function == "solve":
            shape = self.expand(given[0]).shape[:1]
        elif function == "matrix_times":
            shape = self.expand(given[0]).shape[:-1]
        else:
            raise Unknown
        return Elements(shape, (Number(0.0),) * math.prod(shape))

    def known(self, given: Sequence[Expression]) -> tuple[list[Elements], bool]:
        """Those of the formulas whose shape is known, and whether others are not."""
        parts = []
        for argument in given:
            with suppress(Unknown):
                parts.append(self.expand(argument))
        return parts, len(parts) < len(given)


def _common(parts: Sequence[Elements], formula: Expression) -> Shape:
    """The shape of parts that go together element by element."""
    shapes = dict.fromkeys(part.shape for part in parts if part.shape)
    if len(shapes) > 1:
        shown = " and ".join(map(shape_text, shapes))
        raise Mismatch(f"{shown} do not go together in '{to_text(formula)}'")
    return next(iter(shapes), ())


def _element(formula: Call, vector: Elements, indices: Sequence[Expression]) -> Elements:
    name = to_text(formula.arguments[0])
    numbers = [int(i.value) for i in indices if isinstance(i, Number) and i.value == int(i.value)]
    if len(numbers) < len(indices):
        raise Mismatch(f"the index in '{to_text(formula)}' is no whole number that is written down")
    if len(numbers) > len(vector.shape):
        shown = ", ".join(map(str, numbers))
        raise Mismatch(f"'{name}' is {shape_text(vector.shape)}, and has no element [{shown}]")
    for number, length in zip(numbers, vector.shape, strict=False):
        if not 0 <= number < length:
            what = f"'{name}' is {shape_text(vector.shape)}, and has no element [{number}]"
            raise Mismatch(f"{what}: they are counted from 0 to {length - 1}")
    rest = vector.shape[len(numbers) :]
    size = math.prod(rest)
    position = 0
    for number, length in zip(numbers, vector.shape, strict=False):
        position = position * length + number
    return Elements(rest, vector.items[position * size : (position + 1) * size])


def _stacked(parts: Sequence[Elements], text: str) -> Elements:
    shapes = dict.fromkeys(part.shape for part in parts)
    if len(shapes) > 1 or len(parts[0].shape) > 1:
        shown = " and ".join(map(shape_text, shapes))
        raise Mismatch(f"a list holds numbers, or vectors of one length, and not {shown}: '{text}'")
    items = tuple(item for part in parts for item in part.items)
    return Elements((len(parts), *parts[0].shape), items)


def _joined(parts: Sequence[Elements], text: str) -> Elements:
    matrix = next((part.shape for part in parts if len(part.shape) > 1), None)
    if matrix is not None:
        raise Mismatch(f"numbers and vectors are put end to end, and not {shape_text(matrix)}")
    items = tuple(item for part in parts for item in part.items)
    return Elements((len(items),), items)


def _dotted(parts: Sequence[Elements], text: str) -> Elements:
    a, b = parts
    if not a.shape and b.shape:
        a, b = b, a
    if not a.shape:
        return Elements((), (Call("*", (a.items[0], b.items[0])),))
    length = a.shape[-1]
    if b.shape not in ((), (length,)):
        shown = f"{shape_text(a.shape)} and {shape_text(b.shape)}"
        raise Mismatch(f"{shown} do not go together in '{text}'")
    rows = math.prod(a.shape[:-1])
    items = (
        _summed(_times(a.at(row * length + i), b.at(i)) for i in range(length))
        for row in range(rows)
    )
    return Elements(a.shape[:-1], tuple(items))


def _times(a: Expression, b: Expression) -> Expression:
    for one, other in ((a, b), (b, a)):
        if one == Number(0.0):
            return one
        if one == Number(1.0):
            return other
    return Call("*", (a, b))


def _summed(terms: Iterator[Expression]) -> Expression:
    total: Expression | None = None
    for term in terms:
        if term != Number(0.0):
            total = term if total is None else Call("+", (total, term))
    return Number(0.0) if total is None else total


def _solved(parts: Sequence[Elements], text: str) -> Elements:
    matrix, right = parts
    if not matrix.shape:
        items = (Call("/", (item, matrix.items[0])) for item in right.items)
        return Elements(right.shape, tuple(items))
    size = matrix.shape[0]
    if matrix.shape != (size, size):
        raise Mismatch(f"the matrix in '{text}' must be square, and it is {_size(matrix.shape)}")
    if right.shape not in ((), (size,)):
        what = f"a matrix of {_size(matrix.shape)} and {shape_text(right.shape)}"
        raise Mismatch(f"{what} do not go together in '{text}'")
    rows = (matrix.items[i * size : (i + 1) * size] for i in range(size))
    system = Call(
        "solve",
        (
            Call("stack", tuple(Call("stack", row) for row in rows)),
            Call("stack", tuple(right.at(i) for i in range(size))),
        ),
    )
    items = (Call("[]", (system, Number(float(i)))) for i in range(size))
    return Elements((size,), tuple(items))


def _size(shape: Shape) -> str:
    return "x".join(map(str, shape)) if len(shape) > 1 else shape_text(shape)
