"""`write_page`: the page of all systems of the papers, with a gallery of their figures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from tracewire.errors import OptionError, Problem
from tracewire.files import replacing, write_file
from tracewire.paper.draw import caption, draw
from tracewire.paper.figure import PAPERS, PaperFigure
from tracewire.paper.figures import FIGURES, figures_of
from tracewire.paper.headers import FOLDERS, Header, read_headers
from tracewire.shipped import shipped

PAGE, GALLERY = "README.md", "gallery"
DPI = 80.0
COLOURS = 48  # of a picture: it is small then
TOP = """\
# The systems of the three papers

Every system of the papers as a diagram, with its cases as presets:
`tracewire run FILE --preset CASE`. Parameters that a paper does not print are chosen, and the
header of the diagram says which. Each system is held against an independent solution that is
written from the equations alone: the test is the link of its status. `tracewire paper a`, `b` and
`c` measure what the papers state and write a report. This page is made by `tracewire paper --table`
from the headers of the diagrams.
"""
HEAD = "| | System | Eq | Fig | Drawn | File | Cases | Status | What one sees | Errata |"
DRAWN = """\
## Gallery

Each figure is drawn by the command below it, and all of a paper by `tracewire paper c --figures`.
"""


def write_page(path: str | Path | None = None, tell: Callable[[str], None] | None = None) -> Path:
    """Write the page and, in a folder beside it, its pictures; in the checkout unless given.

    Raises OptionError where tracewire is no checkout; OSError.
    """
    page = shipped("diagrams") / "papers" / PAGE if path is None else Path(path)
    text = page_text()
    folder = page.parent / GALLERY
    folder.mkdir(parents=True, exist_ok=True)
    shown = pictures()
    for n, figure in enumerate(shown, start=1):
        if tell is not None:
            tell(f"drawing figure {figure.number} of paper {figure.paper} ({n} of {len(shown)})")
        file = folder / f"{figure.stem}.png"
        draw(figure, [file], dpi=DPI)
        _shrink(file)
    write_file(page, text)
    return page


def page_text() -> str:
    """The page as Markdown. Raises OptionError where tracewire is no checkout: tests are named."""
    tests = _tests()
    lines = [TOP]
    for paper, title in PAPERS.items():
        lines += [f"## Paper {paper.upper()}: {title}", "", HEAD, "|---" * 10 + "|"]
        lines += [_row(header, tests) for header in read_headers(paper)] + [""]
    lines.append(DRAWN)
    for paper in PAPERS:
        lines += [f"### Paper {paper.upper()}", ""]
        lines += [line for f in pictures() if f.paper == paper for line in _picture(f)]
    return "\n".join(lines).rstrip() + "\n"


def pictures() -> tuple[PaperFigure, ...]:
    """The figures of the gallery: one that shows several stands for these."""
    several = {f.number for f in FIGURES if "-" in f.number}
    within = {
        str(n)
        for number in several
        for n in range(int(number.split("-")[0]), int(number.split("-")[1]) + 1)
    }
    return tuple(f for p in PAPERS for f in figures_of(p) if p != "c" or f.number not in within)


def _row(header: Header, tests: dict[str, str]) -> str:
    name = Path(header.file).stem
    test = _test_of(header, tests)
    cells = [
        header.name,
        header.system[:1].upper() + header.system[1:],
        header.equations,
        header.figures,
        ", ".join(f.number for f in pictures() if f.diagram == header.file),
        f"[{name}]({header.file})",
        ", ".join(_cases(header)),
        f"[tested](../../tests/papers/{test})",
        _escaped(header.sees[:1].upper() + header.sees[1:]),
        _escaped(header.errata[:1].upper() + header.errata[1:]),
    ]
    return f"| {' | '.join(cells)} |"


def _cases(header: Header) -> Iterator[str]:
    from tracewire.diagram import read

    diagram = read(shipped("diagrams") / "papers" / header.file)
    return (f"`{name}`" for name in diagram.presets)


def _tests() -> dict[str, str]:
    """The text of each test that holds systems against independent solutions, by its file."""
    folder = shipped("diagrams").parent / "tests" / "papers"
    files = sorted(folder.glob("test_[abc]_*.py"))
    if not files:
        what = "the page names the tests of the systems, and they are not installed"
        raise OptionError([Problem(what, hint="Call it in a checkout of tracewire.")])
    read = {file.name: file.read_text(encoding="utf-8") for file in files}
    return {name: text for name, text in read.items() if "from oracles" in text}


def _test_of(header: Header, tests: dict[str, str]) -> str:
    """The first test that names the diagram. Raises OptionError where none does."""
    name = Path(header.file).stem
    own = [test for test in tests if test.startswith(f"test_{header.paper}_")]
    for test in own:
        if name in tests[test] and FOLDERS[header.paper] in tests[test]:
            return test
    what = f"no test names the diagram '{header.file}'"
    raise OptionError([Problem(what, hint="Test it in tests/papers.")])


def _picture(figure: PaperFigure) -> list[str]:
    first, _, _ = figure.number.partition("-")
    text = caption(figure).replace("\u00a0", " ")
    return [
        f"![Figure {figure.number} of paper {figure.paper.upper()}]({GALLERY}/{figure.stem}.png)",
        "",
        f"{_escaped(text)} [{Path(figure.diagram).stem}]({figure.diagram}), "
        f"`tracewire paper {figure.paper} --figure {figure.number}`"
        + (f"; each alone with `--figure {first}` and so on." if first != figure.number else "."),
        "",
    ]


def _escaped(text: str) -> str:
    """Text in which Markdown sees no table and no emphasis."""
    return text.replace("|", "\\|").replace("*", "\\*")


def _shrink(file: Path) -> None:
    """Keep a picture's main colours only."""
    from PIL import Image

    with Image.open(file) as picture:
        small = picture.convert("RGB").quantize(
            COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
        )
    with replacing(file) as smaller:
        small.save(smaller, format="PNG", optimize=True)
