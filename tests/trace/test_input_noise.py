"""A trace takes the declared noise of a measured input for noise, and for no missing effect."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.show.trace_summary import paragraph_of
from tracewire.show.trace_text import answer_lines
from tracewire.solve import simulate
from tracewire.trace import trace

CART = """\
span: [0, 20]
inputs: {F: {unit: N}}
parameters:
  c: {value: 5, unit: N s/m, fit: [0, 50]}
LEVEL
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  viscous: {type: viscous, rate: v, c: c}
COULOMB
  force: {type: sum, of: [F, viscous OF], unit: N}
  a: {type: gain, of: force, k: 1/1.2}
measured:
  run:
    file: run.csv
    time: t
    signals: {x: {column: x, sigma: 2e-5}}
    inputs: {F: {column: F, sigma: 0.02}}
    start: {x: free, v: free}
"""


def text(friction: bool) -> str:
    level = "  level: {value: 0.8, unit: N, fit: [0, 10]}" if friction else ""
    coulomb = "  coulomb: {type: coulomb, rate: v, level: level}" if friction else ""
    whole = CART.replace("LEVEL", level).replace("COULOMB", coulomb)
    return whole.replace(" OF", ", coulomb" if friction else "")


def write_record(folder: Path, declared: bool) -> Path:
    """The diagram of a cart whose force is measured with a noise of 0.02 N, with its record."""
    rng = np.random.default_rng(6)
    t = 0.01 * np.arange(1501)
    force = 4 * np.sin(2.3 * t + 1) + 3 * np.sin(6.1 * t) + 2 * np.sin(11 * t + 2)
    file = folder / "cart.yaml"
    noisy = force + 0.02 * rng.standard_normal(len(t))
    np.savetxt(
        folder / "run.csv", np.stack([t, t, noisy], 1), delimiter=",", header="t,x,F", comments=""
    )
    file.write_text(text(True), encoding="utf-8")
    true = {"c": 4.0, "level": 1.2}
    run = simulate(compile(read(file)), parameters=true, times=t, inputs={"F": (t, force)})
    x = run["x"] + 2e-5 * rng.standard_normal(len(t))
    np.savetxt(
        folder / "run.csv", np.stack([t, x, noisy], 1), delimiter=",", header="t,x,F", comments=""
    )
    file.write_text(text(declared), encoding="utf-8")
    return file


def without_sigma(file: Path) -> Path:
    """The diagram with no word of the noise of the force."""
    whole = file.read_text(encoding="utf-8").replace(", sigma: 0.02", "")
    file.write_text(whole, encoding="utf-8")
    return file


@pytest.mark.slow
@pytest.mark.parametrize("declared", [True, False])
@pytest.mark.parametrize("known", [True, False])
def test_noise_of_a_force_is_no_effect_and_hides_none(
    tmp_path: Path, declared: bool, known: bool
) -> None:
    file = write_record(tmp_path, declared)
    found = trace(compile(read(file if known else without_sigma(file))))
    assert found.verdict == ("null" if declared else "effect")
    assert [str(effect) for effect in found.effects] == ([] if declared else ["coulomb @ force"])
    assert found.s2_after == pytest.approx(1.0, abs=0.15)
    told = [word for word in found.words if "noise that the inputs show" in word]
    assert bool(told) != known
    for word in told:
        assert "0.02 N in 'F'" in word and "Say `sigma:` at an input" in word


@pytest.mark.slow
def test_what_the_noise_of_an_input_would_explain_is_told_with_its_size(tmp_path: Path) -> None:
    file = without_sigma(write_record(tmp_path, True))
    in_drive = {"effects": 1, "only": ["drive.F"], "input_shown": 0.0}
    found = trace(compile(read(file)), options=in_drive)
    assert found.verdict == "unexplained"
    (noisy,) = found.noisy_inputs
    assert noisy.name == "F" and noisy.left < 1.5
    assert noisy.sigma == pytest.approx(0.02, rel=0.15)
    told = f"noise of the input 'F' of {noisy.sigma:.2g} N would explain the residual"
    assert told in answer_lines(found)[0] and told in paragraph_of(found)
    most = (
        0.9
        * noisy.sigma
        / float(np.std(np.loadtxt(file.parent / "run.csv", delimiter=",", skiprows=1)[:, 2]))
    )
    options = {**in_drive, "input_noise": most}
    assert trace(compile(read(file)), options=options).noisy_inputs == ()


def test_a_delay_reads_a_noisy_drive(tmp_path: Path) -> None:
    """No effect is tried in that drive, and its noise is not followed; the trace does not end."""
    file = without_sigma(write_record(tmp_path, False))
    late = file.read_text(encoding="utf-8").replace("of: [F, ", "of: [late, ")
    late = late.replace("blocks:\n", "blocks:\n  late: {type: delay, of: F, time: 0.2}\n")
    file.write_text(late, encoding="utf-8")
    model = compile(read(file))
    t, _, noisy = np.loadtxt(file.parent / "run.csv", delimiter=",", skiprows=1).T
    x = simulate(model, parameters={"c": 4.0}, times=t, inputs={"F": (t, noisy)})["x"]
    x = x + 2e-5 * np.random.default_rng(3).standard_normal(len(t))
    table = np.stack([t, x, noisy], 1)
    np.savetxt(file.parent / "run.csv", table, delimiter=",", header="t,x,F", comments="")
    found = trace(compile(read(file)), options={"effects": 1})
    assert found.verdict == "null"
    assert found.declared["c"] == pytest.approx(4.0, rel=1e-3)
    assert any("nothing is tried in the drive 'F': a delay reads it" in w for w in found.words)
