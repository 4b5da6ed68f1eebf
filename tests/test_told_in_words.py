"""What a user may write wrong in Python and on the command line is told in words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import tracewire as tw
from tracewire.cli import main
from tracewire.errors import DiagramError, OptionError, SimulationError

TEXT = """\
span: [0, 1]
blocks:
  x: {type: integrator, of: d, start: 1}
  d: {type: gain, of: x, k: -1}
"""
TW: Any = tw
"""The package without types: what a user may write."""


def test_a_row_of_runs_is_read_by_the_name_of_a_signal() -> None:
    runs = TW.simulate_many(tw.compile(tw.read_text(TEXT)), {"start.x": [1.0, 2.0]})
    with pytest.raises(OptionError, match=r'Write runs\["x"\]\[0\] for one row'):
        runs[0]


def test_a_point_of_a_sweep_is_read_by_the_name_of_an_output() -> None:
    found = TW.sweep(tw.compile(tw.read_text(TEXT)), {"start.x": [1.0, 2.0]}, ["end(x)"])
    with pytest.raises(OptionError, match=r'Write sweep\["end\(x\)"\]\[0\] for that point'):
        found[0]


def test_an_option_of_a_figure_has_its_kind() -> None:
    run = tw.simulate(tw.compile(tw.read_text(TEXT)))
    with pytest.raises(
        OptionError, match=r"measured is 'one', and not a measured series\. Load all"
    ):
        run.plot(measured="one")


@pytest.mark.parametrize("value", [-1, 0, float("nan")])
def test_a_limit_is_above_zero(value: float) -> None:
    model = tw.compile(tw.read_text(TEXT))
    with pytest.raises(OptionError, match="the limit 'seconds' of a run must be above zero, not"):
        tw.simulate(model, limits={"seconds": value})


def test_a_diagram_is_shown_in_a_line() -> None:
    assert repr(tw.read_text("title: fall\n" + TEXT)) == "Diagram('fall': 2 blocks, 0 parameters)"


def test_the_name_of_a_block_is_a_text() -> None:
    with pytest.raises(OptionError, match="block: name is 5, and not a text"):
        TW.DiagramBuilder().block(5, "gain")


@pytest.mark.parametrize(
    ("option", "values"), [("--series", ("one", "two")), ("--output", ("a.csv", "b.csv"))]
)
def test_an_option_of_one_value_stands_once(
    option: str, values: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "d.yaml").write_text(TEXT, encoding="utf-8")
    assert main(["run", str(tmp_path / "d.yaml"), option, values[0], option, values[1]]) == 2
    assert f"{option} stands twice, and one value counts. Leave one out" in capsys.readouterr().err


def test_a_repeatable_option_stands_twice(tmp_path: Path) -> None:
    (tmp_path / "d.yaml").write_text(TEXT.replace("-1", "-k").replace(
        "blocks", "parameters: {k: 1, m: 2}\nblocks"), encoding="utf-8")  # fmt: skip
    assert main(["run", str(tmp_path / "d.yaml"), "--set", "k=2", "--set", "m=3", "--json"]) == 0


def test_a_typo_in_a_block_of_the_base_is_told(tmp_path: Path) -> None:
    (tmp_path / "car.yaml").write_text(TEXT.replace("x:", "front:").replace("of: x", "of: front"),
                                       encoding="utf-8")  # fmt: skip
    words = r"it is no block of 'car\.yaml', and a new one needs 'type'; there are: front, d"
    with pytest.raises(DiagramError, match=words + r"\. Did you mean 'front'"):
        tw.read_text("extends: car.yaml\nblocks: {fromt: {start: 3}}\n", tmp_path / "own.yaml")


def test_a_loop_whose_solution_was_not_found_may_have_one() -> None:
    loop = "  r: {type: ramp, slope: 1}\n  y: {type: expression, formula: y**3 - r + 1, guess: 0}\n"
    loop = f"span: [0, 1]\nrecord: [y]\nblocks:\n{loop}"
    with pytest.raises(SimulationError, match="loop y -> y, of which no solution was found there"):
        tw.simulate(tw.compile(tw.read_text(loop)))


def test_a_unit_for_outputs_of_several_quantities_is_told() -> None:
    words = "'unit' holds for all outputs, and x, v, held are several quantities. Take it away"
    with pytest.raises(DiagramError, match=words):
        tw.read_text("blocks: {cart: {type: hard_stop, high: 1, unit: mm}}\n")


def test_a_sigma_of_some_signals_alone_is_told_by_check(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = "t,x\n" + "".join(f"{n / 10},{1 - n / 20}\n" for n in range(9))
    (tmp_path / "s.csv").write_text(rows, encoding="utf-8")
    series = "{file: s.csv, time: t, signals: {x: {column: x%s}}}"
    text = f"{TEXT}measured:\n  one: {series % ''}\n  two: {series % ', sigma: 0.1'}\n"
    (tmp_path / "d.yaml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path / "d.yaml")]) == 0
    told = capsys.readouterr()
    assert "d.yaml:6:41: 'x' has no `sigma:` here, and other signals have one: a fit refuses" in (
        " ".join((told.out + told.err).split())
    )
