"""The figures of the papers: each can be drawn, says what it is, and the gallery shows it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from tracewire.diagram import read
from tracewire.errors import OptionError
from tracewire.paper import PAPERS, PaperFigure, figure_of, figures_of
from tracewire.paper.draw import KINDS, caption, draw
from tracewire.paper.figures import FIGURES
from tracewire.paper.headers import read_headers
from tracewire.paper.page import GALLERY, PAGE, page_text, pictures
from tracewire.paper.setting import Task, symbol
from tracewire.paper.time_figures import beyond
from tracewire.paper.triple_figures import turned
from tracewire.shipped import shipped
from tracewire.show.style import styled

PAPERS_FOLDER = shipped("diagrams") / "papers"
MOST_PICTURES, MOST_BYTES = 25, 60_000


@pytest.fixture(autouse=True)
def style() -> Iterator[None]:
    with styled(), matplotlib.rc_context({"text.parse_math": True}):
        yield


@pytest.mark.parametrize("figure", FIGURES, ids=lambda f: f.stem)
def test_each_figure_is_drawn_with_labels(figure: PaperFigure) -> None:
    drawn = KINDS[figure.kind](Task(figure, "quick"))
    panels = drawn.axes
    assert panels
    lines = [line for panel in panels for line in panel.lines]
    assert any(len(line.get_xdata()) > 2 for line in lines)
    assert all(np.isfinite(np.asarray(line.get_ydata(), dtype=float)).all() for line in lines)
    if figure.kind == "polar":
        assert all(panel.get_title() for panel in panels)
    else:
        assert any(panel.get_xlabel() for panel in panels)
        assert any("[" in panel.get_ylabel() for panel in panels)


def test_what_a_figure_says_of_itself() -> None:
    assert caption(figure_of("c", "33")).replace("\u00a0", " ").startswith(
        "Fig. 33 An orbit of the SAM for μₘ = 19.0, φ = π/2"
    )  # fmt: skip
    coarse, full = (caption(figure_of("b", "6"), amount) for amount in ("usual", "full"))
    assert "160 of the paper's 800" in coarse
    assert "160" not in full


def test_a_figure_is_written_as_png_and_svg(tmp_path: Path) -> None:
    files = [tmp_path / "five.png", tmp_path / "five.svg"]
    draw(figure_of("c", "5"), files)
    assert files[0].read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse(files[1]).getroot().tag.endswith("svg")


@pytest.mark.parametrize("figure", FIGURES, ids=lambda f: f.stem)
def test_diagram_and_presets_of_a_figure_exist(figure: PaperFigure) -> None:
    diagram = read(PAPERS_FOLDER / figure.diagram)
    for preset in figure.presets.values():
        name, equals, _ = preset.partition("=")
        assert not name or name in (diagram.parameters if equals else diagram.presets)


def test_numbers_of_figures_are_told_once() -> None:
    assert len({(f.paper, f.number) for f in FIGURES}) == len({f.stem for f in FIGURES})
    assert len({f.stem for f in FIGURES}) == len(FIGURES)


@pytest.mark.parametrize("number", range(28, 40))
def test_the_mass_ratio_of_an_orbit_is_that_of_its_caption(number: int) -> None:
    figure = figure_of("c", str(number))
    run = Task(figure, "quick").run()
    assert f"μₘ = {run.parameters['mu']:.1f}," in figure.caption
    assert (run["l"][0], run["phi"][0]) == (1.0, pytest.approx(math.pi / 2))


def test_an_unknown_figure_lists_those_that_exist() -> None:
    with pytest.raises(OptionError) as told:
        figure_of("c", "11")
    assert "there is no figure '11' of paper C" in str(told.value)
    assert "There are: 5, 6, 7, 8, 9, 10, 18, 19, 20, 28, " in str(told.value)


def test_an_unknown_paper_lists_those_that_exist() -> None:
    with pytest.raises(OptionError, match="unknown paper 'd'; there are: a, b, c"):
        figures_of("d")


@pytest.mark.parametrize("number", ["33", "Fig 33", "Fig. 33", " 33"])
def test_a_number_may_be_written_as_the_paper_does(number: str) -> None:
    assert figure_of("c", number).number == "33"


def test_symbols_are_those_of_the_papers() -> None:
    assert symbol("phi1_dot") == r"$\dot{\varphi}_{1}$"
    assert symbol("psi3") == r"$\psi_{3}$"
    assert symbol("l") == "$l$"
    assert symbol("reach") == "$l_1 + l_2$"


def test_depth_in_a_barrier() -> None:
    found = beyond(np.array([-0.3, -0.1, 0.0, 0.2, 0.5]), 0.2)
    assert found == pytest.approx([-0.1, 0.0, 0.0, 0.0, 0.3])


def test_angles_are_turned_to_half_a_turn_from_zero() -> None:
    assert turned(np.array([0.5, 7.0, -100.0])) == pytest.approx(
        [0.5, 7.0 - 2 * math.pi, -100.0 + 32 * math.pi]
    )


def test_the_simplex_brings_a_stage_nearer_to_the_record() -> None:
    title = KINDS["record"](Task(figure_of("a", "7"), "usual")).axes[0].get_title(loc="left")
    before, after = (float(number) for number in re.findall(r"(\S+) rad²", title))
    assert after < 0.7 * before


def test_nearby_motions_part() -> None:
    panel = KINDS["apart"](Task(figure_of("b", "8"), "quick")).axes[2]
    one, other = (np.asarray(line.get_ydata(), dtype=float) for line in panel.lines)
    assert abs(one[0] - other[0]) < 0.01
    assert np.max(np.abs(one - other)) > 3.0


# The page of all systems


def test_the_page_is_up_to_date() -> None:
    written = (PAPERS_FOLDER / PAGE).read_text(encoding="utf-8")
    assert written == page_text(), "call `tracewire paper --table`"


def test_the_gallery_has_every_picture_and_is_small() -> None:
    files = {file.stem: file for file in (PAPERS_FOLDER / GALLERY).iterdir()}
    assert set(files) == {figure.stem for figure in pictures()}
    assert len(files) <= MOST_PICTURES
    assert {n: f.stat().st_size for n, f in files.items() if f.stat().st_size > MOST_BYTES} == {}


def test_the_page_tells_every_diagram() -> None:
    told = {header.file for paper in PAPERS for header in read_headers(paper)}
    files = PAPERS_FOLDER.glob("*/*.yaml")
    assert told == {file.relative_to(PAPERS_FOLDER).as_posix() for file in files}


def test_a_header_is_read() -> None:
    header = next(h for h in read_headers("c") if h.name == "C16")
    assert (header.equations, header.figures) == ("23 and 24", "7 to 9 and 10")
    assert header.sees.startswith("a slow oscillation of frequency omega")
    assert header.errata.startswith("eps of the figures is that ripple")
    assert next(h for h in read_headers("c") if h.name == "C02").errata == ""


def test_all_systems_of_the_review_have_a_number() -> None:
    names = {header.name[:3] for header in read_headers("c")}
    assert names == {f"C{n:02d}" for n in range(1, 36)}
