"""What the README and the pages in docs say can be done is done here, in a copy of the diagrams."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest
from tracewire.cli import main
from tracewire.diagram import read_text

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [README, *(page.read_text(encoding="utf-8") for page in sorted(ROOT.glob("docs/*.md")))]
MOST_LINES = 150


def fenced(language: str, page: str = README) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page, flags=re.DOTALL)


COMMANDS = [
    line.split("#")[0].strip()
    for page in PAGES
    for block in fenced("sh", page)
    for line in block.splitlines()
    if line.startswith("tracewire ")
]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copytree(ROOT / "diagrams", tmp_path / "diagrams")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_pages_show_every_kind_of_example() -> None:
    verbs = {shlex.split(command)[1] for command in COMMANDS}
    assert verbs >= {"blocks", "check", "show", "draw", "run", "fit", "trace", "analyse", "sweep"}
    assert len(fenced("python")) == len(fenced("yaml")) == 1


def test_the_readme_is_short() -> None:
    assert len(README.splitlines()) <= MOST_LINES


@pytest.mark.parametrize("link", re.findall(r"\]\(([^)\s]+)\)", README))
def test_links_of_the_readme_lead_to_files(link: str) -> None:
    assert (ROOT / link.split("#")[0]).exists()


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_of_the_pages_works(here: Path, command: str) -> None:
    words = shlex.split(command)[1:]
    assert main(words) == 0
    for option in ("--output" if words[0] == "paper" else "--figure", "--report"):
        if option in words:
            assert (here / words[words.index(option) + 1]).stat().st_size > 0


@pytest.mark.slow
def test_the_python_example_of_the_readme_works(here: Path) -> None:
    example = compile(fenced("python")[0], "README.md", "exec")
    exec(example, {})
    assert (here / "trace.html").is_file()


@pytest.mark.slow
def test_the_examples_of_the_page_on_python_work(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names: dict[str, object] = {}
    for example in fenced("python", (ROOT / "docs/python.md").read_text(encoding="utf-8")):
        exec(compile(example, "python.md", "exec"), names)
    assert names["integrator"].t == 5.0  # type: ignore[attr-defined]
    assert names["more"].start.tolist()[0] == 0.3  # type: ignore[attr-defined]
    assert names["fitted"].values["c"] == pytest.approx(0.1, rel=1e-3)  # type: ignore[attr-defined]
    assert "<Run: Pendulum" in capsys.readouterr().out
    assert all((here / figure).is_file() for figure in ("run.png", "bench.svg"))


def test_the_diagram_of_the_readme_is_the_shipped_one() -> None:
    lesson = ROOT / "diagrams/lessons/pendulum.yaml"
    shown = read_text(fenced("yaml")[0], lesson)
    shipped = read_text(lesson.read_text(encoding="utf-8"), lesson)
    assert list(shown.blocks) == list(shipped.blocks)
    assert {n: v.formula for n, v in shown.parameters.items()} == {
        n: v.formula for n, v in shipped.parameters.items()
    }


def test_every_picture_of_the_readme_is_there() -> None:
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", README)
    assert len(pictures) == 4
    assert all((ROOT / picture).is_file() for picture in pictures)
