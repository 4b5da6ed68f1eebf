"""Rows in which a signal has no value: they do not count, and inputs go on there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tracewire as tw
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DataError
from tracewire.residual import Measured, load_measured

DIAGRAM = """\
span: [0, 4]
inputs: {u: {unit: N}}
parameters: {k: {value: 5, fit: [0.1, 20]}}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a}
  spring: {type: gain, of: x, k: -k}
  a: {type: sum, of: [spring, u]}
measured:
  run:
    file: run.csv
    time: t
    signals: {x: {column: x, unit: m}, v: {column: v}}
    inputs: {u: {column: u, hold: previous}}
"""


def load(folder: Path, rows: str, diagram: str = DIAGRAM) -> Measured:
    (folder / "run.csv").write_text("t,x,v,u\n" + rows, encoding="utf-8")
    (folder / "run.yaml").write_text(diagram, encoding="utf-8")
    (run,) = load_measured(compile(read(folder / "run.yaml")))
    return run


@pytest.mark.parametrize("blank", ["", " ", "NaN", "nan", "NA", "n/a", "null", "None"])
def test_a_blank_cell_of_a_signal_leaves_its_row_out_and_not_its_input(
    tmp_path: Path, blank: str
) -> None:
    run = load(tmp_path, f"0,1,5,1\n1,{blank},6,2\n2,3,7,3\n3,4,{blank},4\n4,5,9,5\n")
    assert run.t.tolist() == [0, 2, 4]
    assert run.values["x"].tolist() == [1, 3, 5]
    assert run.values["v"].tolist() == [5, 7, 9]
    times, values = run.inputs["u"]
    assert times.tolist() == [0, 1, 2, 3, 4]
    assert values.tolist() == [1, 2, 3, 4, 5]
    for name, first in (("x", 1), ("v", 3)):
        words = f"{name} has no value in 1 of 5 rows, which count for no signal, the first at t = "
        assert f"{words}{first} s" in run.steps


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("0,1,5,1\n1,2,6,\n2,3,7,3\n", "run.csv:3: column 'u' is '', which is not a number."),
        ("0,1,5,1\n1,2,6,nan\n2,3,7,3\n", "run.csv:3: column 'u' is not finite in this row."),
        ("0,1,5,1\n,2,6,2\n2,3,7,3\n", "run.csv:3: column 't' is '', which is not a number."),
        ("0,1,5,1\n1,OVLD,6,2\n2,3,7,3\n", "run.csv:3: column 'x' is 'OVLD'"),
        ("0,,5,1\n1,,6,2\n2,,7,3\n", "run.csv:2: column 'x' has no value in any row."),
        ("0,1,,1\n1,,6,2\n2,3,,3\n", "0 of 3 rows have a value of x and v. Give signals that"),
    ],
)
def test_what_cannot_be_blank_is_told(tmp_path: Path, rows: str, said: str) -> None:
    with pytest.raises(DataError) as caught:
        load(tmp_path, rows)
    assert said in str(caught.value)


def test_a_step_that_looks_at_several_samples_refuses_blanks(tmp_path: Path) -> None:
    rows = "".join(f"{n / 10},{'' if n == 7 else n},1,0\n" for n in range(60))
    outliers = DIAGRAM + "    clean: [{outliers: {signals: x}}]\n"
    with pytest.raises(DataError, match="'x' has no value in 1 of 60 rows") as told:
        load(tmp_path, rows, outliers)
    assert "'outliers' of series 'run'" in str(told.value)
    calibrated = DIAGRAM + "    clean: [{calibrate: {signal: x, gain: 2}}, {trim: {from: 1}}]\n"
    run = load(tmp_path, rows, calibrated.replace("column: x, unit: m", "column: x"))
    assert run.t[0] == 1.0
    assert run.values["x"][0] == 20.0


def test_a_fit_over_blanks_knows_the_drive_there(tmp_path: Path) -> None:
    """Without the rows, a drive that goes on in the gap would be made up."""
    t = np.arange(0, 4.0001, 0.05)
    u = np.where((t % 0.8) < 0.4, 1.0, -1.0)
    run = load(tmp_path, "".join(f"{a:.2f},0,0,{b}\n" for a, b in zip(t, u, strict=True)))
    model = compile(read(tmp_path / "run.yaml"))
    exact = tw.simulate(model, inputs=run.inputs, times=t, parameters={"k": 7.0})
    gap = (t > 1.18) & (t < 2.72)
    rows = [
        f"{a:.2f},{'' if lost else f'{x:.9g}'},{v:.9g},{b}\n"
        for a, lost, x, v, b in zip(t, gap, exact["x"], exact["v"], u, strict=True)
    ]
    load(tmp_path, "".join(rows))
    assert tw.fit(model, method="least_squares").values["k"] == pytest.approx(7.0, rel=1e-4)
    left = load(tmp_path, "".join(row for row, lost in zip(rows, gap, strict=True) if not lost))
    assert [remark for remark in left.remarks if "leave its cell blank" in remark] == [
        "the input u is not known in the gap after t = 1.15 s, and goes from -1 to 1 around it: a "
        "run takes a guess there; where only a signal has no value, keep the row and leave its "
        "cell blank"
    ]
    assert abs(tw.fit(model, method="least_squares").values["k"] / 7 - 1) > 0.05


def test_a_gap_outside_of_the_window_is_not_told(tmp_path: Path) -> None:
    rows = "".join(f"{n},{n},1,{n % 2}\n" for n in [*range(20), *range(40, 60)])
    assert any("not known in the gap" in remark for remark in load(tmp_path, rows).remarks)
    cut = load(tmp_path, rows, DIAGRAM + "    to: 15\n")
    assert not any("not known in the gap" in remark for remark in cut.remarks)
