"""The diagrams of each paper; their sections `expect` hold what it states."""

from __future__ import annotations

from pathlib import Path

from tracewire.diagram import Diagram, Statement, read
from tracewire.errors import OptionError, unknown
from tracewire.paper.figure import PAPERS
from tracewire.paper.headers import FOLDERS
from tracewire.shipped import shipped


def folder_of(paper: str) -> Path:
    """The folder with the diagrams of paper "a", "b" or "c". Raises OptionError: no such paper."""
    if paper not in FOLDERS:
        raise OptionError([unknown("paper", paper, PAPERS)])
    return shipped("diagrams") / "papers" / FOLDERS[paper]


def diagrams_of(paper: str) -> tuple[Diagram, ...]:
    """The diagrams of a paper, in the order of their files. Raises OptionError: no such paper."""
    return tuple(read(file) for file in sorted(folder_of(paper).glob("*.yaml")))


def system_of(statement: Statement) -> str:
    """The system of a statement of a paper, such as C15: the first word of its name."""
    return statement.name.split()[0]
