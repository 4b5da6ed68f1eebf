"""`tracewire paper` with --figure, --figures and --table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tracewire.paper import figure_of


def test_a_figure_is_written_where_it_is_asked_for(call: Any, tmp_path: Path) -> None:
    target = tmp_path / "orbit.svg"
    told = call("paper", "c", "--figure", "33", "--output", target)
    assert (told.code, told.out) == (0, f"written: {target}\n")
    assert target.stat().st_size > 1000


def test_without_a_file_it_is_png_and_svg_by_its_number(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    told = call("paper", "c", "--figure", "18", "--json")
    assert told.code == 0
    (row,) = told.data["figures"]
    assert row["written"] == ["c_18.png", "c_18.svg"]
    assert row["diagram"] == "c_review/c25_coupled_pendulums.yaml"
    assert all((tmp_path / name).stat().st_size > 1000 for name in row["written"])


def test_all_figures_of_a_paper_go_into_a_folder(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    some = (figure_of("c", "5"), figure_of("c", "41"))
    monkeypatch.setattr("tracewire.paper.figures_of", lambda paper: some)
    told = call("paper", "c", "--figures", "--output", tmp_path / "all")
    assert told.code == 0
    made = {file.name for file in (tmp_path / "all").iterdir()}
    assert made == {"c_5.png", "c_5.svg", "c_41.png", "c_41.svg"}


def test_full_asks_for_as_much_as_the_paper(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def draw(figure: object, paths: object, amount: str, progress: object) -> None:
        asked.append(amount)

    monkeypatch.setattr("tracewire.paper.draw.draw", draw)
    target = tmp_path / "six.png"
    assert call("paper", "b", "--figure", "6", "--output", target).code == 0
    assert call("paper", "b", "--figure", "6", "--full", "--output", target).code == 0
    assert asked == ["usual", "full"]


def test_the_page_says_where_it_is(
    call: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.paper.page.pictures", lambda: (figure_of("c", "20"),))
    told = call("paper", "--table", "--output", tmp_path / "page.md")
    assert (told.code, told.out) == (0, f"written: {tmp_path / 'page.md'}\n")
    assert "| C20 |" in (tmp_path / "page.md").read_text(encoding="utf-8")
    assert (tmp_path / "gallery" / "c_20.png").stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ("c", "--figure", "1"),
            "there is no figure '1' of paper C that its models produce. There",
        ),
        (("d", "--figure", "1"), "unknown paper 'd'; there are: a, b, c"),
        (("c", "--figure", "33", "--output", "orbit.txt"), "'orbit.txt': unknown file ending"),
        (("c", "--figure", "33", "--output", "nowhere/x.png"), "there is no folder 'nowhere'"),
        ((), "nothing is asked for"),
    ],
)
def test_wrong_arguments_are_told(call: Any, arguments: tuple[str, ...], said: str) -> None:
    told = call("paper", *arguments)
    assert (told.code, told.out) == (2, "")
    assert said in told.err


def test_help_has_examples(call: Any) -> None:
    told = call("paper", "--help")
    assert told.code == 0
    assert all(word in told.out for word in ("--figure", "--figures", "--full", "Example"))
