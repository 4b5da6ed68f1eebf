"""Plot functions leave pictures behind, and never disturb the search that they show."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot
from show.fits import compared
from tracewire.fit import fminsearch, optimset
from tracewire.fit.optimset import OptimValues
from tracewire.show import live, optimplotfit, optimplotfval, optimplotx
from tracewire.show.live import FitPlot, LivePlot, PointPlot, ValuePlot

POINT = np.array([1.0, -2.0])


@pytest.fixture(autouse=True)
def nothing_stays_open() -> Iterator[None]:
    yield
    assert pyplot.get_fignums() == []
    live._RUNNING.clear()


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that stands, and is put forward by writing to its only entry; pictures cost none."""
    now = [0.0]
    monkeypatch.setattr(live.time, "perf_counter", lambda: now[0])
    return now


def values(iteration: int = 0, fval: float = 1.0) -> OptimValues:
    return OptimValues(iteration + 1, iteration, fval, "reflect")


def frames(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir())


@pytest.mark.parametrize("plot", [optimplotfval, optimplotx, optimplotfit])
def test_they_are_plot_functions_of_optimset(plot: LivePlot) -> None:
    assert optimset(PlotFcns=plot).plot_functions() == (plot,)
    assert plot.folder == Path("frames")


def test_a_search_leaves_its_last_picture_and_says_where_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plots = [ValuePlot(tmp_path / "new"), PointPlot(tmp_path / "new")]
    found = fminsearch(lambda x: float(np.sum(x**2)), POINT, optimset(PlotFcns=plots))
    plain = fminsearch(lambda x: float(np.sum(x**2)), POINT)
    assert (found.x == plain.x).all()
    for name in ("optimplotfval.png", "optimplotx.png"):
        assert (tmp_path / "new" / name).read_bytes().startswith(b"\x89PNG")
    said = capsys.readouterr().err
    assert said.count("optimplotfval: no display; the picture is saved as") == 1
    assert str(tmp_path / "new" / "optimplotfval.png") in said


def test_frames_come_ten_times_a_second_at_most(tmp_path: Path, clock: list[float]) -> None:
    plot = ValuePlot(tmp_path)
    plot(POINT, values(), "init")
    for n in range(1, 101):
        clock[0] = n / 50
        plot(POINT, values(n, 1 / n), "iter")
    plot(POINT, values(100, 0.01), "done")
    names = frames(tmp_path)
    assert names[0] == "optimplotfval.png"
    assert names[1:] == [f"optimplotfval_{n:04d}.png" for n in range(1, len(names))]
    assert 2 <= len(names) <= 1 + 20


