"""Cycles of things that need each other, and how they are shown.

Signals that need their own value at the same instant are no mistake of a diagram: its equations are
solved when it is compiled. Parameters that need each other are one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from tracewire.diagram.diagram import Value
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import Problems
from tracewire.formula import evaluation_order, names_of

if TYPE_CHECKING:
    import networkx as nx


def check_parameters(parameters: Mapping[str, Value], problems: Problems) -> None:
    """Note the parameters of a diagram that depend on each other."""
    reads = {
        name: [read for read in names_of(value.formula) if read in parameters]
        for name, value in parameters.items()
    }
    if evaluation_order(reads) is not None:
        return
    import networkx as nx  # a fifth of a second that only cycles pay

    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_edges_from((name, read) for name in parameters for read in reads[name])
    for loop in cycles(graph, list(parameters)):
        what = f"parameters depend on each other: {cycle_text([*loop, loop[0]])}"
        problems.add(what, parameters[loop[0]].place, (), "Give one of them a number.")


def cycles(graph: nx.DiGraph[str], order: Sequence[str]) -> list[list[str]]:
    """A shortest cycle of each strongly connected part, from its first node in `order` on."""
    import networkx as nx

    rank = {name: index for index, name in enumerate(order)}
    found = []
    for part in nx.strongly_connected_components(graph):
        first = min(part, key=lambda name: rank[name])
        before = [node for node in graph.predecessors(first) if node in part]
        if before:
            inside = graph.subgraph(part)
            steps = nx.single_source_shortest_path_length(inside, first)
            last = min(before, key=lambda node: (steps[node], rank[node]))
            found.append(nx.shortest_path(inside, first, last))
    return sorted(found, key=lambda cycle: rank[cycle[0]])


def cycle_text(names: Sequence[str]) -> str:
    """A cycle as `a -> b -> a`; a very long one in part."""
    many = len(names) > LIMITS.longest_loop
    return " -> ".join([*names[: LIMITS.longest_loop - 2], "...", names[-1]] if many else names)
