"""Tables of lists: straight lines with jumps, and bilinear tables, against numpy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator
from solve.logs import METHODS, TIGHT
from solve.models import made, run
from tracewire.errors import TracewireError


@pytest.mark.parametrize("method", METHODS)
def test_signal_builder_has_lines_and_jumps_and_an_exact_integral(method: str) -> None:
    result = run(
        """
span: [0, 5]
every: 0.01
blocks:
  y: {type: signal_builder, times: [0.5, 1, 1, 2.3, 2.3, 4], values: [1, 2, -1, -1, 3, 0]}
  x: {type: integrator, of: y}
record: [y, x]
""",
        method=method,
        **TIGHT,
    )
    t = result.t

    def lines(t: float) -> float:
        if t < 1:
            return float(np.interp(t, [0.5, 1], [1, 2]))
        return -1.0 if t < 2.3 else float(np.interp(t, [2.3, 4], [3, 0]))

    assert result["y"] == pytest.approx([lines(time) for time in t.tolist()], abs=1e-12)
    assert result["x"][-1] == pytest.approx(0.5 + 0.75 - 1.3 + 3 * 1.7 / 2, abs=1e-9)
    before, after = 1.25 - (np.minimum(t, 2.3) - 1), 3 - 3 / 1.7 * (t - 2.3) / 2
    area = np.where(t < 2.3, before, 1.25 - 1.3 + after * (t - 2.3))
    inside = (t >= 1) & (t <= 4)
    assert result["x"][inside] == pytest.approx(area[inside], abs=1e-9)


def test_signal_builder_has_values_that_may_be_free() -> None:
    text = """
span: [0, 2]
parameters: {a: 3}
blocks:
  y: {type: signal_builder, times: [0, 1, 1, 2], values: [0, a, 2*a, a]}
record: [y]
"""
    result = run(text, sensitivities=["a"], **TIGHT)
    exact = np.where(result.t < 1, result.t, 3 - result.t)
    assert result["y"] == pytest.approx(3 * exact, abs=1e-12)
    assert result.sensitivities["a"]["y"] == pytest.approx(exact, abs=1e-12)


def test_signal_builder_takes_constants_and_as_many_points_as_a_record_has() -> None:
    times = np.linspace(0, np.pi, 1500)
    listed = ", ".join(["0", "2*0.5", "pi"])
    result = run(
        f"""
span: [0, 3.2]
every: 0.1
blocks:
  y: {{type: signal_builder, times: {times.tolist()}, values: {np.sin(times).tolist()}}}
  few: {{type: signal_builder, times: [{listed}], values: [0, 1, 2]}}
record: [y, few]
"""
    )
    assert result["y"] == pytest.approx(np.interp(result.t, times, np.sin(times)), abs=1e-12)
    assert result["few"] == pytest.approx(np.interp(result.t, [0, 1, np.pi], [0, 1, 2]), abs=1e-12)


def test_lookup_table_2d_is_the_bilinear_one_of_scipy() -> None:
    rows, columns = [-1.0, 0.0, 0.5, 2.0], [0.0, 1.0, 4.0]
    values = [[1.0, 2.0, -1.0], [0.0, 3.0, 3.0], [5.0, -2.0, 1.0], [2.0, 2.0, 8.0]]
    result = run(
        f"""
span: [0, 6]
every: 0.01
blocks:
  u: {{type: sine, amplitude: 2.2, omega: 3}}
  v: {{type: sine, amplitude: 3, omega: 1.7, offset: 2}}
  y: {{type: lookup_table_2d, of: u, other: v, rows: {rows}, columns: {columns}, values: {values}}}
record: [u, v, y]
"""
    )
    table = RegularGridInterpolator((rows, columns), values)
    held = np.column_stack([np.clip(result["u"], -1, 2), np.clip(result["v"], 0, 4)])
    assert result["y"] == pytest.approx(table(held), abs=1e-12)
    assert set(map(bool, np.abs(result["u"]) > 2)) == {True, False}


TIMES = "{type: signal_builder, times: [0, 1], values: [0, 1]}"
TABLE = "{type: lookup_table_2d, of: u, other: u, rows: [0, 1], columns: [0, 1, 2], values: V}"


@pytest.mark.parametrize(
    ("block", "told"),
    [
        (TIMES.replace("[0, 1],", "[1, 0],"), "the times must ascend, and 0 is not above 1"),
        (TIMES.replace("[0, 1],", "[0, 0, 0],"), "a time stands three times: a jump is the same"),
        (TIMES.replace("[0, 1],", "[0, a],"), "the times are not all plain numbers: write them"),
        (TIMES.replace("[0, 1],", "[0, 1/0],"), "a time is no number: '1/0' cannot be evaluated"),
        (TIMES.replace("[0, 1],", "1,"), "the numbers of its times are a number: write a list"),
        (TIMES.replace("[0, 1]}", "[0, 1, 2]}"), "there are 2 times and 3 values: give one each"),
        (TABLE.replace("V", "[[1, 2], [3, 4]]"), "the values are a 2x2 matrix, and not 2 rows of"),
        (TABLE.replace("V", "[1, 2, 3]"), "the values are a vector of 3, and not 2 rows of 3"),
        (
            TABLE.replace("[0, 1],", "[0, 0],").replace("V", "[[1, 2, 3], [4, 5, 6]]"),
            "the rows must ascend, and 0 is not above 0",
        ),
        (
            TABLE.replace("of: u,", "of: w,").replace("V", "[[1, 2, 3], [4, 5, 6]]"),
            "an input is a vector of 2, and it takes numbers: name an element, such as [0]",
        ),
    ],
)
def test_a_table_of_lists_says_what_is_wrong_with_it(block: str, told: str) -> None:
    text = "span: [0, 1]\nparameters: {a: 1}\nblocks:\n  u: {type: time}\n"
    text += f"  w: {{type: mux, of: [u, u]}}\n  y: {block}\n"
    with pytest.raises(TracewireError) as caught:
        made(text)
    assert f"<text>:6:3: block 'y': {told}" in str(caught.value)
    assert len(caught.value.problems) == 1
