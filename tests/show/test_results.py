"""Every result shows itself the same way: a table, a figure, text, data, a line, a notebook."""

from __future__ import annotations

import json
import math
import re
import sys
import xml.etree.ElementTree as ET
from base64 import b64decode
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from analyse.models import DUFFING, LORENZ, MATHIEU, OSCILLATOR, PENDULUM, VAN_DER_POL, made
from matplotlib.figure import Figure
from show.fits import made_fit
from show.traces import FOUND, NULL
from tracewire.errors import InstallationError, OptionError
from tracewire.result import Result, plain
from tracewire.show.notebook import figure_image, svg_image
from tracewire.show.presentation import FILES
from tracewire.show.table import Table


@cache
def free() -> tw.Run:
    times = np.linspace(0, 60, 3001)
    return tw.simulate(made(OSCILLATOR), parameters={"c": 0.0}, times=times, span=(0, 60))


RESULTS: dict[str, Callable[[], Result]] = {
    "Run": free,
    "Runs": lambda: tw.simulate_many(made(OSCILLATOR), [{"k": 1.0}, {"k": 2.0}]),
    "Fit": made_fit,
    "Found": lambda: FOUND,
    "SteadyState": lambda: tw.steady_state(made(PENDULUM), guess={"phi": 3.0}),
    "Linear": lambda: tw.linearise(made(PENDULUM)),
    "Floquet": lambda: tw.floquet(made(MATHIEU), "pi"),
    "PeriodicOrbit": lambda: tw.periodic_orbit(made(VAN_DER_POL), 6.0, skip=2),
    "StabilityChart": lambda: tw.stability_chart(
        made(MATHIEU), ("a", [1.0, 2.0]), ("q", [0.5, 1.0]), "pi"
    ),
    "PoincareSection": lambda: tw.section(made(DUFFING), {"period": "2*pi/omega"}, keep=20),
    "Bifurcation": lambda: tw.bifurcation(
        made(DUFFING), "omega", [1.0, 1.1], {"period": "2*pi/omega"}, skip=5, keep=8
    ),
    "Lyapunov": lambda: tw.lyapunov(made(LORENZ), 5, transient=1),
    "Spectrum": lambda: tw.spectrum(free(), "x"),
    "Scalogram": lambda: tw.scalogram(free(), "x"),
    "GrowthRate": lambda: tw.growth_rate(free(), "x"),
    "Drift": lambda: tw.invariant_drift(free(), ["energy"])[0],
    "Sweep": lambda: tw.sweep(made(OSCILLATOR), {"k": [1.0, 2.0]}, ["max(x)"]),
}
WITHOUT_TABLE = {"StabilityChart", "Scalogram", "GrowthRate"}
WITHOUT_FIGURE = {"Runs", "SteadyState", "Linear", "Floquet"}


@cache
def result(name: str) -> Result:
    return RESULTS[name]()


