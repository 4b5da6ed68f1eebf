"""The page on libraries, followed word by word: make a library, build and install it, use it."""

from __future__ import annotations

import re
import runpy
import shlex
import zipfile
from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder
from tracewire.cli import main

PAGE = (Path(__file__).parents[1] / "docs" / "libraries.md").read_text(encoding="utf-8")
COMMANDS = [
    line
    for block in re.findall(r"```shell\n(.*?)```", PAGE, flags=re.DOTALL)
    for line in block.splitlines()
]


def fenced(language: str) -> str:
    (found,) = re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)
    return str(found)


def install(project: Path, site: Path) -> None:
    """What pip does with a project: build its wheel, and unpack it on the path of Python."""
    (wheel,) = WheelBuilder(str(project)).build(directory=str(site), versions=["standard"])
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(site)


def run_tests(folder: Path) -> int:
    """Run all tests of a folder; how many there are."""
    tests = [
        test
        for file in folder.rglob("test_*.py")
        for name, test in runpy.run_path(str(file)).items()
        if name.startswith("test_")
    ]
    for test in tests:
        test()
    return len(tests)


@pytest.mark.slow
def test_the_commands_of_the_page_work_in_their_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site, here = tmp_path / "site", tmp_path / "here"
    site.mkdir()
    here.mkdir()
    monkeypatch.syspath_prepend(site)
    monkeypatch.chdir(here)
    tested = 0
    for command in COMMANDS:
        words = shlex.split(command)
        if words[0] == "cd":
            monkeypatch.chdir(words[1])
        elif words[:4] == ["python", "-m", "pip", "install"]:
            install(Path.cwd(), site)
            # an editable install: files that are added to the folder count at once
            (site / "mylab_blocks").rename(tmp_path / "copied")
            monkeypatch.syspath_prepend(Path.cwd())
            Path("mylab_blocks", "magnets.py").write_text(fenced("python"), encoding="utf-8")
            Path("rig.yaml").write_text(fenced("yaml"), encoding="utf-8")
        elif words == ["python", "-m", "pytest"]:
            tested += run_tests(Path("tests"))
        else:
            assert words[0] == "tracewire"
            assert main(words[1:]) == 0, command
    assert tested == 2
    assert {path.name for path in (tmp_path / "copied").iterdir()} >= {"masses.yaml", "springs.py"}
    assert Path("rig.png").stat().st_size > 0
    page = Path("mylab.html").read_text(encoding="utf-8")
    assert re.findall("<h2>(.*?)</h2>", page) == [
        "What there is",
        "mylab.magnet",
        "mylab.hard_spring",
        "sprung_mass",
    ]
