"""Curves of a report that zoom: their data, and what a browser makes of them."""

from __future__ import annotations

import base64
import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from show.fits import compared
from show.test_figures import SWING, event, run_of
from tracewire.fit import Comparison
from tracewire.npm import integrity
from tracewire.show import Report, plot_comparisons, plot_run, report
from tracewire.show.document import Figure as DrawnFigure
from tracewire.show.document import Section
from tracewire.show.limits import FIGURE
from tracewire.show.plane_figures import plot_portrait
from tracewire.show.style import panels, saved_figures
from tracewire.show.uplot import HERE, scripts
from tracewire.show.zoom import curves_of, thin_curve
from tracewire.solve import Run

T = np.linspace(0.0, 4.0, 81)
BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome")
     if (found := shutil.which(name))), ""
)  # fmt: skip


def curves(draw: Any, *arguments: Any) -> str | None:
    """The curves of the figure that a function saves."""
    with saved_figures() as saved:
        draw(*arguments)
    (figure,) = saved
    return curves_of(figure)


def array(data: dict[str, Any], number: int) -> Any:
    return np.frombuffer(base64.b64decode(data["arrays"][number]), dtype="<f4")


def test_the_curves_of_a_run_are_its_signals(tmp_path: Path) -> None:
    data = json.loads(curves(plot_run, SWING, tmp_path / "a.png") or "")
    panels = {line["label"]: (p, line) for p in data["panels"] for line in p["lines"]}
    assert set(panels) == {"theta", "psi", "x", "u"}
    for name, (panel, line) in panels.items():
        assert array(data, line["x"]) == pytest.approx(T, rel=1e-6)
        assert array(data, line["y"]) == pytest.approx(SWING[name], rel=1e-6)
        assert panel["x"] == [0.0, 4.0]
    assert panels["x"][0]["label"] == "x [m]"
    assert len(data["arrays"]) == 4  # the times once; `u` is the time


def test_events_are_rows_of_marks_and_bars(tmp_path: Path) -> None:
    rows = json.loads(curves(plot_run, SWING, tmp_path / "a.png") or "")["panels"][-1]
    assert rows["rows"] == ["rub (4)", "stop (1)", "gate (1)"]
    assert rows["down"]
    assert [bar[:2] for bar in rows["bars"][0]["at"]] == [[0.0, 0.5], [1.0, 2.0], [3.5, 4.0]]
    assert [mark["at"] for mark in rows["marks"]] == [
        [[3.0, pytest.approx(1.8), pytest.approx(2.2)]],
        [[2.5, pytest.approx(0.62), pytest.approx(1.38)]],
    ]


def test_measured_points_levels_and_labels_of_a_fit(tmp_path: Path) -> None:
    data = json.loads(curves(plot_comparisons, tmp_path / "fit.png", [compared("run")]) or "")
    upper, lower = data["panels"][:2]
    labels = [(line["label"], line["dots"]) for line in upper["lines"]]
    assert labels == [("measured", True), ("before", False), ("after", False)]
    assert {"before", "after"} <= {line["label"] for line in lower["lines"]}
    assert any(level["at"] == 0.0 for level in lower["levels"])


def test_named_levels_are_told_above_a_panel(tmp_path: Path) -> None:
    figure, (panel,) = panels([2.0])
    panel.plot(T, T)
    for level, label in ((2, "±2 σ"), (-2, None)):
        panel.axhline(level, linestyle=":", label=label)
    panel.set_xlabel("t [s]")
    (only,) = json.loads(curves_of(figure) or "")["panels"]
    assert only["title"] == "dotted: ±2 σ"
    panel.set_yscale("symlog")
    assert curves_of(figure) is None


def test_what_is_not_over_time_stays_a_picture(tmp_path: Path) -> None:
    assert curves(plot_portrait, SWING, "theta", "psi", tmp_path / "a.png") is None


