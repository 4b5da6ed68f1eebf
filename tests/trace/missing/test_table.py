"""A missing torque as a table in a diagram."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagram.alike import said
from tracewire.compile import compile
from tracewire.diagram import Diagram, apply, patch, read
from tracewire.errors import OptionError
from tracewire.solve import simulate
from tracewire.trace.candidates.places import Place, find_places
from tracewire.trace.found import Missing
from tracewire.trace.missing.table import missing_table, table_block

TEXT = """\
span: [0, 3]
inputs: {u: {}}
parameters: {k: 30}
blocks:
  q: {type: integrator, of: v, start: 0.4, unit: rad}
  v: {type: integrator, of: torque, unit: rad/s}
  spring: {type: gain, of: q, k: -k}   # a comment that stays
  torque: {type: sum, of: [u, spring]}
"""
GRID = np.linspace(-0.5, 0.5, 41)


def missing(*variables: str) -> Missing:
    density = np.where(np.abs(GRID) < 0.45, 9.0, 0.0)
    return Missing("torque", variables, 0.97, (GRID,), -20 * GRID**3, density)


def diagram(folder: Path) -> Diagram:
    path = folder / "oscillator.yaml"
    path.write_text(TEXT)
    return read(path)


def place(of: Diagram, name: str = "torque") -> Place:
    return next(p for p in find_places(compile(of)) if p.name == name)


def test_the_table_is_read_and_acts_at_the_sum(tmp_path: Path) -> None:
    old = diagram(tmp_path)
    (tmp_path / "missing.csv").write_text(missing_table(missing("q")))
    block = table_block(old, place(old), missing("q"), "missing.csv")
    new = patch(old, [block])
    assert said(apply(old, [block])) == said(new)
    assert "# a comment that stays" in new.text
    assert "empirical" in new.text
    times = np.linspace(0, 3, 301)
    still = {"u": (times, 0 * times)}
    run = simulate(compile(new, record=("q", "missing")), times=times, inputs=still)
    seen = np.interp(run["q"], GRID, -20 * GRID**3)
    assert np.allclose(run["missing"], seen, atol=1e-6)
    bare = simulate(compile(old, record=("q",)), times=times, inputs=still)
    assert float(np.max(np.abs(run["q"] - bare["q"]))) > 0.01


def test_the_table_says_that_it_is_empirical_and_leaves_out_what_was_not_seen() -> None:
    text = missing_table(missing("q"))
    assert "Empirical" in text
    assert "No law" in text
    rows = [line for line in text.splitlines() if not line.startswith("#")]
    assert rows[0] == "q, torque, samples"
    assert len(rows) == 1 + int(np.sum(np.abs(GRID) < 0.45))


def test_a_torque_at_the_drive_is_seen_by_all_that_reads_it(tmp_path: Path) -> None:
    old = diagram(tmp_path)
    (tmp_path / "missing.csv").write_text(missing_table(missing("u")))
    block = table_block(old, place(old, "drive.u"), missing("u"), "missing.csv")
    new = patch(old, [block])
    assert said(apply(old, [block])) == said(new)
    assert "missing" in new.blocks


def test_two_variables_have_rows_of_pairs_but_no_block(tmp_path: Path) -> None:
    grid = np.linspace(-1, 1, 5)
    torque = np.outer(grid, grid)
    both = Missing("torque", ("q", "v"), 0.9, (grid, grid), torque, np.ones((5, 5)))
    rows = [line for line in missing_table(both).splitlines() if not line.startswith("#")]
    assert rows[0] == "q, v, torque, samples"
    assert len(rows) == 26
    old = diagram(tmp_path)
    with pytest.raises(OptionError, match="depends on q and v; a table has one input"):
        table_block(old, place(old), both, "missing.csv")


def test_a_torque_with_memory_has_no_table(tmp_path: Path) -> None:
    old = diagram(tmp_path)
    nothing = np.zeros(0)
    memory = Missing("torque", ("history",), 0.9, (), nothing, nothing)
    with pytest.raises(OptionError, match="no table of a torque that depends on history"):
        missing_table(memory)
    with pytest.raises(OptionError, match=r"cannot be wired to history.*wired to q, v"):
        table_block(old, place(old), memory, "missing.csv")


def test_the_error_of_a_sensor_is_no_torque(tmp_path: Path) -> None:
    sensor = Place("sensor.q", "sensor", "q")
    with pytest.raises(OptionError, match=r"missing at 'sensor\.q' is no torque"):
        table_block(diagram(tmp_path), sensor, missing("y"), "missing.csv")


def test_a_torque_that_no_sample_is_near_has_no_table() -> None:
    unseen = Missing("torque", ("q",), 0.9, (GRID,), GRID, 0 * GRID)
    with pytest.raises(OptionError, match="fewer than two points"):
        missing_table(unseen)


def test_wires_of_several_drives_and_bodies() -> None:
    many = Place("f", "sum", "f", "q", "v", "a", (("q2", "v2"), ("q3", "v3")), ("u", "w"))
    wires = many.wires
    assert wires["u of w"] == "w"
    assert wires["other_q of v3"] == "q3"
