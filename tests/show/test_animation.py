"""A film shows each part where its formulas put it, at the pace that was asked for."""

from __future__ import annotations

import math
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.show import animate, frame_times
from tracewire.show import animation as animation
from tracewire.show.scene import extent_of, moved_parts
from tracewire.solve import Run, simulate

SWING = """\
title: A swing worth $5 <b>
span: [0, 2]
parameters: {l: 0.5}
blocks:
  phi: {type: expression, formula: 1.5*cos(3*t)}
  x: {type: integrator, of: phi}
scene:
  - ground: {at: [0, 0], length: 0.4, angle: pi}
  - rod: {from: [0, 0], to: [l*sin(phi), -l*cos(phi)]}
  - disc: {at: [l*sin(phi), -l*cos(phi)], radius: 0.06, color: green, angle: phi}
  - box: {at: [0, 0.2], width: 0.1, height: 0.1 + 0.05*sin(t), angle: t}
  - spring: {from: [0, 0.2], to: [l*sin(phi), -l*cos(phi)], coils: 5}
  - trace: {at: [l*sin(phi), -l*cos(phi)], seconds: 0.5, color: pink}
"""
GREEN = (0, 0x9E, 0x73)


def run_of(text: str = SWING, **options: object) -> Run:
    model = compile(read_text(text))
    return simulate(compile(model.diagram, model.read_by_scene), **options)  # type: ignore[arg-type]


RUN = run_of(SWING)


def middle_of(picture: Image.Image, color: tuple[int, int, int]) -> tuple[float, float]:
    """The mean column and row of the pixels of a colour."""
    pixels = np.asarray(picture.convert("RGB")).astype(int)
    rows, columns = np.nonzero(np.abs(pixels - color).sum(axis=2) < 12)
    assert len(rows) > 20
    return float(columns.mean()), float(rows.mean())


def test_a_disc_moves_as_its_formula_says(tmp_path: Path) -> None:
    path = animate(RUN, tmp_path / "a.gif", fps=10, width=300)
    times = frame_times(RUN.model, (0, 2), path, fps=10)
    with Image.open(path) as film:
        found = np.array([middle_of(frame, GREEN) for frame in ImageSequence.Iterator(film)])
    assert len(found) == len(times) == 21
    phi = 1.5 * np.cos(3 * times)
    true = np.column_stack([0.5 * np.sin(phi), -0.5 * np.cos(phi)])
    left, right, _, _ = extent_of(moved_parts(RUN))
    scale = (right - left) / 300  # m per pixel
    moved = (found - found[0]) * [scale, -scale]
    assert np.abs(moved - (true - true[0])).max() < 3 * scale


@pytest.mark.parametrize(
    ("options", "pictures", "pause"),
    [({}, 51, 40), ({"speed": 0.5}, 101, 40), ({"fps": 30}, 67, 30), ({"speed": 2}, 26, 40)],
)
def test_a_film_runs_as_fast_as_it_says(
    tmp_path: Path, options: dict[str, float], pictures: int, pause: int
) -> None:
    path = animate(RUN, tmp_path / "a.gif", width=120, **options)  # type: ignore[arg-type]
    with Image.open(path) as film:
        pauses = [frame.info["duration"] for frame in ImageSequence.Iterator(film)]
        assert film.info["loop"] == 0
    assert sum(pauses) == pictures * pause  # pictures that are alike are one, with their time


def test_the_same_run_gives_the_same_film(tmp_path: Path) -> None:
    first, second = (animate(RUN, tmp_path / name, width=150) for name in ("a.gif", "b.gif"))
    assert first.read_bytes() == second.read_bytes()


def test_a_trace_is_the_last_of_the_way() -> None:
    from matplotlib.figure import Figure
    from tracewire.show.scene import add_part

    part = next(part for part in moved_parts(RUN) if part.kind == "trace")
    panel = Figure().subplots()
    (line,), update = add_part(panel, part, RUN.t, 1.0)
    update(500)  # at 1 s
    x, y = line.get_data()  # type: ignore[attr-defined]
    assert len(x) == 251
    assert (x[-1], y[-1]) == pytest.approx((0.5 * math.sin(1.5 * math.cos(3)), y[-1]))
    update(10)
    assert len(line.get_data()[0]) == 11  # type: ignore[attr-defined]


def test_a_spring_goes_from_its_begin_to_its_end_to_both_sides() -> None:
    from matplotlib.figure import Figure
    from tracewire.show.scene import add_part

    part = next(part for part in moved_parts(RUN) if part.kind == "spring")
    (line,), update = add_part(Figure().subplots(), part, RUN.t, 1.0)
    update(300)
    wire = np.column_stack(line.get_data())  # type: ignore[attr-defined]
    begin, end = part.points["from"][300], part.points["to"][300]
    assert (wire[0], wire[-1]) == (pytest.approx(begin), pytest.approx(end))
    way = (end - begin) / np.hypot(*(end - begin))
    aside = (wire - begin) @ np.array([-way[1], way[0]])
    assert (aside.max(), aside.min()) == (pytest.approx(0.025), pytest.approx(-0.025))
    assert int((np.diff(np.sign(aside[np.abs(aside) > 0.01])) != 0).sum()) == 9  # of 5 coils


