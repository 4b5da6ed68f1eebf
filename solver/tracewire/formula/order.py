"""The order in which things are evaluated that read each other."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from graphlib import CycleError, TopologicalSorter
from heapq import heappop, heappush


def evaluation_order(reads: Mapping[str, Collection[str]]) -> list[str] | None:
    """The names, each after those that it reads, and else in the order of the mapping.

    None where some of them read each other. All that is read is a name of the mapping.
    """
    sorter = TopologicalSorter(reads)
    try:
        sorter.prepare()
    except CycleError:
        return None
    names = list(reads)
    position = {name: number for number, name in enumerate(names)}
    ready: list[int] = []
    found = []
    while sorter.is_active():
        for name in sorter.get_ready():
            heappush(ready, position[name])
        found.append(names[heappop(ready)])
        sorter.done(found[-1])
    return found
