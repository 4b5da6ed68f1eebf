"""Figures are files with something in them, and say in words what they cannot draw."""

from __future__ import annotations

import struct
import xml.etree.ElementTree as ElementTree
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.show import plot_run
from tracewire.show.event_rows import draw_events, event_rows, is_tick, jump_times
from tracewire.show.figures import group_signals
from tracewire.show.sticking import held_intervals, join_intervals, stick_intervals
from tracewire.show.style import panels, styled, with_gaps
from tracewire.show.summary import run_table
from tracewire.solve import Event, Run, Statistics, simulate

T = np.linspace(0.0, 4.0, 81)


def run_of(signals: dict[str, tuple[str, Any]], events: tuple[Event, ...] = ()) -> Run:
    return Run(
        title="A run worth $5",
        t=T,
        signals={name: np.asarray(values, dtype=float) for name, (_, values) in signals.items()},
        units={name: unit for name, (unit, _) in signals.items()},
        events=events,
        parameters={},
        start={},
        final={},
        statistics=Statistics(1, 0, 1, 0, 0.0),
    )


def event(time: float, kind: Any, block: str) -> Event:
    return Event(time, kind, block, f"guard of {block}", "", {}, {})


def pixels(path: Path) -> tuple[int, int, set[bytes]]:
    """Width, height and the distinct rows of a PNG file, read without the library that wrote it."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", data[16:24])
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        packed += data[at + 8 : at + 8 + length] if kind == b"IDAT" else b""
        at += 12 + length
    raw = zlib.decompress(packed)
    size = len(raw) // height
    return width, height, {raw[n * size : (n + 1) * size] for n in range(height)}


def texts(path: Path) -> str:
    """The comments that an SVG file has before each text: the text itself."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    root = ElementTree.parse(path, parser).getroot()
    return "\n".join(
        str(node.text)
        for node in root.iter(ElementTree.Comment)  # type: ignore[arg-type]
    )


SWING = run_of(
    {"theta": ("rad", np.cos(3 * T)), "psi": ("rad", np.sin(T)), "x": ("m", 5 * T), "u": ("", T)},
    (event(0.5, "slip", "rub"), event(1.0, "stick", "rub"), event(2.0, "slip", "rub"),
     event(2.5, "impact", "stop"), event(3.0, "crossing", "gate"), event(3.5, "stick", "rub")),
)  # fmt: skip


def test_a_run_becomes_a_png_with_content(tmp_path: Path) -> None:
    width, height, rows = pixels(plot_run(SWING, tmp_path / "run.png"))
    assert width > 600
    assert height > 400
    assert len(rows) > height / 4  # an empty figure repeats a few rows


def test_a_figure_names_signals_units_events_and_title(tmp_path: Path) -> None:
    said = texts(plot_run(SWING, tmp_path / "run.svg"))
    for words in ("A run worth $5", "theta", "[rad]", "x [m]", "t [s]", "rub", "stop", "impact"):
        assert words in said


def test_the_same_run_gives_the_same_file(tmp_path: Path) -> None:
    first, second = plot_run(SWING, tmp_path / "a.svg"), plot_run(SWING, tmp_path / "b.svg")
    assert first.read_bytes() == second.read_bytes()


def test_drawing_leaves_the_global_style_alone(tmp_path: Path) -> None:
    before = dict(matplotlib.rcParams)
    plot_run(SWING, tmp_path / "run.png")
    assert dict(matplotlib.rcParams) == before


def test_signals_share_a_panel_when_unit_and_range_are_alike() -> None:
    run = run_of(
        {
            "a": ("rad", T),
            "b": ("m", T),
            "c": ("rad", 3 * T),
            "tiny": ("rad", 1e-3 * T),  # a flat line beside a
            "u": ("", T),
            "w": ("", T),  # no unit: it may be another quantity
        }
    )
    assert group_signals(run) == [["a", "c"], ["b"], ["tiny"], ["u"], ["w"]]


def test_a_panel_holds_four_lines_at_most() -> None:
    run = run_of({f"x{n}": ("m", T) for n in range(9)})
    assert [len(group) for group in group_signals(run)] == [4, 4, 1]


def test_many_panels_are_cut_and_the_title_says_so(tmp_path: Path) -> None:
    run = run_of({f"x{n}": ("", T) for n in range(18)})
    assert "the first 16 of 18 panels" in texts(plot_run(run, tmp_path / "run.svg"))