def test_the_extent_holds_what_is_turned() -> None:
    text = "span: [0, 1]\nblocks: {x: {type: integrator, of: x}}\nscene:\n"
    part = "  - ground: {at: [0, 0], length: 2, angle: pi/2}\n"
    left, right, bottom, top = extent_of(moved_parts(run_of(text + part)))
    assert right - left < 0.6 < 2 < top - bottom < 2.6


MP4 = pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg here")


@MP4
def test_a_film_as_mp4(tmp_path: Path) -> None:
    path = animate(RUN, tmp_path / "a.mp4", width=201, fps=20)
    assert path.read_bytes()[4:8] == b"ftyp"
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries"]
    command += ["stream=nb_read_frames,width", "-of", "csv=p=0", str(path)]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert told.strip() == "200,41"


def test_an_mp4_needs_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(animation.shutil, "which", lambda name: None)  # type: ignore[attr-defined]
    with pytest.raises(OptionError, match="made by the program ffmpeg, which is not installed"):
        animate(RUN, tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(shutil.which("false") is None, reason="no program `false` here")
def test_an_ffmpeg_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "ffmpeg").write_text("#!/bin/sh\necho no such codec >&2\nexit 1\n")
    (tmp_path / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    with pytest.raises(OptionError, match=r"ffmpeg could not make '.*a.mp4': no such codec"):
        animate(RUN, tmp_path / "a.mp4")
    assert not (tmp_path / "a.mp4").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"speed": 0}, "a film with speed 0 and 25 pictures in a second cannot be made"),
        ({"fps": 1000}, "fps from 1 to 100"),
        ({"width": 5}, "a picture cannot be 5 pixels wide. Give a width from 100 to 2000"),
        ({"speed": 0.001}, "has 50001 pictures. At most 5000 are made: give a shorter span"),
    ],
)
def test_what_cannot_be_filmed_is_told(
    tmp_path: Path, options: dict[str, float], message: str
) -> None:
    with pytest.raises(OptionError, match=message):
        animate(RUN, tmp_path / "a.gif", **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("coils: 5", "coils: 1e9", "<text>:12:5: a spring with 1e\\+09 coils cannot be drawn"),
        ("coils: 5", "coils: 0", "Give it 1 to 100"),
        ("at: [0, 0]", "at: [1e308, 0]", "the scene reaches as far as 1e\\+308 m, and cannot be"),
        ("length: 0.4", "length: 1e308", "the scene reaches as far as"),
    ],
)
def test_a_size_that_cannot_be_drawn_is_told(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    with pytest.raises(OptionError, match=message):
        animate(run_of(SWING.replace(old, new)), tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("at", ["[0, 0]", "[1e6, 0]", "[0, 1e-30]"])
def test_a_point_alone_is_drawn(tmp_path: Path, at: str) -> None:
    text = "span: [0, 1]\nblocks: {x: {type: integrator, of: x}}\nscene:\n"
    run = run_of(f"{text}  - disc: {{at: {at}, radius: x}}\n")
    with Image.open(animate(run, tmp_path / "a.gif", width=100)) as film:
        assert film.n_frames == 26  # type: ignore[attr-defined]  # the clock goes on


def test_a_span_that_is_empty_is_told() -> None:
    for span in ((3.0, 1.0), (1.0, 1.0), (math.nan, 1.0)):
        with pytest.raises(OptionError, match=r"the span from .* to 1 s is empty"):
            frame_times(RUN.model, span, "a.gif")


def test_another_ending_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"ending of a film '\.avi'; there are: \.gif, \.mp4"):
        animate(RUN, tmp_path / "a.avi")


def test_a_diagram_without_a_scene_is_told(tmp_path: Path) -> None:
    run = run_of(SWING.split("scene:")[0])
    for wrong in (run, replace(run, model=None)):
        with pytest.raises(OptionError, match="has no scene: nothing says how it is drawn"):
            animate(wrong, tmp_path / "a.gif")


def test_a_signal_that_was_not_recorded_is_told(tmp_path: Path) -> None:
    run = simulate(compile(read_text(SWING)))
    with pytest.raises(
        OptionError, match="the scene reads 'phi', which the run did not record"
    ) as e:
        animate(run, tmp_path / "a.gif")
    assert "compile(diagram, record=['phi'])" in str(e.value)


def test_a_value_that_is_not_finite_is_told_with_its_line(tmp_path: Path) -> None:
    run = run_of(SWING.replace("radius: 0.06", "radius: 1/(t - t)"))
    message = "<text>:10:5: a disc of the scene cannot be drawn: '1/.*' is not finite"
    with pytest.raises(OptionError, match=message):
        animate(run, tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []
