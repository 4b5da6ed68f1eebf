"""`animate`: a film from the command line, and every shipped scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.show.scene import extent_of, moved_parts
from tracewire.solve import simulate

DIAGRAMS = Path(__file__).parents[2] / "diagrams"
SCENES = [
    file for file in sorted(DIAGRAMS.rglob("*.yaml")) if "\nscene:" in file.read_text("utf-8")
]
SCENE = "scene: [{disc: {at: [sin(theta), column], radius: 0.1}}]\n"


@pytest.fixture(autouse=True)
def _here(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def scene(swing: Path) -> Path:
    with swing.open("a", encoding="utf-8") as file:
        file.write(SCENE)
    return swing


def test_a_film_goes_into_this_folder(call: Any, scene: Path, tmp_path: Path) -> None:
    told = call("animate", scene, "--span", "0", "1", "--fps", "10", "--width", "120")
    assert (told.code, told.out, told.err) == (0, "written: swing.gif\n", "")
    with Image.open(tmp_path / "swing.gif") as film:
        assert film.width == 120
        assert film.n_frames == 11  # type: ignore[attr-defined]


def test_the_values_of_the_command_move_the_film(call: Any, scene: Path, tmp_path: Path) -> None:
    few = ("--span", "0", "1", "--fps", "5", "--width", "120", "--output")
    options: dict[str, tuple[str, ...]] = {
        "a.gif": (),
        "b.gif": ("--set", "phi=10 deg"),
        "c.gif": ("--preset", "free"),
        "d.gif": ("--start", "theta=-1"),
    }
    for name, more in options.items():
        data = call("animate", scene, *few, name, *more, "--json").data
        assert data == {"written": [name], "pictures": 6, "span": [0.0, 1.0]}
    assert len({(tmp_path / name).read_bytes() for name in options}) == 4


def test_a_film_as_a_measured_series_has_its_time(call: Any, scene: Path) -> None:
    data = call("animate", scene, "--series", "run_1", "--fps", "5", "--json").data
    assert data["span"] == [1.0, 2.0]


def test_what_is_wrong_is_told_before_the_run(call: Any, swing: Path, scene: Path) -> None:
    for options, message in (
        (
            ("--output", "a.avi"),
            "'a.avi': unknown file ending '.avi'. End the name of the film in .gif or .mp4",
        ),
        (("--speed", "-1"), "a film with speed -1 and 25 pictures in a second cannot be made"),
        (("--width", "10"), "a picture cannot be 10 pixels wide"),
    ):
        told = call("animate", scene, *options)
        assert told.code == 2
        assert message in told.err
    swing.write_text(swing.read_text("utf-8").replace(SCENE, ""), encoding="utf-8")
    told = call("animate", swing)
    assert told.code == 2
    assert "swing.yaml' has no scene: nothing says how it is drawn" in told.err


def test_the_papers_and_the_lessons_have_scenes() -> None:
    assert len([file for file in SCENES if "c_review" in file.parts]) >= 10
    names = {"pendulum", "double_pendulum", "cart"}
    assert {file.stem for file in SCENES if "lessons" in file.parts} == names
    assert {"a_torsion", "b_triple"} < {file.parent.name for file in SCENES}


@pytest.mark.parametrize("file", SCENES, ids=lambda file: file.stem)
def test_a_shipped_scene_moves_and_stays_within_sight(file: Path) -> None:
    plain = compile(read(file))
    run = simulate(compile(plain.diagram, plain.read_by_scene))
    parts = moved_parts(run)
    left, right, bottom, top = extent_of(parts)
    assert 0.1 < (top - bottom) / (right - left) < 5
    moves = max(
        float(points.std(axis=0).max()) for part in parts for points in part.points.values()
    )
    assert moves > 0.005 * max(right - left, top - bottom)
