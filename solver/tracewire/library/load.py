"""From folders of block files to a library of blocks."""

from __future__ import annotations

import runpy
import traceback
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tracewire.arguments import checked
from tracewire.errors import BlockError, Location, Problem
from tracewire.library.declare import Block
from tracewire.shipped import shipped


@dataclass(frozen=True)
class Library:
    """The blocks that a diagram may use, by name, and the family (file) of each."""

    blocks: Mapping[str, Block]
    families: Mapping[str, str] = field(default_factory=dict)

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle keeps: the declarations, which need none of the files where they are read."""
        return _library, (dict(self.blocks), dict(self.families))

    def __contains__(self, name: object) -> bool:
        return name in self.blocks

    def __getitem__(self, name: str) -> Block:
        return self.blocks[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.blocks)

    def extended(self, blocks: Mapping[str, Block], families: Mapping[str, str]) -> Library:
        """A library with further blocks."""
        return _library({**self.blocks, **blocks}, {**self.families, **families})

    def effects(self) -> dict[str, Block]:
        """The blocks that may be tried as a missing effect, by name."""
        return {name: block for name, block in self.blocks.items() if block.effect is not None}


@checked
def load_library(extra: Iterable[str | Path] = ()) -> Library:
    """The shipped blocks, and those of the files and folders that the user names.

    Block files are Python and run when they are read: only name libraries that you trust. A file
    that has not changed is not read again. Files of a folder whose name begins with `_` or `test_`
    hold no blocks. Raises BlockError: a folder without block files, a file that cannot be read, a
    declaration that is wrong, a name declared twice.
    """
    files: list[Path] = []
    problems: list[Problem] = []
    for folder in (shipped("blocks"), *(Path(path).resolve() for path in extra)):
        found = [folder] if folder.is_file() else block_files(folder)
        if not found:
            hint = "A library is a .py file of block declarations, or a folder of them."
            what = "there are no block files here" if folder.exists() else "this does not exist"
            problems.append(Problem(what, Location(str(folder)), (), hint))
        files += found
    return _library(*load_files(files, problems))


def block_files(folder: Path) -> list[Path]:
    """The files of a folder that may declare blocks: none begins with `_` or `test_`."""
    return sorted(f for f in folder.glob("[!_]*.py") if not f.name.startswith("test_"))


def load_files(
    files: Iterable[Path], problems: Sequence[Problem] = ()
) -> tuple[dict[str, Block], dict[str, str]]:
    """The blocks that files declare, by name, and the family of each; the files are run.

    Raises BlockError: `problems`, a file that cannot be read, a name declared twice.
    """
    blocks: dict[str, Block] = {}
    families: dict[str, str] = {}
    problems = list(problems)
    for file in files:
        try:
            found = _read(file, file.stat().st_mtime_ns)
        except BlockError as error:
            problems += error.problems
            continue
        for block in found:
            if blocks.setdefault(block.name, block) is not block:
                there = blocks[block.name].place
                what = f"the block '{block.name}' is already declared in {there}"
                problems.append(Problem(what, block.place, (), "Give it another name."))
            families.setdefault(block.name, file.stem)
    if problems:
        raise BlockError(problems)
    return blocks, families


def _library(blocks: dict[str, Block], families: dict[str, str]) -> Library:
    """A library that nobody can change."""
    return Library(MappingProxyType(blocks), MappingProxyType(families))


@lru_cache(maxsize=1024)
def _read(file: Path, changed: int) -> tuple[Block, ...]:
    """The blocks that a file declares; `changed` is its time, so that a file is read once."""
    if file.suffix != ".py":
        raise BlockError([Problem("this is not a Python file", Location(str(file)))])
    try:
        # a full module name, so that a family called math.py cannot shadow the standard library
        found = runpy.run_path(str(file), run_name=f"tracewire.blocks.{file.stem}")
    except BlockError:
        raise
    except Exception as error:  # a user's library may fail in any way while it is read
        what = f"the block file cannot be read: {type(error).__name__}: {error}"
        raise BlockError([Problem(what, Location(str(file), _line(error, file)))]) from error
    return tuple({id(b): b for b in found.values() if isinstance(b, Block)}.values())


def _line(error: Exception, file: Path) -> int:
    """The line of the file in which the error arose; 0 where it is not known."""
    if isinstance(error, SyntaxError):
        return error.lineno or 0
    frames = traceback.extract_tb(error.__traceback__)
    return next((f.lineno or 0 for f in reversed(frames) if f.filename == str(file)), 0)
