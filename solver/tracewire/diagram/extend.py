"""`extends`: a diagram that is another one with changes, merged as nodes that keep their places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tracewire.diagram.problems import Problems, clip
from tracewire.diagram.strict import Entries, Items, Node, Scalar

ADDED = ("include", "require", "events", "scene")
"""Lists without names: the entries of the changes come behind those of the base."""
PORTS = ("inputs", "outputs")
"""Sections that may be lists of names as well as mappings."""
NAMED = (
    *(*PORTS, "libraries", "parameters", "blocks", "subsystems", "variants", "presets"),
    "measured",
)
MAIN = ("value", "count", "column")
"""What a mapping stands for where a single text is given in its place: `k: 3`, `x: angle`."""


def merge(base: Entries, own: Entries) -> Entries:
    """The sections of a diagram with those of its changes."""
    values = {name: _by_name(name, node) for name, _, node in base}
    for section, _, node in own:
        new = _by_name(section, node)
        values[section] = _section(section, values[section], new) if section in values else new
    return replace(own, keys=base.keys | own.keys, values=values)


def variants_of(entries: Entries) -> tuple[str, ...]:
    """The names of the bodies of a subsystem that has several."""
    given = entries.values.get("variants")
    return tuple(given.keys) if isinstance(given, Entries) else ()


def with_variant(entries: Entries, variant: str, problems: Problems) -> Entries:
    """The sections of a subsystem with the changes that one of its variants makes."""
    keys = {name: key for name, key in entries.keys.items() if name != "variants"}
    plain = replace(entries, keys=keys, values={name: entries.values[name] for name in keys})
    given = entries.values["variants"]
    changes = given.values[variant] if isinstance(given, Entries) else given
    if not isinstance(changes, Entries):
        return plain
    names = removed_parts(changes)
    own = {name: key for name, key in changes.keys.items() if name != "remove"}
    changes = replace(changes, keys=own, values={name: changes.values[name] for name in own})
    both = merge(without(plain, names, problems), changes)
    return replace(both, place=entries.place, start=entries.start, end=entries.end)


def removed_parts(changes: Entries) -> list[Scalar]:
    """What changes take away from what they change."""
    given = changes.values.get("remove")
    items = given.items if isinstance(given, Items) else () if given is None else (given,)
    return [item for item in items if isinstance(item, Scalar)]


def _by_name(section: str, node: Node) -> Node:
    """A section that is a list of names, as the mapping that it is short for."""
    if section not in PORTS or not isinstance(node, Items):
        return node
    names = [item for item in node.items if isinstance(item, Scalar)]
    if len({name.text for name in names}) < len(node.items):
        return node  # it is refused where it is read
    empty = replace(_empty(node), flow=True)
    values: dict[str, Node] = {n.text: n if section == "outputs" else empty for n in names}
    return Entries({n.text: n for n in names}, values, node.place, node.start, node.end, node.flow)


def _empty(node: Node) -> Entries:
    return Entries({}, {}, node.place, node.start, node.end, False)


def _section(section: str, old: Node, new: Node) -> Node:
    if section in ADDED:
        before, after = (n.items if isinstance(n, Items) else (n,) for n in (old, new))
        flow = isinstance(new, Items) and new.flow
        return Items((*before, *after), new.place, new.start, new.end, flow)
    if section not in NAMED or not isinstance(old, Entries) or not isinstance(new, Entries):
        return new
    values = dict(old.values)
    for name, _, node in new:
        values[name] = _entry(section, values[name], node) if name in values else node
    return replace(new, keys=old.keys | new.keys, values=values)


def _entry(section: str, old: Node, new: Node) -> Node:
    both = isinstance(old, Entries) and isinstance(new, Entries)
    if (
        section in ("subsystems", "variants")
        and isinstance(old, Entries)
        and isinstance(new, Entries)
    ):
        return merge(old, new)
    if section == "blocks" and both and isinstance(new, Entries) and "type" in new.keys:
        return new
    return _changed(old, new)


def _changed(old: Node, new: Node) -> Node:
    """A node with the changes of another one; a text changes the main entry of a mapping only."""
    if isinstance(new, Entries):
        if isinstance(old, Entries):
            values = {name: node for name, _, node in old}
            for name, _, node in new:
                values[name] = _changed(values[name], node) if name in values else node
            return replace(new, keys=old.keys | new.keys, values=values)
        if isinstance(old, Scalar) and new.keys and new.keys.keys() <= {"unit", "fit"}:
            return replace(
                new, keys={"value": old, **new.keys}, values={"value": old, **new.values}
            )
    if isinstance(old, Entries) and isinstance(new, Scalar):
        for main in MAIN:
            if main in old.keys:
                return replace(old, values={**old.values, main: new})
    return new


def without(base: Entries, names: list[Scalar], problems: Problems) -> Entries:
    """A base without what `remove` names: a section, a name, or a path such as `blocks.drag.c`."""
    base = replace(base, values={name: _by_name(name, node) for name, _, node in base})
    for name in names:
        found = _paths(base, name.text.strip())
        if len(found) == 1:
            base = _without(base, found[0])
        elif found:
            what = f"'{clip(name.text)}' may mean several parts of the diagram that is extended"
            problems.add(what, name.place, [".".join(path) for path in found], "Write one of them.")
        else:
            known = {inner for node in _named_parts(base).values() for inner in node.keys}
            problems.unknown("part to remove", name.text, {*base.keys, *known}, name.place)
    return base


def _named_parts(base: Entries) -> Mapping[str, Entries]:
    return {s: n for s, _, n in base if s in NAMED and isinstance(n, Entries)}


def _paths(base: Entries, name: str) -> list[tuple[str, ...]]:
    """What a name may mean: a path from the top, or one from a section with names on."""
    found = [_path(base, name)]
    for section, node in _named_parts(base).items():
        inside = _path(node, name)
        found.append(inside and (section, *inside))
    return [path for path in found if path]


def _path(node: Node, name: str) -> tuple[str, ...]:
    """The keys that a path leads along; empty where it leads nowhere. Keys may have points."""
    if not isinstance(node, Entries):
        return ()
    if name in node.keys:
        return (name,)
    for key, _, inside in node:
        if name.startswith(f"{key}."):
            rest = _path(inside, name[len(key) + 1 :])
            if rest:
                return (key, *rest)
    return ()


def _without(node: Entries, path: tuple[str, ...]) -> Entries:
    name, *rest = path
    inside = node.values[name]
    if rest and isinstance(inside, Entries):
        return replace(node, values={**node.values, name: _without(inside, tuple(rest))})
    return replace(
        node,
        keys={key: k for key, k in node.keys.items() if key != name},
        values={key: v for key, v in node.values.items() if key != name},
    )