def test_a_constant_run_without_events_is_drawn(tmp_path: Path) -> None:
    assert plot_run(run_of({"x": ("m", 0 * T)}), tmp_path / "run.png").is_file()


def test_letters_without_a_glyph_do_not_stop_a_figure(tmp_path: Path) -> None:
    assert plot_run(run_of({"角度": ("", T)}), tmp_path / "run.png").is_file()


def test_stick_intervals_reach_from_the_start_and_to_the_end() -> None:
    assert stick_intervals(SWING) == {"rub": [(0.0, 0.5), (1.0, 2.0), (3.5, 4.0)]}


def test_stick_intervals_of_a_simulated_friction() -> None:
    """x'' = -x - F sign(x'), x(0) = 1.05, F = 0.1: after five half swings, at 5 pi, it sticks."""
    text = """\
span: [0, 20]
blocks:
  x: {type: integrator, of: v, start: 1.05}
  v: {type: integrator, of: force}
  spring: {type: gain, of: x, k: -1}
  rub: {type: coulomb, rate: v, level: 0.1}
  force: {type: sum, of: [spring, rub]}
"""
    found = stick_intervals(simulate(compile(read_text(text))))
    assert list(found) == ["rub"]
    assert found["rub"] == [pytest.approx((5 * np.pi, 20.0), abs=1e-5)]


CART = """\
span: [0, 4]
record: [x, v, rub, pull]
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: force}
  rub: {type: dry_friction, rate: v, slip: 1, stick: 1.5}
  pull: {type: expression, formula: t}
  force: {type: sum, of: [pull, rub]}
"""


def test_a_friction_holds_its_rate_the_position_and_its_own_force() -> None:
    """Pulled by t from rest, it slips where t is 1.5, and never stops again."""
    held = held_intervals(simulate(compile(read_text(CART))))
    assert set(held) == {"x", "v", "rub"}
    for intervals in held.values():
        assert intervals == [pytest.approx((0.0, 1.5), abs=1e-6)]


def test_a_guard_in_words_holds_the_friction_alone() -> None:
    held = held_intervals(run_of({"rub": ("N", T), "x": ("m", T)}, SWING.events))  # type: ignore[arg-type]
    assert held == {"rub": [(0.0, 0.5), (1.0, 2.0), (3.5, 4.0)]}


def test_intervals_that_touch_are_one() -> None:
    assert join_intervals([(2, 3), (0, 1), (1, 1.5), (3.25, 4)]) == [(0, 1.5), (2, 3), (3.25, 4)]
    assert join_intervals([(2, 3), (0, 1), (3.25, 4)], apart=0.25) == [(0, 1), (2, 4)]


def test_an_event_strikes_the_panels_of_the_states_that_it_sets() -> None:
    bounce = Event(1.0, "impact", "ball", "x", "down", {"x": 0.0, "v": -2.0}, {"x": 0.0, "v": 2.0})
    stick = Event(2.0, "stick", "rub", "v", "", {"v": 1e-12}, {"v": 0.0})
    run = run_of({"x": ("m", T), "v": ("m/s", T)}, (bounce, bounce, stick))
    assert jump_times(run, ["v"]) == [1.0]
    assert jump_times(run, ["x"]) == []


def dark_columns(panel: Axes) -> list[int]:
    """The columns of pixels of a panel with something that is nearly as dark as a mark."""
    figure = panel.figure
    assert isinstance(figure, Figure)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    box = panel.get_window_extent()
    image = np.asarray(canvas.buffer_rgba())[::-1, :, :3].astype(int)
    inside = image[int(box.y0) + 3 : int(box.y1) - 3, int(box.x0) + 3 : int(box.x1) - 3]
    dark = (inside.min(axis=2) < 185).sum(axis=0) > 5
    return list(np.flatnonzero(dark))


def test_marks_in_close_pairs_are_all_seen() -> None:
    pairs = [0.0123 + 0.2 * n for n in range(1, 20)]
    times = [t for pair in pairs for t in (pair, pair + 0.0003)]
    panel = Figure().subplots()
    draw_events(
        panel, run_of({"x": ("m", T)}, tuple(event(t, "crossing", "y") for t in times)), ["y"]
    )
    panel.set_xlim(0, 4)
    columns = dark_columns(panel)
    apart = [n for n, at in enumerate(columns) if n == 0 or at > columns[n - 1] + 1]
    assert len(apart) == len(pairs)


