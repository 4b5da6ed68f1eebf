"""Which files import which: the graph behind the tests of the architecture."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import networkx as nx


def modules(source: str, package: str = "") -> Iterator[tuple[int, str]]:
    """(line, full name) of each import in `source`, a file of `package`.

    `from a import b` is given as `a.b`: b may be a module. `importlib.import_module("a")` counts.
    """
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Import(names=names):
                yield from ((node.lineno, name.name) for name in names)
            case ast.ImportFrom(module=module, names=names, level=level):
                parts = package.split(".")
                start = parts[: len(parts) + 1 - level] if level else []
                base = ".".join([*start, *([module] if module else [])])
                yield from ((node.lineno, f"{base}.{name.name}") for name in names)
            case ast.Call(
                func=ast.Name(id="import_module" | "__import__")
                | ast.Attribute(attr="import_module"),
                args=[ast.Constant(value=str(module)), *_],
            ):
                yield node.lineno, module


def needs(sources: Mapping[str, str]) -> dict[str, dict[str, list[str]]]:
    """{file: {file that it imports: the names that it takes}}, for a path `a/b.py` of module a.b.

    What an `__init__` binds is taken from it, also where a file beside it has the same name.
    """
    files = {
        Path(file).with_suffix("").as_posix().removesuffix("/__init__").replace("/", "."): file
        for file in sources
    }
    fronts = {file: bound(text) for file, text in sources.items() if file.endswith("__init__.py")}
    found: dict[str, dict[str, list[str]]] = {}
    for file, text in sources.items():
        taken: defaultdict[str, set[str]] = defaultdict(set)
        for _, module in modules(text, ".".join(Path(file).parts[:-1])):
            front, _, name = module.rpartition(".")
            if module in files and name not in fronts.get(files.get(front, ""), set()):
                taken[files[module]].add("the module")
            elif front in files:
                taken[files[front]].add(name)
        found[file] = {other: sorted(names) for other, names in taken.items() if other != file}
    return found


def bound(source: str) -> set[str]:
    """The names that the imports of a file bind in it."""
    return {
        name.asname or name.name
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    }


def circles(sources: Mapping[str, str]) -> list[str]:
    """The shortest circle of each knot of files that need each other, with what each takes."""
    taken = needs(sources)
    graph = nx.DiGraph((file, other) for file, others in taken.items() for other in others)
    found = []
    for knot in nx.strongly_connected_components(graph):
        inside = graph.subgraph(knot)
        ways = (nx.shortest_path(inside, after, before) for before, after in inside.edges)
        circle = min(ways, key=lambda way: (len(way), way), default=[])
        lines = [
            f"  {file} takes {', '.join(taken[file][other])} from {other}"
            for file, other in zip(circle, [*circle[1:], *circle[:1]], strict=True)
        ]
        if lines:
            found.append("\n".join([f"{len(knot)} files need each other:", *lines]))
    return found