def test_frames_thin_out_and_end(
    tmp_path: Path, clock: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[float] = []
    plot = ValuePlot(tmp_path)
    monkeypatch.setattr(plot, "_save", lambda *_: drawn.append(clock[0]))
    plot(POINT, values(), "init")
    for n in range(1, 20_000):
        clock[0] = 0.05 * n
        plot(POINT, values(n), "iter")
    gaps = np.diff(drawn)
    assert gaps[-1] > 5 * gaps[0]
    assert len(drawn) < live.LIVE.most_frames


def test_the_number_of_frames_is_limited(
    tmp_path: Path, clock: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live.LIVE, "most_frames", 3)
    plot = PointPlot(tmp_path)
    for n, state in zip(itertools.count(), ["init", *["iter"] * 20, "done"], strict=False):
        clock[0] = float(n)
        plot(POINT, values(n), state)
    assert len(frames(tmp_path)) == 3 + 1


def test_pictures_take_a_tenth_of_the_time_together(
    tmp_path: Path, clock: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two plots whose pictures cost 1 s each, in a search of 200 s."""
    counts = {"optimplotfval": 0, "optimplotx": 0}

    def draw(plot: LivePlot) -> None:
        clock[0] += 1.0
        counts[plot.name] += 1

    plots: list[LivePlot] = [ValuePlot(tmp_path), PointPlot(tmp_path)]
    for plot in plots:
        monkeypatch.setattr(plot, "_save", lambda *_, plot=plot: draw(plot))
        plot(POINT, values(), "init")
    n = 0
    while clock[0] < 200:
        clock[0] += 0.01
        n += 1
        for plot in plots:
            plot(POINT, values(n), "iter")
    assert sum(counts.values()) <= 0.1 * clock[0] + 1
    assert min(counts.values()) >= 5  # none takes the time of the other


def test_a_new_search_replaces_the_frames_of_the_last(tmp_path: Path, clock: list[float]) -> None:
    (tmp_path / "optimplotx_final.png").write_bytes(b"of the user")
    plot = PointPlot(tmp_path)
    for rounds in (5, 2):
        for n, state in zip(itertools.count(), ["init", *["iter"] * rounds], strict=False):
            clock[0] += 10.0 * (n > 0)
            plot(POINT, values(n), state)
        plot(POINT, values(rounds), "done")
    assert frames(tmp_path) == [
        "optimplotx.png", "optimplotx_0001.png", "optimplotx_0002.png", "optimplotx_final.png",
    ]  # fmt: skip


def test_the_values_of_another_search_are_forgotten(tmp_path: Path) -> None:
    plot = ValuePlot(tmp_path)
    for fval in (5.0, 3.0):
        for n, state in enumerate(("init", "iter", "done")):
            plot(POINT, values(min(n, 1), fval), state)
        assert plot._values == [fval, fval]
        assert plot._iterations == [0, 1]


def test_a_search_that_was_cut_short_is_forgotten(tmp_path: Path, clock: list[float]) -> None:
    """Nobody told that it is done; the next one begins again at its first iteration."""
    plot = ValuePlot(tmp_path)
    for state, iteration in (("init", 0), ("iter", 1), ("iter", 2), ("iter", 1)):
        plot(POINT, values(iteration, 7.0), state)
    assert plot._iterations == [1]


def test_a_folder_that_cannot_be_written_is_told_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    plot = ValuePlot(tmp_path / "file")
    found = fminsearch(lambda x: float(np.sum(x**2)), POINT, optimset(PlotFcns=plot))
    assert found.exitflag == 1
    said = capsys.readouterr().err
    assert said.startswith("optimplotfval draws no more pictures: ")
    assert f"'{tmp_path / 'file'}' cannot be written: " in said
    assert said.count("\n") == 1


def test_a_picture_that_fails_does_not_end_the_search(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    plot = FitPlot(tmp_path)

    def broken() -> tuple[()]:
        raise ValueError("no such series")

    for state in ("init", "iter", "done"):
        plot(POINT, OptimValues(1, 0, 1.0, "", broken), state)
    said = capsys.readouterr().err
    assert said == "optimplotfit draws no more pictures: no such series\n"


def test_a_fit_is_drawn_beside_its_data(tmp_path: Path) -> None:
    plot = FitPlot(tmp_path)
    series = (compared("hold", "validate"), *(compared(f"run_{n}") for n in range(5)))
    plot(POINT, OptimValues(9, 3, 0.5, "", lambda: series), "done")
    assert (tmp_path / "optimplotfit.png").read_bytes().startswith(b"\x89PNG")
    assert [c.series for c in live._chosen(series)] == ["run_0", "run_1", "run_2", "run_3"]


def test_a_search_without_data_is_told_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plot = FitPlot(tmp_path)
    fminsearch(lambda x: float(np.sum(x**2)), POINT, optimset(PlotFcns=plot))
    said = capsys.readouterr().err
    assert said == (
        "optimplotfit works in a fit only: a search of a function has no measured data\n"
    )
    assert frames(tmp_path) == []


def test_values_that_are_no_numbers_are_drawn(tmp_path: Path) -> None:
    plot = ValuePlot(tmp_path)
    plot(POINT, values(0, float("inf")), "init")
    plot(POINT, values(1, float("nan")), "done")
    assert (tmp_path / "optimplotfval.png").is_file()
