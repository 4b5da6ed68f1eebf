"""The page of names: how Simulink, Modelica and Xcos call the blocks, as a table in Markdown."""

from __future__ import annotations

from tracewire.library.load import Library
from tracewire.library.synonyms import INSTEAD, NAMES, Tool

TOOLS: tuple[Tool, ...] = ("Simulink", "Modelica", "Xcos", "")

HEAD = """# Blocks and their names elsewhere

`tracewire blocks` lists all blocks, and `tracewire blocks NAME` says all of one. It knows the names
below, too, whatever their case, blanks and signs between words. A name that is written like ours,
such as Simulink's Saturation, may be left out. The file behind a block has its declaration.

This page is made by `python -m tracewire.library > blocks/README.md` from
[a table of names](../solver/tracewire/library/synonyms.py).

| block | what it is | Simulink | Modelica | Xcos | other words |
|---|---|---|---|---|---|
"""
NO_BLOCKS = """
## What is no block here

| elsewhere | here |
|---|---|
"""


def names_page(library: Library) -> str:
    """The page, in the order of the families of blocks."""
    rows = [
        [f"[{name}]({library.families[name]}.py)", library[name].doc]
        + [NAMES[name].get(tool, "") for tool in TOOLS]
        for name in sorted(NAMES, key=lambda name: (library.families[name], name))
    ]
    others = [[names, hint] for names, hint in INSTEAD.items()]
    return HEAD + _rows(rows) + NO_BLOCKS + _rows(others)


def _rows(rows: list[list[str]]) -> str:
    lines = (" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows)
    return "".join(f"| {line} |\n" for line in lines)
