from __future__ import annotations

import math
from pathlib import Path

import pytest
from diagram.small_library import made, refused

TOP = """
inputs: {drive: {unit: N m, default: 0}}
parameters: {k: 2}
blocks:
  theta: {type: integrator, of: omega}
  omega: {type: integrator, of: drive}
  o: {type: oscillator}
  b: {type: s}
subsystems:
  s: {outputs: {y: x}, blocks: {x: {type: integrator, of: x}, o: {type: oscillator}}}
presets: {printed: {k: 3}}
measured:
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "run.csv").write_text("t,angle\n0,1\n1,2\n")
    return tmp_path / "diagram.yaml"


def test_a_series_becomes_a_noun_in_si(file: Path) -> None:
    text = """\
  run:
    file: run.csv
    use: gate
    time: t
    signals:
      theta: {column: angle, unit: deg, sigma: 0.1, offset: {fit: [-1, 1]}}
      b: other
    inputs: {drive: {column: u, unit: mN m}}
    start: {theta: free, omega: {value: 180, unit: deg}, o.v: k, b.x: 1, b.o.x: free}
    preset: printed
    from: 2.0
    to: 1e1
"""
    series = made(TOP + text, file).measured["run"]
    assert (series.file, series.use, series.time) == (file.parent / "run.csv", "gate", "t")
    assert (series.begin, series.end, series.preset) == (2.0, 10.0, "printed")
    theta, other = series.channels["theta"], series.channels["b.y"]
    degree = math.pi / 180
    assert (theta.column, theta.unit, theta.factor) == ("angle", "rad", pytest.approx(degree))
    assert theta.sigma == pytest.approx(0.1 * degree)
    assert theta.offset is not None
    assert theta.offset.named
    assert theta.offset.factor == theta.factor
    assert theta.offset.fit == pytest.approx((-degree, degree))
    assert (other.column, other.factor, other.sigma) == ("other", 1.0, None)
    assert series.inputs["drive"].factor == pytest.approx(1e-3)
    assert list(series.start) == ["theta", "omega", "o.v", "b.x", "b.o.x"]
    assert series.start["theta"] is None
    assert series.start["omega"].factor == pytest.approx(degree)


def test_the_plainest_series(file: Path) -> None:
    text = "  run: {file: run.csv, time: 1, signals: {theta: 2}}"
    series = made(TOP + text, file).measured["run"]
    assert (series.use, series.time, series.channels["theta"].column) == ("train", "1", "2")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("file: run.csv, ", "", "series 'run' needs 'file'. Write file: ..."),
        ("time: t, ", "", "series 'run' needs 'time'"),
        (", signals: {theta: angle}", "", "series 'run' needs 'signals'"),
        ("run.csv", "rum.csv", "13:15: unknown file 'rum.csv' in"),
        ("run.csv", "rum.csv", "Did you mean 'run.csv'?"),
        ("run.csv", "no/run.csv", "and no folder"),
        ("time: t", "time: t, tim: t", "unknown key of a series 'tim'; there are: file, from"),
        ("time: t", "time: [t]", "'time' must be a text"),
        ("time: t", "time: t, use: training", "unknown use 'training'; there are: gate, train"),
        ("time: t", "time: t, preset: prnted", "unknown preset 'prnted'; there are: printed."),
        ("time: t", "time: t, from: a", "'from' of series 'run' must be a number, not 'a'"),
        ("time: t", "time: t, from: 3, to: 2", "series 'run' ends at 2, not after its begin at 3"),
        ("{theta: angle}", "{}", "series 'run' has no signals"),
        ("{theta: angle}", "[theta]", "'signals' of series 'run' must be a mapping"),
        ("{theta: angle}", "{thet: angle}", "unknown signal 'thet'; there are: b, b.o.force"),
        ("{theta: angle}", "{theta: a, theta.y: b}", "two definitions of the signal 'theta.y'"),
        ("{theta: angle}", "{theta: [a]}", "'theta' of series 'run' must be a mapping"),
        ("{theta: angle}", "{theta: {unit: m}}", "'theta' of series 'run' needs 'column'"),
        ("{theta: angle}", "{theta: {column: a, sgma: 1}}", "unknown key of a measured signal 'sg"),
        ("{theta: angle}", "{theta: {column: a, sigma: 0}}", "'sigma' must be above zero, not 0"),
        ("{theta: angle}", "{theta: {column: a, sigma: k}}", "'sigma' must be a number, not 'k'"),
        ("{theta: angle}", "{theta: {column: a, offset: {fit: 3}}}", "the bounds of a fit are two"),
        ("time: t", "time: t, inputs: {u: v}", "unknown input 'u'; there are: drive."),
        (
            "time: t",
            "time: t, inputs: {drive: {column: u, sigma: 1}}",
            "unknown key of a measured input 'sigma'; there are: column, unit.",
        ),
        ("time: t", "time: t, start: {o: 1}", "unknown state 'o'; there are: b.o.v, b.o.x, b.x"),
        ("time: t", "time: t, start: {theta: fre}", "unknown parameter 'fre'"),
        ("{file", "[file", "this is not YAML"),
    ],
)
def test_messages(file: Path, old: str, new: str, message: str) -> None:
    text = "  run: {file: run.csv, time: t, signals: {theta: angle}}"
    assert old in text
    assert message in refused(TOP + text.replace(old, new), file)


def test_measured_is_a_mapping_of_mappings(file: Path) -> None:
    assert "'measured' must be a mapping" in refused(TOP.rstrip() + " [run]", file)
    assert "series 'run' must be a mapping" in refused(TOP + "  run: run.csv", file)
