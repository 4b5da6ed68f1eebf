"""Reports are documents that say what was done, with tables, and figures beside them."""

from __future__ import annotations

import base64
import html.parser
from dataclasses import replace
from pathlib import Path

import pytest
from show.fits import MODEL
from show.test_figures import SAMPLED
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.show import Report, report
from tracewire.show.diagram_picture import diagram_figure
from tracewire.show.document import Figure, Section
from tracewire.show.summary import Table
from tracewire.show.tidy import tidy_formula
from tracewire.solve import simulate


class Outline(html.parser.HTMLParser):
    """The text of a page by tag; it fails where tags do not match."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: dict[str, list[str]] = {}
        self.images: list[str] = []
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.images.append(str(dict(attrs)["src"]))
        elif tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and data.strip():
            self.texts.setdefault(self.open[-1], []).append(data)


DOCUMENT = Report(
    "A < B",
    (
        Section(
            "First",
            ("One & one.",),
            (Table("sizes", ("name", "size"), (("a|b", "1"), ("<i>", "2")), frozenset({1})),),
            "x < y\n",
            (Figure("f.png", "A figure", lambda path: path.write_bytes(b"drawn")),),
        ),
        Section("Second"),
    ),
)


def test_a_report_is_markdown(tmp_path: Path) -> None:
    path = DOCUMENT.write(tmp_path / "report.md")
    assert path.read_text(encoding="utf-8").splitlines() == [
        "# A < B", "", "## First", "", "One & one.", "", "**sizes**", "",
        "| name | size |", "| --- | ---: |", "| a\\|b | 1 |", "| \\<i> | 2 |", "",
        "```", "x < y", "```", "", "![A figure](report_f.png)", "", "## Second",
    ]  # fmt: skip
    assert (tmp_path / "report_f.png").read_bytes() == b"drawn"


def test_a_report_is_html_with_escaped_text(tmp_path: Path) -> None:
    page = DOCUMENT.write(str(tmp_path / "report.html")).read_text(encoding="utf-8")
    outline = Outline(page.removeprefix("<!doctype html>"))
    assert outline.texts["h1"] == ["A < B"]
    assert outline.texts["h2"] == ["First", "Second"]
    assert outline.texts["p"] == ["One & one."]
    assert outline.texts["caption"] == ["sizes"]
    assert outline.texts["td"] == ["a|b", "1", "<i>", "2"]
    assert outline.texts["pre"] == ["x < y\n"]
    assert outline.texts["figcaption"] == ["A figure"]
    (image,) = outline.images
    head, data = image.split(",")
    assert head == "data:image/png;base64"
    assert base64.b64decode(data) == b"drawn"
    assert list(tmp_path.iterdir()) == [tmp_path / "report.html"]  # one file, to be mailed


def test_points_are_a_list() -> None:
    listed = Report("A", (Section("First", points=("one", "two")),))
    assert "- one\n- two\n" in listed.markdown()
    assert Outline(listed.html().removeprefix("<!doctype html>")).texts["li"] == ["one", "two"]


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("a*b*c", r"a\*b\*c"),
        ("T_s2_l stays", "T_s2_l stays"),
        ("`trace a_*` looks", "`trace a_*` looks"),
        ("a single ` stays", r"a single \` stays"),
        ("_x_", r"\_x\_"),
        (r"data\*.csv", r"data\\\*.csv"),
        ("a <b> < c", r"a \<b> < c"),
    ],
)
def test_markdown_shows_names_as_they_are(text: str, written: str) -> None:
    assert written in Report("A", (Section("First", (text,)),)).markdown().splitlines()


def test_what_is_typed_is_code_in_html() -> None:
    page = Report("A", (Section("First", ("`trace <a>` looks",), points=("`b`",)),)).html()
    assert "<p><code>trace &lt;a&gt;</code> looks</p>" in page
    assert "<li><code>b</code></li>" in page


def test_a_report_that_cannot_be_written_is_told_before_it_is_drawn(tmp_path: Path) -> None:
    drawn: list[Path] = []
    figure = Figure("f.png", "A figure", drawn.append)
    with pytest.raises(OptionError, match="cannot be written"):
        Report("A", (Section("First", figures=(figure,)),)).write(tmp_path / "no" / "report.html")
    assert drawn == []


def failing(path: Path) -> None:
    raise KeyError("start.x")


FAILING = Report(
    "A",
    (
        Section("First", figures=(Figure("bad.png", "A bad one", failing),)),
        Section(
            "Second",
            figures=(Figure("good.png", "A good one", lambda path: path.write_bytes(b"drawn")),),
        ),
    ),
)


@pytest.mark.parametrize("ending", ["md", "html"])
def test_a_figure_that_fails_is_a_line_and_the_others_are_drawn(
    tmp_path: Path, ending: str
) -> None:
    told: list[str] = []
    text = FAILING.write(tmp_path / f"a.{ending}", told.append).read_text(encoding="utf-8")
    assert told == ["The figure 'A bad one' could not be drawn: KeyError('start.x')."]
    assert "A bad one" in text
    assert "KeyError" in text
    assert "bad.png" not in text
    assert "a_good.png" in text if ending == "md" else text.count("data:image/png") == 1


def test_an_older_report_stays_until_the_new_one_is_complete(tmp_path: Path) -> None:
    def stop(path: Path) -> None:
        raise KeyboardInterrupt

    file = tmp_path / "a.html"
    DOCUMENT.write(file)
    old = file.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        Report("B", (Section("First", figures=(Figure("f.png", "A", stop),)),)).write(file)
    assert file.read_bytes() == old
    assert list(tmp_path.iterdir()) == [file]


def test_figures_of_two_reports_in_one_folder_keep_their_own(tmp_path: Path) -> None:
    for name in ("one", "two"):
        figure = Figure("f.png", "A", lambda path, name=name: path.write_text(name))
        Report(name, (Section("First", figures=(figure,)),)).write(tmp_path / f"{name}.md")
    assert (tmp_path / "one_f.png").read_text() == "one"
    assert "(one_f.png)" in (tmp_path / "one.md").read_text(encoding="utf-8")
    assert (tmp_path / "two_f.png").read_text() == "two"


def test_another_ending_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"unknown file ending '.pdf'. End it in .md or .html."):
        DOCUMENT.write(tmp_path / "report.pdf")


def test_a_folder_that_does_not_exist_is_told(tmp_path: Path) -> None:
    with pytest.raises(
        OptionError, match=r"cannot be written: No such file.*Name a file in a folder that"
    ):
        DOCUMENT.write(tmp_path / "no" / "report.md")


def test_a_run_as_a_report(tmp_path: Path) -> None:
    path = report(simulate(MODEL)).write(tmp_path / "run.md")
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# Swing & rest\n")
    assert "From 0 to 2 s, 1001 samples. Events: none." in text
    assert (tmp_path / "run.png").is_file()
    assert text.index("(run_diagram.svg)") < text.index("(run.png)")
    assert (tmp_path / "run_diagram.svg").read_text(encoding="utf-8").startswith("<svg")


def test_ticks_of_clocks_are_counted_in_a_report_and_not_listed() -> None:
    run = simulate(compile(read_text(SAMPLED)))
    page = report(run).markdown()
    assert "101 ticks of the clocks of sampled blocks are left out." in page
    assert page.count("clock of held") == 0
    assert page.count("clock of events") == 3
    alone = replace(run, events=tuple(e for e in run.events if "held" in e.guard))
    assert "The first 40 of 101." in report(alone).markdown()
    assert "left out" not in report(alone).markdown()


def test_the_caption_tells_blue_names_only_where_something_is_measured() -> None:
    plain = read_text(SAMPLED)
    assert "blue" not in diagram_figure(plain).caption
    measured = SAMPLED + "measured: {run: {file: a.csv, time: t, signals: {held: {column: x}}}}"
    assert "blue names are measured" in diagram_figure(read_text(measured)).caption


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("rotor.angle/1 - load.angle - -shaft.gap/2", "rotor.angle - load.angle + shaft.gap/2"),
        ("1*a + -2*b", "a - 2*b"),
        ("a - -(b - c)", "a + (b - c)"),
        ("-(-a)", "a"),
        ("a/2 - b", "a/2 - b"),
        ("clock of voltage", "clock of voltage"),
    ],
)
def test_a_guard_has_no_double_signs(text: str, told: str) -> None:
    assert tidy_formula(text) == told


def test_the_report_of_a_run_has_its_values_and_its_first_events() -> None:
    text = """\
span: [0, 6]
parameters: {limit: {value: 1, unit: cm}}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: sine, amplitude: 2, omega: 100}
events: [{when: x - limit, set: {x: x}}]
"""
    run = simulate(compile(read_text(text)))
    page = report(run).markdown()
    assert "| limit | 1 | cm |" in page  # as it is written in the file
    assert "| start of x | 0 | m |" in page
    assert f"The first 40 of {len(run.events)}." in page
    assert page.count("| reset |") <= 40 < len(run.events)