def test_a_long_curve_keeps_its_peaks_and_gaps() -> None:
    t = np.linspace(0, 1, 100_001)
    y = np.sin(20 * t)
    y[[1234, 77_777]] = 50.0, -60.0
    y[5000:7000] = np.nan
    x, thin = thin_curve(t, y)
    assert len(x) <= FIGURE.zoom_points + 2
    assert (np.diff(x) > 0).all()
    assert (x[0], x[-1]) == (0.0, 1.0)
    assert (np.nanmax(thin), np.nanmin(thin)) == (50.0, -60.0)
    assert np.isnan(thin[(x > 0.0505) & (x < 0.0695)]).all()
    assert np.abs(np.interp(x, t, y) - thin)[np.isfinite(thin)].max() == 0
    assert thin_curve(t[:10], y[:10]) == (pytest.approx(t[:10]), pytest.approx(y[:10]))


BAD = "</script><script>alert('x')</script><b>&"


def test_text_of_a_diagram_cannot_leave_its_place() -> None:
    run = run_of({BAD: ("m", T)})
    page = report(run).html()
    (text,) = re.findall(r'<script type="application/json" class="curves">(.*?)</script>', page)
    assert json.loads(text)["panels"][0]["lines"][0]["label"] == BAD
    assert "alert('x')</script>" not in page.replace(text, "").replace(html.escape(BAD), "")


def test_a_page_has_the_scripts_once_and_its_pictures_without_them() -> None:
    page = report(SWING).html()
    assert page.count("var uPlot=") == 1
    assert page.count("<img") == 1
    assert page.index("<img") < page.index("<script")
    assert "http" not in page.replace("https://github.com/leeoniya/uPlot", "")  # one file
    assert "</script" not in scripts()


def test_a_report_without_curves_has_no_script() -> None:
    from tracewire.show import Report
    from tracewire.show.document import Section

    assert "<script" not in Report("A", (Section("B", ("c",)),)).html()


def test_the_script_is_the_one_of_the_lock_file() -> None:
    lock = json.loads((HERE / "uplot.lock.json").read_text(encoding="utf-8"))
    assert integrity((HERE / "uPlot.iife.min.js").read_bytes()) == lock["script"]
    assert lock["version"] in (HERE / "uPlot.iife.min.js").read_text(encoding="utf-8")[:100]


PROBE = """
<pre id="told"></pre><script>
function mouse(to, kind, part) {
  var box = over.getBoundingClientRect();
  to.dispatchEvent(new MouseEvent(kind, {bubbles: true, button: 0, movementX: 9,
    clientX: box.left + part * box.width, clientY: box.top + 20}));
}
var figure = document.querySelector("figure.curves"), told = {}, over;
function limits() {
  return figure.plots.map(function (one) {
    var x = one.plot.scales.x, y = one.plot.scales.y;
    return [x.min, x.max, y.min, y.max];
  });
}
window.addEventListener("load", function () { setTimeout(function () {
  told.image = getComputedStyle(figure.querySelector("img")).display;
  var labels = Array.from(figure.querySelectorAll(".u-label"));
  told.names = labels.map(function (label) { return label.textContent; });
  told.scripts = document.scripts.length;
  told.whole = limits();
  over = figure.plots[0].plot.over;
  mouse(over, "mouseenter", 0.2);
  mouse(over, "mousedown", 0.25);
  mouse(over, "mousemove", 0.5);
  setTimeout(function () {
    mouse(document, "mouseup", 0.5);
    setTimeout(function () {
      told.zoomed = limits();
      mouse(over, "dblclick", 0.5);
      setTimeout(function () {
        told.again = limits();
        document.getElementById("told").textContent = JSON.stringify(told);
      }, 50);
    }, 50);
  }, 50);
}, 50); });
</script></body>
"""


