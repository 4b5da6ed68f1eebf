"""Loops: signals that need their own value at the same instant, parameters that need each other.

Signals are followed port by port. An output depends on an input only where its formula reads it,
and a subsystem's output on those inputs from which a path of such steps leads to it. So what an
integrator inside a subsystem breaks is no loop.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from functools import reduce
from operator import or_

import networkx as nx

from tracewire.diagram.diagram import BlockUse, Diagram, Value
from tracewire.diagram.names import find_signal, outputs_of
from tracewire.diagram.problems import Problems
from tracewire.formula import Expression, names_of

MOST_SHOWN = 100


class Loops:
    """Searches diagrams, those that stand inside others first, and notes what it finds."""

    def __init__(self, problems: Problems) -> None:
        self.problems = problems
        # by the id of a diagram, which the caller keeps alive
        self.graphs: dict[int, nx.DiGraph[str]] = {}
        self.reads: dict[int, dict[str, tuple[str, ...]]] = {}

    def search(self, diagram: Diagram) -> None:
        """Note the algebraic loops of a diagram; its subsystems have been searched before."""
        graph = self._graph(diagram)
        self.graphs[id(diagram)] = graph
        self.reads[id(diagram)] = _inputs_read(diagram, graph)
        for loop in cycles(graph, list(graph)):
            names = self._blocks(graph, [loop[-1], *loop])
            use = diagram.blocks[loop[0].partition(".")[0]]
            hint = "Break it with a state, such as an integrator, or solve the equation by hand."
            what = f"algebraic loop: {_shown([*names, names[0]])}"
            self.problems.add(what, use.place, (), hint)

    def _graph(self, diagram: Diagram) -> nx.DiGraph[str]:
        graph: nx.DiGraph[str] = nx.DiGraph()
        graph.add_nodes_from(diagram.inputs)
        for use in diagram.blocks.values():
            for port in outputs_of(use, diagram.library) or ():
                node = find_signal(diagram, f"{use.name}.{port}")
                if node is None:
                    continue
                graph.add_node(node)
                for name, read in self._read_at_once(diagram, use, port):
                    source = find_signal(diagram, name)
                    if source is not None and not graph.has_edge(source, node):
                        graph.add_edge(source, node, step=(use, read, port))
        return graph

    def _read_at_once(
        self, diagram: Diagram, use: BlockUse, port: str
    ) -> Iterator[tuple[str, str]]:
        """The signals that an output of a block depends on at once, and the inputs they come by."""
        if use.subsystem is not None:
            reads: Iterable[str] = self.reads[id(use.subsystem)].get(port, ())
        else:
            reads = names_of(diagram.library[use.type].formulas[port])
        for read in reads:
            for wire in use.inputs.get(read, ()):
                yield wire.signal, read
            setting = use.settings.get(read)
            if isinstance(setting, Expression):
                for name in names_of(setting):
                    yield name, read

    def _blocks(self, graph: nx.DiGraph[str], path: list[str]) -> list[str]:
        """The blocks on a path, those inside subsystems by their own path."""
        found: list[str] = []
        for edge in itertools.pairwise(path):
            use, read, port = graph.edges[edge]["step"]
            if use.subsystem is None:
                found.append(use.name)
                continue
            inside = self.graphs[id(use.subsystem)]
            target = find_signal(use.subsystem, use.subsystem.outputs[port].signal)
            inner = self._blocks(inside, nx.shortest_path(inside, read, target))
            found += [f"{use.name}.{name}" for name in inner or (port,)]
        return found


def _inputs_read(diagram: Diagram, graph: nx.DiGraph[str]) -> dict[str, tuple[str, ...]]:
    """The inputs of a diagram on which each of its outputs depends at once.

    Sets of inputs are kept as bits of a number, handed on along the wires.
    """
    inputs = list(diagram.inputs)
    bits = {name: 1 << index for index, name in enumerate(inputs)}
    parts = nx.condensation(graph)
    reached: dict[int, int] = {}
    for part in nx.topological_sort(parts):
        own = (bits.get(name, 0) for name in parts.nodes[part]["members"])
        before = (reached[other] for other in parts.predecessors(part))
        reached[part] = reduce(or_, itertools.chain(own, before), 0)
    found: dict[str, tuple[str, ...]] = {}
    for port, wire in diagram.outputs.items():
        part = parts.graph["mapping"].get(find_signal(diagram, wire.signal))
        mask = 0 if part is None else reached[part]
        found[port] = tuple(name for name in inputs if mask & bits[name])
    return found


def check_parameters(parameters: Mapping[str, Value], problems: Problems) -> None:
    """Note the parameters of a diagram that depend on each other."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    for name, value in parameters.items():
        used = names_of(value.formula)
        graph.add_edges_from((name, other) for other in used if other in parameters)
    for loop in cycles(graph, list(parameters)):
        what = f"parameters depend on each other: {_shown([*loop, loop[0]])}"
        problems.add(what, parameters[loop[0]].place, (), "Give one of them a number.")


def cycles(graph: nx.DiGraph[str], order: list[str]) -> list[list[str]]:
    """A shortest cycle of each strongly connected part, from its first node in `order` on."""
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


def _shown(names: list[str]) -> str:
    many = len(names) > MOST_SHOWN
    return " -> ".join([*names[: MOST_SHOWN - 2], "...", names[-1]] if many else names)
