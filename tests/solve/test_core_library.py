"""The machine code of the core does what its Python says, which a debugger can follow."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import DOP853
from solve.models import BALL
from tracewire import compile, read, read_text, simulate
from tracewire.errors import SimulationError
from tracewire.shipped import shipped
from tracewire.solve import integrator
from tracewire.solve.core import integrate
from tracewire.solve.core.methods import dop853_coefficients as written
from tracewire.solve.core_library import library

SLIDE = """\
span: [0, 3]
parameters: {c: 0.3}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: 0.5}
  a: {type: expression, formula: "-5*x - c*v + friction"}
"""

SHIPPED = [
    file
    for file in sorted(shipped("diagrams").rglob("*.yaml"))
    if "\nblocks:" in file.read_text(encoding="utf-8")
    and "real" not in file.parts  # these need their records
]
STEPS = 20  # Python takes 10 ms and more for each


def by_python(core: int) -> int:
    """The same as `library().advance`, one line of Python after the other."""
    with np.errstate(all="ignore"):
        return int(integrate.advance(core))


@pytest.mark.parametrize("method", ["dormand_prince", "dop853", "rosenbrock"])
@pytest.mark.parametrize("text", [SLIDE, BALL.replace("[0, 12]", "[0, 3]")])
def test_python_and_machine_code_agree_to_the_last_bit(
    text: str, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = compile(read_text(text))
    run = simulate(model, method=method)
    monkeypatch.setattr(integrator, "library", lambda: replace(library(), advance=by_python))
    same = simulate(model, method=method)
    assert same.events == run.events
    assert run.events
    assert same.final == run.final


@pytest.mark.slow
@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: file.stem)
def test_they_agree_where_each_shipped_diagram_begins(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = compile(read(file))
    whole = simulate(model)
    begin, end = float(whole.t[0]), float(whole.t[-1])
    part = min(1.0, STEPS / max(whole.statistics.steps, 1))
    span = (begin, begin + part * (end - begin))
    run = simulate(model, span=span)
    assert run.statistics.steps > 0
    monkeypatch.setattr(integrator, "library", lambda: replace(library(), advance=by_python))
    same = simulate(model, span=span)
    assert same.final == run.final
    assert same.events == run.events
    for name, values in run.signals.items():
        assert np.array_equal(same[name], values), name


def test_an_error_inside_of_the_machine_code_is_told() -> None:
    model = compile(read_text(SLIDE))
    library().fault.value = 1
    with pytest.raises(SimulationError, match="the integrator failed inside a step"):
        simulate(model)
    assert simulate(model).final


def test_the_coefficients_are_those_of_scipy() -> None:
    """They are written down because scipy.integrate takes half a second to import."""
    main, last = DOP853.A.shape[0], len(DOP853.B)
    assert np.array_equal(written.A[:main, :main], DOP853.A)
    assert np.array_equal(written.A[main, :last], DOP853.B)
    assert np.array_equal(written.A[main + 1 :], DOP853.A_EXTRA)
    assert np.array_equal(written.C, [*DOP853.C, 1.0, *DOP853.C_EXTRA])
    for name in ("E3", "E5", "D"):
        assert np.array_equal(getattr(written, name), getattr(DOP853, name))