REDNESS = """<pre id="told"></pre><script>
window.addEventListener("load", function () { setTimeout(function () {
  var u = document.querySelector("figure.curves").plots[1].plot;
  document.getElementById("told").textContent = JSON.stringify([2.0, 2.3].map(function (t) {
    var at = Math.round(u.valToPos(t, "x", true)), y = Math.round(u.valToPos(0, "y", true));
    return [-2, -1, 0, 1, 2].map(function (n) {
      var p = u.ctx.getImageData(at + n, y, 1, 1).data;
      return (p[0] - p[1]) * p[3] / 255;
    }).reduce(function (a, b) { return a + b; });
  }));
}, 50); });
</script></body>
"""


@pytest.mark.skipif(not BROWSER, reason="no Chromium here")
def test_a_browser_draws_the_curves_and_zooms_all_panels(tmp_path: Path) -> None:
    run = run_of(
        {"theta": ("rad", np.cos(3 * T)), BAD: ("m", 5 * T)},
        tuple(SWING.events),
    )
    told = seen(run, tmp_path)
    assert told["image"] == "none"
    assert told["scripts"] == 3  # the data, those of the page, and this test's
    assert [name for name in told["names"] if name != "t"] == ["theta", BAD]
    assert len(told["whole"]) == 3
    assert all(x[:2] == [0, 4] for x in told["whole"])
    for begin, end, *_ in told["zoomed"]:
        assert (begin, end) == (pytest.approx(1.0, abs=0.05), pytest.approx(2.0, abs=0.05))
    assert told["zoomed"][1][2:] == [pytest.approx(5, abs=1), pytest.approx(10, abs=1)]
    assert told["again"] == told["whole"]


@pytest.mark.skipif(not BROWSER, reason="no Chromium here")
def test_marks_stand_on_the_grid(tmp_path: Path) -> None:
    # the first mark is where a line of the grid stands
    run = run_of({"x": ("m", T)}, (event(2.0, "impact", "stop"), event(2.3, "impact", "stop")))
    page = tmp_path / "run.html"
    page.write_text(report(run).html().replace("</body>", REDNESS), encoding="utf-8")
    first, second = told_on(page, tmp_path)
    assert first == pytest.approx(second, rel=0.05)
    assert first > 100


TICKS = """<pre id="told"></pre><script>
window.addEventListener("load", function () { setTimeout(function () {
  var plots = document.querySelector("figure.curves").plots;
  document.getElementById("told").textContent = JSON.stringify(plots.map(function (one) {
    return one.plot.axes[1]._values.filter(Boolean);
  }));
}, 50); });
</script></body>
"""


@pytest.mark.skipif(not BROWSER, reason="no Chromium here")
def test_a_low_panel_has_numbers_that_show_its_scale(tmp_path: Path) -> None:
    compared = Comparison(
        "run", "train", "x", "m", T, np.cos(T), np.cos(T) + 0.013 * np.sin(9 * T),
        np.cos(T) + 2e-4 * np.sin(9 * T), np.ones(len(T), dtype=bool), 0.0, 2e-4,
    )  # fmt: skip
    figure = DrawnFigure("a.png", "a", lambda path: plot_comparisons(path, [compared]))
    page = tmp_path / "a.html"
    text = Report("A", (Section("B", figures=(figure,)),)).html()
    page.write_text(text.replace("</body>", TICKS), encoding="utf-8")
    for numbers in told_on(page, tmp_path):
        assert len(numbers) >= 3


def seen(run: Run, folder: Path) -> Any:
    """What a script finds on the page of a run, in a browser without a window."""
    page = folder / "run.html"
    page.write_text(report(run).html().replace("</body>", PROBE), encoding="utf-8")
    return told_on(page, folder)


def told_on(page: Path, folder: Path) -> Any:
    """What a page writes into its element `told`."""
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"]
    command += [f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=20000"]
    done = subprocess.run([*command, page.as_uri()], capture_output=True, text=True, timeout=120)
    found = re.search(r'<pre id="told">(.*?)</pre>', done.stdout, flags=re.DOTALL)
    assert found is not None, done.stderr
    return json.loads(html.unescape(found[1]))
