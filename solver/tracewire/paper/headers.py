"""`read_headers`: what the comments at the top of the shipped diagrams say of their systems."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tracewire.diagram import is_modeline
from tracewire.shipped import shipped

FOLDERS = {"a": "a_torsion", "b": "b_triple", "c": "c_review"}
"""The folder of each paper's diagrams."""
PARTS = ("Source", "Given", "Chosen", "What one sees", "Errata")
NAMED = re.compile(r"^([A-Z]\d+\w*): |\((C\d+\w*)\)\.?$")
PLACE = re.compile(r"\s*\(paper [ABC]((?:, [^()]*)?)\)")
NUMBERS = r"\d+[a-z]?(?:(?:\s*(?:,|and|to|-|=)\s*|\s*,\s*and\s+)\d+[a-z]?)*"
NOTES = re.compile(r"\([^()]*\)")
SENTENCE = re.compile(r"(?<=[a-z)\d])[.:] (?=[A-Z])")


@dataclass(frozen=True)
class Header:
    """A system: its `name` (C32), what it is, equations and figures by number, and its file.

    `sees` is what one sees, `errata` where the print is wrong ("" where it is not).
    """

    name: str
    paper: str
    file: str
    system: str
    equations: str
    figures: str
    sees: str
    errata: str


def read_headers(paper: str) -> tuple[Header, ...]:
    """The headers of a paper's diagrams, in the order of their systems."""
    folder = shipped("diagrams") / "papers" / FOLDERS[paper]
    found = [_read(paper, path) for path in sorted(folder.glob("*.yaml"))]
    return tuple(sorted(found, key=lambda header: (header.name, header.file)))


def _read(paper: str, path: Path) -> Header:
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        if is_modeline(line):
            continue
        lines.append(line.removeprefix("#").strip())
    title = lines[0]
    parts = _parts(" ".join(lines[1:]).strip())
    place = PLACE.search(title)
    source = parts.get("Source", "")
    if place and place[1]:
        source = place[1]
    plain = re.sub(r"\s+([,:;.])", r"\1", " ".join(NOTES.sub("", source).split()))
    named = NAMED.search(title)
    name = (named[1] or named[2]) if named else "S4" if paper == "a" else paper.upper()
    errata = parts.get("Errata", "")
    return Header(
        name=name,
        paper=paper,
        file=path.relative_to(shipped("diagrams") / "papers").as_posix(),
        system=PLACE.sub("", NAMED.sub("", title)).strip(" ."),
        equations=_numbers(r"Eqs?", plain),
        figures=_numbers(r"Figs?", plain) or _numbers(r"Figs?", source),
        sees=SENTENCE.split(parts.get("What one sees", ""))[0].rstrip("."),
        errata="" if re.fullmatch(r"none\.?", errata) else errata,
    )


def _parts(text: str) -> dict[str, str]:
    """The text of each part, by the words that it begins with."""
    marks = "|".join(PARTS)
    pieces = re.split(rf"(?:^|(?<=[.)'\d] ))({marks}): ", text)
    return {name: body.strip() for name, body in zip(pieces[1::2], pieces[2::2], strict=True)}


def _numbers(kind: str, text: str) -> str:
    """The numbers behind a word, in the order of the text, each list once."""
    lists = re.findall(rf"\b{kind} ({NUMBERS}(?:, {NUMBERS})*)", text)
    return ", ".join(dict.fromkeys(" ".join(numbers.split()) for numbers in lists))
