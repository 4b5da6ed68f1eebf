"""Figures of analyses: what they say, and what they refuse."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from analyse.models import DUFFING, LORENZ, MATHIEU, OSCILLATOR, PENDULUM, VAN_DER_POL, made
from show.test_figures import CART, pixels, texts
from tracewire import show
from tracewire.analyse import (
    Plane,
    Sweep,
    bifurcation,
    growth_rate,
    invariant_drift,
    lyapunov,
    periodic_orbit,
    scalogram,
    section,
    spectrum,
    stability_chart,
    sweep,
)
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.show.sticking import held_intervals
from tracewire.show.style import saved_figures
from tracewire.solve import simulate

RUN = simulate(made(PENDULUM, ("w",)), rtol=1e-8)
FORCED = simulate(made(OSCILLATOR), span=(0, 60), times=np.linspace(0, 60, 3001))


def test_a_portrait_names_its_axes(tmp_path: Path) -> None:
    said = texts(show.plot_portrait(RUN, "phi", "w", tmp_path / "a.svg"))
    assert all(words in said for words in ("Pendulum", "phi [rad]", "w [rad/s]"))
    width, height, rows = pixels(show.plot_portrait(RUN, "phi", "w", tmp_path / "a.png"))
    assert min(width, height) > 500
    assert len(rows) > height / 4
    for x, y in (("phi", "v"), ("v", "phi")):
        with pytest.raises(OptionError, match="unknown recorded signal 'v'"):
            show.plot_portrait(RUN, x, y, tmp_path / "a.svg")
    with pytest.raises(OptionError, match="there is no sample from 99 s on"):
        show.plot_portrait(RUN, "phi", "w", tmp_path / "a.svg", since=99)


def test_a_long_portrait_has_no_gap(tmp_path: Path) -> None:
    run = simulate(made(PENDULUM, ("w",)), span=(0, 20), times=np.linspace(0, 20, 12001))
    with saved_figures() as saved:
        show.plot_portrait(run, "phi", "w", tmp_path / "a.png")
    lines = [np.array(line.get_xydata()) for line in saved[-1].axes[0].lines]
    pieces = [points for points in lines if len(points) > 1]
    assert max(len(points) for points in pieces) < 10_000  # beyond that Matplotlib leaves a gap
    for one, following in pairwise(pieces):
        assert np.array_equal(one[-1], following[0])
    assert sum(len(points) - 1 for points in pieces) == 12000


def test_a_portrait_shows_what_sticks(tmp_path: Path) -> None:
    run = simulate(compile(read_text(CART)))
    assert "sticks" in texts(show.plot_portrait(run, "v", "rub", tmp_path / "a.svg"))
    assert "sticks" not in texts(show.plot_portrait(run, "v", "rub", tmp_path / "b.svg", since=2))
    begin, end = held_intervals(run)["rub"][0]
    seldom = simulate(compile(read_text(CART)), times=[0.0, (begin + end) / 2, end + 0.1])
    said = texts(
        show.plot_portrait(seldom, "v", "rub", tmp_path / "c.svg", since=(begin + end) / 2)
    )
    assert "sticks" not in said  # one sample is no line


def test_a_polar_orbit_is_seen_from_the_side(tmp_path: Path) -> None:
    said = texts(show.plot_polar(RUN, "energy", "phi", tmp_path / "a.svg"))
    assert "energy sin phi" in said
    assert "−energy cos phi" in said


def test_an_orbit_shows_period_verdict_and_multipliers(tmp_path: Path) -> None:
    found = periodic_orbit(made(VAN_DER_POL), 6.0, skip=2)
    said = texts(show.plot_orbit(found, tmp_path / "a.svg"))
    assert "period 6.66329 s, stable" in said
    assert "Floquet multipliers" in said
    with pytest.raises(OptionError, match="unknown state 'y'"):
        show.plot_orbit(found, tmp_path / "a.svg", "y")


def test_a_chart_names_its_parameters(tmp_path: Path) -> None:
    found = stability_chart(
        made(MATHIEU), ("a", np.linspace(0, 3, 9)), ("q", np.linspace(0, 1, 5)), "pi"
    )
    said = texts(show.plot_chart(found, tmp_path / "a.svg"))
    assert all(words in said for words in ("Mathieu", "unstable where coloured", "growth of dev"))
    one = stability_chart(made(MATHIEU), ("a", [1.0]), ("q", [0.5]), "pi")
    with pytest.raises(OptionError, match=r"a chart of 1 x 1 points is no picture"):
        show.plot_chart(one, tmp_path / "a.svg")
    calm = stability_chart(made(MATHIEU), ("a", [2.0, 2.1]), ("q", [0.0, 0.1]), "pi")
    show.plot_chart(calm, tmp_path / "a.svg")  # no colour, no edge


def test_a_bifurcation_diagram_tells_its_bands(tmp_path: Path) -> None:
    options: Any = {"direction": "down_up", "skip": 30, "keep": 20}
    found = bifurcation(
        made(DUFFING), "f", np.linspace(0.2, 0.4, 9), Plane(period="2*pi/omega"), **options
    )
    said = texts(show.plot_bifurcation(found, tmp_path / "a.svg", ["x"]))
    assert "values going up" in said
    assert "values going down" in said
    assert "irregular" in said
    show.plot_bifurcation(found, tmp_path / "a.png", ["x", "v"])
    with pytest.raises(OptionError, match="unknown state 'y'"):
        show.plot_bifurcation(found, tmp_path / "a.svg", ["y"])
    with pytest.raises(OptionError, match=r"18 panels make no figure. Name 1 to 4 states"):
        show.plot_bifurcation(found, tmp_path / "a.svg", ["x"] * 9)


def test_a_section_says_how_many_points_and_places(tmp_path: Path) -> None:
    found = section(made(DUFFING), Plane(period="2*pi/omega"), skip=100, keep=20,
                    parameters={"f": 0.1})  # fmt: skip
    said = texts(show.plot_section(found, tmp_path / "a.svg", "v", "x"))
    assert "20 points, 1 places" in said
    with pytest.raises(OptionError, match="unknown state 'y'"):
        show.plot_section(found, tmp_path / "a.svg", "x", "y")


def test_a_state_that_turns_is_drawn_within_a_turn(tmp_path: Path) -> None:
    from tracewire.show.bifurcation_figures import _turned

    values = np.array([0.1, 6.4, -6.0, 100 * math.pi + 0.2])
    expected = [0.1, 6.4 - 2 * math.pi, -6.0 + 2 * math.pi, 0.2]
    assert _turned(values, 2 * math.pi) == pytest.approx(expected)
    assert _turned(values, None) is values


def test_a_spectrum_names_its_line_and_plain_numbers(tmp_path: Path) -> None:
    times = np.linspace(0, 60, 3001)
    free = simulate(made(OSCILLATOR), parameters={"c": 0.0}, span=(0, 60), times=times, rtol=1e-9)
    said = texts(show.plot_spectrum(spectrum(free, "x"), tmp_path / "a.svg"))
    assert "0.3183 Hz" in said
    assert "amplitude of x [m]" in said
    assert "mathdefault" not in said
    nothing = spectrum(simulate(made(OSCILLATOR), start={"x": 0.0}), "x")
    with pytest.raises(OptionError, match="the spectrum of 'x' is zero"):
        show.plot_spectrum(nothing, tmp_path / "a.svg")


def test_a_scalogram_and_a_growth_have_plain_numbers(tmp_path: Path) -> None:
    said = texts(show.plot_scalogram(scalogram(FORCED, "x"), tmp_path / "a.svg"))
    assert "frequency [Hz]" in said
    assert "mathdefault" not in said
    said = texts(show.plot_growth(growth_rate(FORCED, "x"), tmp_path / "a.svg"))
    assert "exp(-0.05 t)" in said
    assert "mathdefault" not in said


def test_exponents_and_drifts_are_told(tmp_path: Path) -> None:
    found = lyapunov(made(LORENZ), 40, transient=5)
    said = texts(show.plot_lyapunov(found, tmp_path / "a.svg", "Lorenz"))
    assert "mean divergence -13.667 1/s" in said
    assert "Lorenz" in said
    drifts = invariant_drift(RUN, ["energy"])
    assert "drift of energy" in texts(show.plot_invariants(drifts, tmp_path / "a.svg"))
    with pytest.raises(OptionError, match="no invariant is there to draw"):
        show.plot_invariants((), tmp_path / "a.svg")


def test_a_sweep_is_a_line_or_a_map(tmp_path: Path) -> None:
    grid = {"k": np.linspace(1, 2, 3), "c": np.linspace(0, 1, 2), "omega": [1.0, 2.0]}
    model = made(OSCILLATOR)
    for names in (["k"], ["k", "c"]):
        found = sweep(model, {name: grid[name] for name in names}, ["max(x)", "count()"])
        said = texts(show.plot_sweep(found, tmp_path / "a.svg"))
        assert all(name in said for name in [*names, "max(x)", "count()"])
    with pytest.raises(OptionError, match="a sweep over 3 parameters is no picture"):
        show.plot_sweep(sweep(model, grid, ["count()"]), tmp_path / "a.svg")


def test_a_sweep_has_the_unit_of_its_axis_and_counts_are_whole(tmp_path: Path) -> None:
    model = made(OSCILLATOR.replace("{k: 4,", "{k: {value: 4, unit: N/m},"))
    found = sweep(model, {"k": [1.0, 2.0], "start.x": [0.5, 1.0]}, ["end(x)"])
    assert dict(found.units) == {"k": "N/m", "start.x": "m"}
    said = texts(show.plot_sweep(found, tmp_path / "a.svg"))
    assert "k [N/m]" in said and "start.x [m]" in said
    in_mm = made(OSCILLATOR.replace("unit: m}", "unit: mm}"))
    shown = sweep(in_mm, {"k": [1.0, 2.0]}, ["max(abs(x))", "count()"])
    assert shown.table().rows[0][:2] == ("max(abs(x))", "mm")
    assert float(shown.table().rows[0][2]) == pytest.approx(1e3 * shown["max(abs(x))"].min())
    assert "max(abs(x)) [mm]" in texts(show.plot_sweep(shown, tmp_path / "a.svg"))
    counted = Sweep("", {"k": np.arange(3.0)}, {"count()": np.array([1.0, 2.0, 4.0])})
    ticks = texts(show.plot_sweep(counted, tmp_path / "a.svg")).split()
    assert "4" in ticks and "1.5" not in ticks


def test_the_same_analysis_gives_the_same_file(tmp_path: Path) -> None:
    found = spectrum(FORCED, "x")
    first = show.plot_spectrum(found, tmp_path / "a.svg").read_bytes()
    assert show.plot_spectrum(found, tmp_path / "b.svg").read_bytes() == first
