"""Parameters that single series have of their own: read, fitted, written, run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import Model, compile
from tracewire.diagram import read, read_text
from tracewire.diagram.edit_own import add_own
from tracewire.diagram.edit_sensors import set_sensors
from tracewire.errors import DiagramError, OptionError
from tracewire.fit import fit
from tracewire.residual import load_measured
from tracewire.residual.segment import of_diagram, parameter_in

TEXT = """\
span: [0, 4]
blocks:
  x: {type: harmonic, amplitude: {value: 1, fit: [0, 3]}, period: {value: 1.25, fit: [1, 2]},
      phase: {value: 0}}
measured:
  a: {file: a.csv, time: t, signals: {x: y}, parameters: {x.phase: {value: 0.1, fit: [-7, 7]}}}
  b: {file: b.csv, time: t, signals: {x: y}, parameters: {x.phase: {value: 1.5, fit: [-7, 7]}}}
  c: {file: c.csv, time: t, signals: {x: y}, parameters: {x.phase: 1.1}}
"""
PHASES = {"a": 0.4, "b": 2.0, "c": 1.1}


@pytest.fixture
def model(tmp_path: Path) -> Model:
    t, rng = np.arange(200) / 50, np.random.default_rng(1)
    for name, phase in PHASES.items():
        y = 0.7 * np.sin(2 * np.pi * t / 1.3 + phase) + 1e-3 * rng.standard_normal(len(t))
        rows = np.stack([t, y], axis=1)
        np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",", header="t,y", comments="")
    (tmp_path / "waves.yaml").write_text(TEXT, encoding="utf-8")
    return compile(read(tmp_path / "waves.yaml"))


@pytest.mark.parametrize("method", ["least_squares", "fminsearch", "multiple_shooting"])
def test_a_fit_finds_a_phase_for_each_series(model: Model, method: str) -> None:
    found = fit(model, method=method)
    assert found.values == pytest.approx(
        {"x.amplitude": 0.7, "x.period": 1.3, "x.phase@a": 0.4, "x.phase@b": 2.0}, abs=2e-3
    )
    for comparison in found.comparisons:
        assert comparison.after == pytest.approx(
            next(m for m in found.measured if m.name == comparison.series).values["x"], abs=5e-3
        )


def test_what_a_series_has_of_its_own_goes_before(model: Model) -> None:
    a, b, c = load_measured(model)
    values = {"x.phase": 9.0, "x.period": 1.3, "x.phase@a": 0.4, "gain.x": 2.0}
    assert of_diagram(model, values, a) == {"x.phase": 0.4, "x.period": 1.3}
    assert of_diagram(model, values, b) == {"x.phase": 1.5, "x.period": 1.3}
    assert of_diagram(model, values, c) == {"x.phase": 1.1, "x.period": 1.3}
    assert [parameter_in(model, name, a) for name in values] == ["", "x.period", "x.phase", ""]
    assert [parameter_in(model, name, b) for name in values] == ["", "x.period", "", ""]
    assert (a.free, c.free) == ({"x.phase": (-7.0, 7.0)}, {})


def test_a_fitted_phase_is_written_into_its_series(model: Model) -> None:
    new = set_sensors(model.diagram, {"x.phase@a": 0.4, "x.phase@c": 0.9})
    changed = TEXT.replace("{value: 0.1", "{value: 0.4").replace("x.phase: 1.1", "x.phase: 0.9")
    assert new.text == changed
    with pytest.raises(OptionError, match="unknown measured series 'd'"):
        set_sensors(model.diagram, {"x.phase@d": 0.4})
    with pytest.raises(OptionError, match=r"'x\.period'"):
        set_sensors(model.diagram, {"x.period@a": 0.4})


def test_values_are_added_to_series(model: Model) -> None:
    plain = TEXT.replace(", parameters: {x.phase: 1.1}", "")
    diagram = read_text(plain, model.diagram.file)
    new = add_own(diagram, {"c": {"x.phase": 1.1}})
    assert new.text == TEXT.replace("{x.phase: 1.1}", "{x.phase: 1.1}")
    more = add_own(new, {"c": {"x.period": 1.3}})
    assert "parameters: {x.phase: 1.1, x.period: 1.3}" in more.text
    with pytest.raises(OptionError, match="measured series"):
        add_own(diagram, {"d": {"x.phase": 1.1}})


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("{x.phas: 1}", "unknown parameter 'x.phas'"),
        ("{x.phase: {value: 1, fit: [2, 1]}}", "fit"),
        ("7", "'parameters' of series 'c'"),
    ],
)
def test_parameters_of_a_series_are_checked(model: Model, wrong: str, message: str) -> None:
    with pytest.raises(DiagramError, match=message):
        read_text(TEXT.replace("{x.phase: 1.1}", wrong), model.diagram.file)


def test_a_start_outside_its_bounds_is_refused(model: Model) -> None:
    with pytest.raises(DiagramError, match="the value 8 is outside of its bounds -7 to 7"):
        read_text(TEXT.replace("value: 0.1", "value: 8"), model.diagram.file)
