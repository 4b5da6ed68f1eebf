"""What `tracewire paper` does for figures and for the page of all systems."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tracewire.cli.output import check_target, print_json, print_text, telling, working
from tracewire.files import writing

if TYPE_CHECKING:
    from tracewire.paper import PaperFigure

ENDINGS = (".png", ".svg", ".pdf")


def write_figure(paper: str, number: str, output: str | None, full: bool, as_json: bool) -> None:
    """Draw one figure of a paper, to a .png and an .svg unless a file is named."""
    from tracewire.paper import figure_of

    check_target(output, ENDINGS, "figure")
    figure = figure_of(paper, number)
    paths = [output] if output is not None else _both(figure, Path())
    _draw(figure, paths, full)
    _tell([(figure, paths)], as_json)


def write_figures(paper: str, output: str | None, full: bool, as_json: bool) -> None:
    """Draw all figures of a paper into a folder, which is made."""
    from tracewire.paper import figures_of

    figures = figures_of(paper)
    folder = Path(output if output is not None else f"paper_{paper}")
    with writing(str(folder)):
        folder.mkdir(parents=True, exist_ok=True)
    drawn = []
    for figure in figures:
        paths = _both(figure, folder)
        _draw(figure, paths, full)
        drawn.append((figure, paths))
    _tell(drawn, as_json)


def write_table(output: str | None) -> None:
    """Write the page of all systems, and its pictures beside it."""
    from tracewire.paper.page import write_page

    with working("writing the page") as show, writing(output or "the page"):
        page = write_page(output, show)
    print_text(f"written: {page}")


def _both(figure: PaperFigure, folder: Path) -> list[str]:
    return [str(folder / f"{figure.stem}{ending}") for ending in (".png", ".svg")]


def _draw(figure: PaperFigure, paths: Sequence[str], full: bool) -> None:
    name = f"drawing figure {figure.number}"
    with working(name) as show, writing(paths[0]):
        from tracewire.paper.draw import draw

        draw(figure, paths, "full" if full else "usual", progress=telling(name, show))


def _tell(drawn: Sequence[tuple[PaperFigure, Sequence[str]]], as_json: bool) -> None:
    if as_json:
        rows = [
            {"paper": f.paper, "figure": f.number, "diagram": f.diagram, "caption": f.caption,
             "remark": f.remark, "written": list(paths)}
            for f, paths in drawn
        ]  # fmt: skip
        print_json({"figures": rows})
        return
    for _, paths in drawn:
        print_text(f"written: {', '.join(paths)}")