def test_a_short_stick_is_a_bar_of_its_own_length_that_is_seen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bars: list[tuple[float, float]] = []
    draw = Axes.broken_barh

    def note(self: Axes, spans: Any, *given: Any, **look: Any) -> Any:
        bars.extend(spans)
        return draw(self, spans, *given, **look)

    monkeypatch.setattr(Axes, "broken_barh", note)
    short = (event(1.0, "stick", "rub"), event(1.0001, "slip", "rub"))
    panel = Figure().subplots()
    draw_events(panel, run_of({"x": ("m", T)}, short), ["rub"])
    panel.set_xlim(0, 4)
    assert bars == [(1.0, pytest.approx(1e-4))]
    columns = dark_columns(panel)
    assert 1 <= len(columns) <= 3


SAMPLED = """
title: A sampled block
span: [0, 1]
record: [held]
blocks:
  wave: {type: sine, amplitude: 1, omega: 20}
  held: {type: zero_order_hold, of: wave, period: {value: 10, unit: ms}}
  x: {type: integrator, of: held}
events: [{every: {value: 0.5, unit: s}, set: {x: 0}}]
"""


def test_ticks_of_a_sampled_block_are_short_and_grey(tmp_path: Path) -> None:
    run = simulate(compile(read_text(SAMPLED)))
    ticks = [event for event in run.events if is_tick(run, event)]
    assert len(ticks) == 101
    assert {event.block for event in ticks} == {"held"}
    declared = [event for event in run.events if event not in ticks]
    assert declared  # a reset that the diagram declares is none
    panel = Figure().subplots()
    draw_events(panel, replace(run, events=tuple(ticks)), ["held"])
    assert panel.get_title(loc="left") == "events   short, grey: tick"
    draw_events(panel, replace(run, events=tuple(declared)), event_rows(run))
    assert panel.get_title(loc="left") == "events   long, red: reset"


def test_a_long_curve_has_no_hole() -> None:
    steps = np.arange(10_001)
    with styled():
        figure, (panel,) = panels([2.4])
        panel.plot(steps, np.clip((steps - 4997) / 6, 0, 1))  # it rises where pieces would meet
        panel.set_axis_off()
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[:, :, :3].min(axis=2)
    seen = np.flatnonzero((image < 150).any(axis=1))
    assert len(seen) > 100
    assert (np.diff(seen) == 1).all()


def test_no_line_goes_over_a_gap_in_the_samples() -> None:
    t = np.r_[0.0:1.0:0.1, 60.0:61.0:0.1]
    x, y = with_gaps(t, np.sin(t))
    (hole,) = np.flatnonzero(np.isnan(y))
    assert (x[hole - 1], x[hole + 1]) == (t[9], t[10])
    np.testing.assert_array_equal(y[~np.isnan(y)], np.sin(t))
    for steady in (t[:10], np.cumsum([0.1, 1.9, 0.2, 0.1, 0.3])):
        np.testing.assert_array_equal(with_gaps(steady, steady), (steady, steady))


def test_a_curve_too_long_for_the_renderer_is_drawn_in_pieces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw = Figure.savefig

    def fail_once(self: Figure, *given: Any, **options: Any) -> None:
        if not matplotlib.rcParams["agg.path.chunksize"]:
            raise OverflowError("Exceeded cell block limit in Agg")
        draw(self, *given, **options)

    monkeypatch.setattr(Figure, "savefig", fail_once)
    assert pixels(plot_run(SWING, tmp_path / "run.png"))[0] > 500


def test_hundreds_of_events_are_counted_and_take_few_marks(tmp_path: Path) -> None:
    dense = [event(2.0 + n * 1e-4, "impact", "stop") for n in range(5000)]
    few = plot_run(run_of({"x": ("m", T)}, tuple(dense[:1])), tmp_path / "few.svg")
    many = plot_run(run_of({"x": ("m", T)}, tuple(dense)), tmp_path / "many.svg")
    assert "stop (5000)" in texts(many)
    assert len(many.read_bytes()) < 1.2 * len(few.read_bytes())


def test_run_table_has_start_end_and_extremes() -> None:
    rows = {row[0]: row[1:] for row in run_table(SWING).rows}
    assert rows["x"] == ("m", "0", "20", "0", "20")


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"unknown ending of a figure '.jpg'; there are: .pdf"):
        plot_run(SWING, tmp_path / "run.jpg")


def test_a_run_without_signals_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"no recorded signals to draw. Name signals under"):
        plot_run(run_of({}), tmp_path / "run.png")
