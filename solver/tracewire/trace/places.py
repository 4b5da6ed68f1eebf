"""Places: the sums of a diagram that feed a rate, where a missing force or torque would enter."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

from tracewire.compile import Flat, Model
from tracewire.diagram import split_index
from tracewire.formula import Name, names_of

PASSED = ("sum", "gain", "divide")


@dataclass(frozen=True)
class Place:
    """A sum that feeds a rate: its name, the rate `v` and the coordinate `q` at it ('' if none).

    `definition` is the sum's name in the text of the diagram.
    """

    name: str
    definition: str
    v: str
    q: str = ""


def find_places(model: Model) -> list[Place]:
    """The places of a model.

    From each state the search goes back through gains, divisions, sums and the ports of
    subsystems; the sums that it meets are places of the nearest state. A sum that only feeds
    another place of the same state says nothing new and is left out. Where the diagram itself says
    which sum is the place of a rate (`place: {q: ..., v: ...}`), that sum is the only one. Sums
    inside subsystems are not tried: what the subsystem puts out enters a sum further up; nor are
    sums of vectors.
    """
    flat = model.flat
    coordinates = {s.rate.name: s.name for s in flat.states if isinstance(s.rate, Name)}
    nearest: dict[str, tuple[int, str]] = {}
    for state in flat.states:
        if split_index(state.name)[1]:
            continue
        for name, distance in _sums_behind(flat, names_of(state.rate)):
            if name not in nearest or distance < nearest[name][0]:
                nearest[name] = (distance, state.name)
    told = {
        name: block
        for name, block in flat.blocks.items()
        if block.type == "sum" and "v" in block.local and not split_index(name)[1]
    }
    taken = {block.local["v"] for block in told.values()}
    places = [
        Place(name, block.definition, block.local["v"], block.local.get("q", ""))
        for name, block in told.items()
    ]
    for name, (_, fed) in nearest.items():
        block = flat.blocks[name]
        if fed in taken or "." in block.definition or _only_feeds(flat, name, fed, nearest):
            continue
        places.append(Place(name, block.definition, fed, coordinates.get(fed, "")))
    return places


def _sums_behind(flat: Flat, names: tuple[str, ...]) -> Iterator[tuple[str, int]]:
    queue = deque((name, 1) for name in names)
    seen: set[str] = set()
    while queue:
        name, distance = queue.popleft()
        formula = flat.signals.get(name)
        if name in seen or formula is None:
            continue
        seen.add(name)
        block = flat.blocks.get(name)
        if block is not None and block.type not in PASSED:
            continue
        if block is not None and block.type == "sum" and not split_index(name)[1]:
            yield name, distance
        queue.extend((read, distance + 1) for read in names_of(formula))


def _only_feeds(flat: Flat, name: str, state: str, nearest: dict[str, tuple[int, str]]) -> bool:
    """Whether a sum has one reader only, which leads to another place of the same state."""
    seen: set[str] = set()  # an algebraic loop has no end
    while name not in seen:
        seen.add(name)
        readers = [n for n, formula in flat.signals.items() if name in names_of(formula)]
        rates = [s for s in flat.states if name in names_of(s.rate)]
        if len(readers) != 1 or rates:
            return False
        name = readers[0]
        if name in nearest and nearest[name][1] == state:
            return True
        block = flat.blocks.get(name)
        if block is not None and block.type not in PASSED:
            return False
    return False