def test_every_kind_of_result_is_presented() -> None:
    kinds = {
        kind.__name__
        for file in FILES.values()
        for kind in import_module(f"tracewire.show.{file}").PRESENTATIONS
    }
    assert kinds == {*RESULTS, "Profile"} == {kind.__name__ for kind in Result.__subclasses__()}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_a_line_and_data(name: str) -> None:
    shown = repr(result(name))
    assert shown.startswith(f"<{name}: ")
    assert len(shown) < 400 and "\n" not in shown
    assert json.loads(json.dumps(result(name).json(), allow_nan=False))


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_a_table_and_text(name: str) -> None:
    given = result(name)
    if name in WITHOUT_TABLE:
        with pytest.raises(OptionError, match=rf"a {name} has no table\. text\(\) says"):
            given.table()
        assert given.text()
        return
    table = given.table()
    assert isinstance(table, Table) and table.rows
    assert str(table) in given.text()
    assert table.html() in given._repr_html_()


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_a_figure_that_is_not_saved(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    if name in WITHOUT_FIGURE:
        with pytest.raises(OptionError, match=rf"a {name} has no figure\. table\(\) and text\(\)"):
            result(name).plot()
        return
    figure = result(name).plot()
    assert isinstance(figure, Figure) and figure.axes
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_shows_curves_above_the_tables_of_runs_fits_and_traces(name: str) -> None:
    shown = result(name)._repr_html_()
    if name not in ("Run", "Fit", "Found"):
        assert "<img" not in shown
        return
    assert shown.index("<img") < shown.index("<table")
    for kind, data in re.findall(r'src="data:image/([^;]+);base64,([^"]+)"', shown):
        content = b64decode(data)
        assert kind in ("svg+xml", "png") and b"<script" not in content
        if kind == "svg+xml":
            assert ET.fromstring(content).tag.endswith("svg")


def test_a_notebook_shows_the_picture_of_a_trace_with_its_effect_in_colour() -> None:
    shown = result("Found")._repr_html_()
    picture, *curves = [b64decode(data) for data in re.findall(r'base64,([^"]+)"', shown)]
    assert b'class="block effect"' in picture
    assert len(curves) == 1
    assert NULL._repr_html_().count("<img") == 2


def test_a_notebook_shows_a_run_of_very_many_samples_as_pixels() -> None:
    noise = np.random.default_rng(1).normal(size=200_000)
    run = replace(free(), t=np.arange(200_000.0), signals={"x": noise})
    assert 'src="data:image/png;base64,' in figure_image(run.plot())


def test_a_notebook_shows_a_run_that_records_nothing_without_curves() -> None:
    assert "<img" not in replace(free(), signals={})._repr_html_()


def test_a_title_is_text_in_the_html_of_a_notebook() -> None:
    assert 'alt="&lt;b&gt; &quot;c&quot;"' in svg_image("<svg/>", '<b> "c"')


def test_a_notebook_shows_a_figure_and_a_file_takes_it(tmp_path: Path) -> None:
    figure = result("Run").figure()
    assert figure._repr_png_().startswith(b"\x89PNG")
    figure.savefig(tmp_path / "run.svg")
    assert (tmp_path / "run.svg").stat().st_size > 1000


def test_a_figure_has_the_options_of_its_function() -> None:
    run = result("Run")
    measured = tw.Measured("bench", "train", [0, 30, 60], {"x": [1, 0, 1]})
    dots = run.plot(measured=measured).axes[0].lines[0]
    assert dots.get_xdata().tolist() == [0, 30, 60]
    with pytest.raises(OptionError, match=r"unknown option of the figure 'measurd'.*'measured'"):
        run.plot(measurd=measured)


def test_a_trace_without_an_effect_is_drawn_too() -> None:
    assert NULL.plot().axes


def test_a_table_is_text() -> None:
    table = Table("balls", ("name", "mass"), (("golf", "4.6"), ("tennis", "58")), frozenset({1}))
    assert str(table) == "balls\nname    mass\n------------\ngolf     4.6\ntennis    58"
    assert "<td>golf</td>" in table._repr_html_()
    assert "&lt;b&gt;" in Table("<b>", ("a",), ()).html()


def test_plain_data() -> None:
    data: dict[Any, Any] = {1: np.arange(2), "b": (math.nan, True), "c": Path("x"), "d": {1.5}}
    assert plain(data) == {"1": [0, 1], "b": [None, True], "c": "x", "d": [1.5]}
    assert plain([math.inf], str) == ["inf"]


def test_a_run_is_a_frame() -> None:
    pandas = pytest.importorskip("pandas")
    run = free()
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert frame.index.name == "t" and frame["x"].to_numpy().tolist() == run["x"].tolist()
    assert frame.attrs["units"] == {"t": "s", "x": "m"}
    back = tw.Measured.from_frame(frame, ["x"], sigma={"x": 0.01})
    assert back.t.tolist() == run.t.tolist()


def test_a_run_is_a_dataset() -> None:
    pytest.importorskip("xarray")
    data = free().to_xarray()
    assert data["x"].attrs == {"units": "m", "long_name": "x"}
    assert data["energy"].attrs == {"long_name": "energy"}
    assert data["t"].attrs == {"units": "s"}
    assert float(data["x"].sel(t=0)) == 1.0


@pytest.mark.parametrize("package", ["pandas", "xarray"])
def test_a_package_that_is_not_there_is_told(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InstallationError, match=rf"package {package} is needed.*tracewire\[frames"):
        getattr(free(), f"to_{package}")()
