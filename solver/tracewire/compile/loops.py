"""Algebraic loops: signals that need their own value at the same instant, found and opened.

Signals are followed from output to output, with all subsystems dissolved: what a subsystem does
not read at once makes no loop. A loop is opened at a few of its signals.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING

from tracewire.compile.flat import Loop
from tracewire.compile.limits import MODEL
from tracewire.diagram import cycle_text, cycles
from tracewire.errors import DiagramError, Location, Problem
from tracewire.formula import Expression, evaluation_order, read_at_once

if TYPE_CHECKING:
    import networkx as nx


def order_signals(
    signals: Mapping[str, Expression],
    guessed: Iterable[str],
    blocks: Collection[str],
    places: Mapping[str, Location],
) -> tuple[dict[str, Expression], tuple[Loop, ...]]:
    """The signals, each after those it reads, else in the order of the diagram; and the loops.

    The signals of a loop stand together, those that open it first. guessed: signals at which a
    loop is opened rather than at others; blocks: those that are shown of a loop. Raises
    DiagramError: too many signals depend on each other.
    """
    reads = {
        name: [read for read in read_at_once(formula, also_before=True) if read in signals]
        for name, formula in signals.items()
    }
    order = evaluation_order(reads)
    if order is not None:
        return {name: signals[name] for name in order}, ()
    import networkx as nx  # a fifth of a second that only loops pay

    position = {name: number for number, name in enumerate(signals)}
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(signals)
    graph.add_edges_from((read, name) for name in signals for read in reads[name])
    wanted = set(guessed)
    parts = nx.condensation(graph)
    first = {part: min(position[n] for n in parts.nodes[part]["members"]) for part in parts}
    ordered: dict[str, Expression] = {}
    loops = []
    for part in nx.lexicographical_topological_sort(parts, first.__getitem__):
        members = parts.nodes[part]["members"]
        (name, *others) = members
        if not others and not graph.has_edge(name, name):
            ordered[name] = signals[name]
            continue
        inside = nx.DiGraph(graph.subgraph(sorted(members, key=position.__getitem__)))
        loop = _opened(inside, position, wanted, blocks, places)
        loops.append(loop)
        ordered |= {name: signals[name] for name in loop.names}
    return ordered, tuple(loops)


def _opened(
    graph: nx.DiGraph[str],
    position: Mapping[str, int],
    guessed: set[str],
    blocks: Collection[str],
    places: Mapping[str, Location],
) -> Loop:
    """The loop of a strongly connected graph, with the signals at which it is opened."""
    import networkx as nx

    order = sorted(graph, key=position.__getitem__)
    (cycle,) = cycles(graph, order)
    shown = [name for name in cycle if name in blocks] or cycle
    at = next((places[name] for name in (*shown, *order) if name in places), Location())
    text = cycle_text([*shown, shown[0]])
    unknowns: list[str] = []
    rest = graph.copy()
    while loops := [p for p in nx.strongly_connected_components(rest) if _is_loop(rest, p)]:
        for part in loops:
            inside = rest.subgraph(part)

            def worth(name: str, inside: nx.DiGraph[str] = inside) -> tuple[bool, int, int]:
                ways = inside.in_degree(name) * inside.out_degree(name)
                return name in guessed, ways, -position[name]

            unknowns.append(max(part, key=worth))
            rest.remove_node(unknowns[-1])
        if len(unknowns) > MODEL.most_unknowns:
            many = f"more than {MODEL.most_unknowns} signals depend on each other"
            what = f"algebraic loops: {many}: {text}"
            hint = "So many are not solved at once. Break the loops with states."
            raise DiagramError([Problem(what, at, (), hint)])
    names = nx.lexicographical_topological_sort(rest, position.__getitem__)
    return Loop((*unknowns, *names), tuple(unknowns), text, at)


def _is_loop(graph: nx.DiGraph[str], part: set[str]) -> bool:
    return len(part) > 1 or any(graph.has_edge(name, name) for name in part)
