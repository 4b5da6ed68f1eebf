"""A drive with a dead time: what it was is the same function at another time."""

from __future__ import annotations

import numpy as np
import pytest
import tracewire as tw
from solve.logs import METHODS
from solve.models import made, run
from tracewire.errors import DiagramError

LATE = """
span: [0.5, 3]
every: 0.01
record: [x]
inputs: {{u: {{unit: V, default: 0}}}}
parameters: {{tau: {{value: 0.137, unit: s}}}}
blocks:
  drive: {{type: expression, formula: {drive}}}
  late: {{type: drive_delay, of: drive, tau: tau}}
  x: {{type: integrator, of: rate}}
  rate: {{type: expression, formula: drive + late - x}}
"""
NOW = LATE.replace("drive + late - x", "drive - x")
T = np.arange(0.0, 4.0, 0.05)
U = np.cos(7 * T)
TABLES = {"held": tw.Held, "lines": lambda t, u: (t, u)}
DRIVES = ["u", "u*u + t", "sign(sin(12*t + 0.3))", "sign(u - 0.2)*u", "0.3*u + exp(-t)"]


@pytest.mark.parametrize("drive", ["u", "u*u", "sign(u - 0.2)*u"])
@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("method", METHODS)
def test_an_input_with_a_dead_time_is_its_record_that_much_later(
    drive: str, table: str, method: str
) -> None:
    """The run begins within the record, which tells what was before."""
    of = TABLES[table]
    late = run(LATE.format(drive=drive), inputs={"u": of(T, U)}, rtol=1e-10, method=method)
    later = run(NOW.format(drive=drive), inputs={"u": of(T + 0.137, U)}, rtol=1e-10, method=method)
    np.testing.assert_allclose(late["x"], later["x"], rtol=0, atol=1e-9)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("table", TABLES)
def test_sensitivities_by_the_dead_time_are_differences_of_runs(drive: str, table: str) -> None:
    model, inputs = made(LATE.format(drive=drive)), {"u": TABLES[table](T, U)}
    h = 1e-6

    def x(tau: float) -> np.ndarray:
        found = tw.simulate(model, inputs=inputs, parameters={"tau": tau}, rtol=1e-12)
        return np.asarray(found["x"])

    found = tw.simulate(model, inputs=inputs, sensitivities=["tau"], rtol=1e-10).sensitivities
    by_differences = (x(0.1371 + h) - x(0.1371 - h)) / (2 * h)
    at = tw.simulate(
        model, inputs=inputs, parameters={"tau": 0.1371}, sensitivities=["tau"], rtol=1e-10
    ).sensitivities
    assert found.array.shape == at.array.shape
    np.testing.assert_allclose(at.array.ravel(), by_differences, rtol=0, atol=1e-6)


def test_steps_may_be_longer_than_the_dead_time() -> None:
    """With a delay that is remembered it would take 2.5e9 steps."""
    text = LATE.replace("value: 0.137", "value: 1e-9").format(drive="sin(t)")
    found = run(text, limits=tw.Limits(steps=500))
    wave = (np.sin(found.t) - np.cos(found.t)) / 2
    np.testing.assert_allclose(found["x"], wave - wave[0] * np.exp(0.5 - found.t), atol=1e-5)


def test_no_dead_time_is_the_drive_itself() -> None:
    inputs = {"u": tw.Held(T, U)}
    none = run(LATE.replace("0.137", "0").format(drive="u"), inputs=inputs, rtol=1e-10)
    now = run(NOW.format(drive="u"), inputs=inputs, rtol=1e-10)
    np.testing.assert_allclose(none["x"], now["x"], rtol=0, atol=1e-12)


def test_a_dead_time_reads_drives_that_read_each_other() -> None:
    """Thirty drives, each read twice by the next: each is worked out once."""
    chain = "".join(f"  d{n}: {{type: sum, of: [d{n - 1}, d{n - 1}]}}\n" for n in range(1, 30))
    text = LATE.format(drive="d29").replace("blocks:\n", f"blocks:\n  d0: {{type: time}}\n{chain}")
    found = run(text, rtol=1e-8, parameters={"tau": 0.5})
    t = found.t
    exact = 2.0**29 * ((t - 1.5) - (0.5 - 1.5) * np.exp(-(t - 0.5)))
    np.testing.assert_allclose(found["x"], exact, rtol=1e-6)


@pytest.mark.parametrize(
    ("drive", "read"),
    [("x", "x"), ("2*other", "q"), ("u + other", "q")],
)
def test_a_dead_time_of_what_moves_is_refused(drive: str, read: str) -> None:
    more = "  q: {type: integrator, of: drive}\n  other: {type: gain, of: q, k: 2}\n"
    text = LATE.format(drive=drive) + more
    told = rf"^<text>:9:3: block 'late': '{read}' is read as it was some time ago, and is no func"
    with pytest.raises(DiagramError, match=told) as error:
        made(text)
    assert error.value.problems[0].hint == "Use a block of type delay, which remembers it."


def test_at_rest_a_dead_time_changes_nothing_and_a_small_motion_has_it() -> None:
    model = made(LATE.format(drive="u"))
    linear = tw.linearise(model, inputs=["u"], outputs=["x"], at={"x": 0.0})
    exact = np.exp(-0.137 * 3j) / (1 + 3j)
    np.testing.assert_allclose(linear.transfer(3j), [[exact]], rtol=1e-9)
