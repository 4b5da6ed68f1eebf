"""Subsystems that are another one with changes: `extends` names one of a file that is included."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tracewire.diagram.extend import merge, removed_parts, without
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Items, Node, Scalar

CHANGING = ("extends", "remove")


def with_bases(entries: Entries, bases: Mapping[str, Node], problems: Problems) -> Entries:
    """The sections of a diagram, its subsystems with what they extend, at any depth.

    bases: the subsystems of the files that are included, by their names. The nodes of a base are
    copied, so that an edit of one that extends it finds its own.
    """
    found = dict(entries.values)
    for section in ("subsystems", "variants"):
        node = entries.values.get(section)
        if not isinstance(node, Entries):
            continue
        inside = {}
        for name, _, body in node:
            if isinstance(body, Entries):
                body = with_bases(body, bases, problems)
                body = _extended(body, bases, problems) if section == "subsystems" else body
            inside[name] = body
        found[section] = replace(node, values=inside)
    return replace(entries, values=found)


def _extended(own: Entries, bases: Mapping[str, Node], problems: Problems) -> Entries:
    """A subsystem with what it extends; itself where it extends nothing."""
    if not own.keys.keys() & {*CHANGING}:
        return own
    keys = {name: key for name, key in own.keys.items() if name not in CHANGING}
    changes = replace(own, keys=keys, values={name: own.values[name] for name in keys})
    name = own.values.get("extends")
    if name is None:
        what = "'remove' takes parts of another subsystem away, and this one extends none"
        problems.add(what, own.keys["remove"].place, (), "Write extends: NAME, or leave it out.")
        return changes
    if not isinstance(name, Scalar):
        what = "'extends' in a subsystem names one of an included file"
        problems.add(what, name.place, (), "Write extends: cart.")
        return changes
    base = bases.get(name.text)
    if not isinstance(base, Entries):
        hint = "Of a subsystem of this file write variants."
        problems.unknown("subsystem of an included file", name.text, bases, name.place, hint)
        return changes
    if not _has_at_most(base, LIMITS.most_extended):
        what = f"'{name.text}', which this one extends, has more than {LIMITS.most_extended} parts"
        problems.add(what, name.place, (), "Write the blocks that are needed, or a smaller base.")
        return changes
    both = merge(without(_copied(base), removed_parts(own), problems), changes)
    return replace(both, place=own.place, start=own.start, end=own.end, flow=own.flow)


def _has_at_most(node: Node, most: int) -> bool:
    """Whether a node has at most so many nodes inside of it."""
    due, count = [node], 0
    while due and count <= most:
        one = due.pop()
        count += 1
        if isinstance(one, Entries):
            due += one.values.values()
        elif isinstance(one, Items):
            due += one.items
    return count <= most


def _copied(entries: Entries) -> Entries:
    return replace(entries, values={name: _copy(node) for name, _, node in entries})


def _copy(node: Node) -> Node:
    if isinstance(node, Entries):
        return _copied(node)
    if isinstance(node, Items):
        return replace(node, items=tuple(_copy(item) for item in node.items))
    return replace(node)
