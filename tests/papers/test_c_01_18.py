"""Paper C, C01 to C18: every case of the shipped diagrams against an independent solution.

Parameters and starts are written here once more: that is how a preset with a wrong value is seen.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from oracles import c_0_hill as hill
from oracles import c_1_pendulum as pendulum
from oracles.c_common import Array
from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.solve import Run, simulate

FOLDER = Path(__file__).parents[2] / "diagrams/papers/c_review"


class Case(NamedTuple):
    """A diagram, the coordinates of its states, the independent solution, the start, the end."""

    diagram: str
    coordinates: tuple[str, ...]
    solve: Callable[..., Array]
    start: tuple[float, ...]
    end: float
    tolerance: float = 1e-6

    @property
    def states(self) -> list[str]:
        """The coordinates, each with its rate after it."""
        return [name for q in self.coordinates for name in (q, f"{q}_dot")]


EARTH = {"g": 9.81, "l0": 1.0}
HUNG = {"g": 9.81, "length": 1.0}
PULLED = {"alpha": 0.25, "eps": 0.2}
VEHICLE = {"m1": 1.0, "m2": 0.5, "length": 1.0, "g": 9.81, "kp": 20.0}
UPRIGHT = {"g": 9.81, "length": 0.25}
THREE = ((0.012, 100.0, 0.0), (0.012, 141.4, 1.0), (0.012, 173.2, 2.0))
PERIODIC = (-1.24993564489, -0.0828403932062)


def linear(
    diagram: str,
    coordinate: str,
    solve: Callable[..., Array],
    end: float,
    start: tuple[float, float] = (1, 0),
    **parameters: float,
) -> Case:
    """A case of one coordinate."""
    return Case(diagram, (coordinate,), partial(solve, **parameters), start, end)


def swing(
    diagram: str,
    solve: Callable[..., Array],
    start: float,
    end: float,
    tolerance: float = 1e-6,
    **parameters: object,
) -> Case:
    """A case of one angle from rest."""
    return Case(diagram, ("phi",), partial(solve, **parameters), (start, 0), end, tolerance)


def moved(diagram: str, solve: Callable[..., Array], start: float, end: float, **p: float) -> Case:
    """A case of an angle and a pivot, from rest."""
    return Case(diagram, ("phi", "y"), partial(solve, **p), (start, 0, 0, 0), end)


C02 = partial(linear, "c02_mathieu", "u", hill.mathieu, 100, beta=0.1)
C05 = partial(linear, "c05_hill_two_harmonics", "y", hill.two_harmonics, c1=0.5, c2=0.2)
C06 = partial(linear, "c06_meissner", "y", hill.meissner, 50)
C07 = partial(swing, "c07_constant_length", pendulum.constant_length, end=20, **EARTH)
C08 = partial(swing, "c08_mathieu_pendulum", hill.mathieu_pendulum, 0.1, 50, b=0.02)
C09 = "c09_variable_length_hill"
C09phi = partial(swing, C09, pendulum.periodic_length, 0.1, **PULLED)
C11 = partial(swing, "c11_laboratory_oscillator", pendulum.laboratory, 0.05, 20, **EARTH)
C12b = partial(moved, "c12_vertical_pivot_free", pendulum.free_pivot, 0.5, 20, **VEHICLE)
C13 = partial(swing, "c13_length_ramp", pendulum.ramp, end=20, v=0.1, **EARTH)
C16 = partial(linear, "c16_fast_excitation", "x", hill.fast, 20, gamma=0.1, w0sq=2.0)
C18 = partial(swing, "c18_inverted_multisine", pendulum.inverted, 0.2, **UPRIGHT)

CASES = {
    "C01": linear("c01_damped_hill", "x", hill.damped_hill, 50, b0=0.1, b1=0.05, w2=1, h=0.3),
    "C02u": C02(a=0.25),
    "C02s": C02(a=0.5),
    "C03": linear("c03_canonical_mathieu", "y", hill.canonical_mathieu, 50, a=2, q=0.2),
    "C04": linear(
        "c04_driven_parametric", "x", hill.driven, 30, PERIODIC, w0=2, b0=0.2, h0=0.2, E0=0.5
    ),
    "C05s": C05(50, c0=1.6),
    "C05u": C05(20, c0=1.2),
    "C06u": C06(r=0.5, omega=2.0),
    "C06s": C06(r=0.2, omega=1.8),
    "C06neg": C06(r=1.5, omega=6.0),
    "C07a": C07(1),
    "C07b": C07(3, tolerance=2e-5),
    "C08h": C08(s=1, alpha=0.25, delta=0.1),
    "C08hs": C08(s=1, alpha=0.25, delta=0.01),
    "C08i": C08(s=-1, alpha=0.01, delta=0.2),
    "C08iu": C08(s=-1, alpha=0.03, delta=0.2),
    "C09": linear(C09, "u", hill.length_hill, 40, (0.12, 0), **PULLED),
    "C09phi": C09phi(40, nonlinear=False),
    "C09non": C09phi(60, nonlinear=True),
    "C10": linear("c10_mathieu_truncation", "u", hill.truncation, 40, (0.12, 0), **PULLED),
    "C11u": C11(h=0.1, b=0.05),
    "C11s": C11(h=0.02, b=0.1),
    "C12a": swing("c12_vertical_pivot", pendulum.moved_pivot, 0.1, 20, Dy=0.05, b=0.05, **HUNG),
    "C12b": C12b(b=0.2, kd=4.0),
    "C12bc": C12b(b=0.0, kd=0.0),
    "C12c": moved(
        "c12_vertical_pivot_damping", pendulum.damped_sway, 1, 40, K=2, k1=2, k2=1, **HUNG
    ),
    "C13lin": C13(0.1, nonlinear=False),
    "C13": C13(1, nonlinear=True),
    "C14": linear("c14_hill_zero_mean", "x", hill.zero_mean, 20, w0=2, h=0.2),
    "C15": linear("c15_unstable_hill", "x", hill.unstable, 10, w0=20, nu=5),
    "C16a": C16(lam=10, beta=10),
    "C16b": C16(lam=100, beta=50),
    "C17": swing(
        "c17_averaged_pendulum", pendulum.parametric, 0.4, 100, eps=0.1, A=1, omega=1.95, s=0
    ),
    "C18s": C18(5, b=0.0, sines=((0.02, 150.0, 0.0),)),
    "C18u": C18(2, b=0.0, sines=((0.01, 150.0, 0.0),)),
    "C18m": C18(5, b=0.5, sines=THREE),
    "C18lin": linear("c18_inverted_linear", "phi", hill.inverted_linear, 20, (0.1, 0), A=0.1, w=20),
}
FIRST = {case.diagram: name for name, case in reversed(CASES.items())}
MODELS: dict[str, Model] = {}


def model_of(diagram: str) -> Model:
    """The model of a diagram, compiled once."""
    if diagram not in MODELS:
        MODELS[diagram] = compile(read(FOLDER / f"{diagram}.yaml"))
    return MODELS[diagram]


def run_of(name: str, preset: str, rtol: float = 1e-9) -> Run:
    return simulate(model_of(CASES[name].diagram), preset=preset, rtol=rtol)


@pytest.mark.parametrize("name", CASES)
def test_every_sample_of_a_case_is_that_of_the_independent_solution(name: str) -> None:
    case = CASES[name]
    run = run_of(name, name)
    assert run.t[0] == 0 and run.t[-1] == case.end
    assert [run.start[state] for state in case.states] == pytest.approx(list(case.start))
    solution = case.solve(run.t, case.start)
    for state, expected in zip(case.states, solution, strict=True):
        error = np.max(np.abs(run[state] - expected)) / np.max(np.abs(expected))
        assert error < case.tolerance, state


@pytest.mark.parametrize("diagram", FIRST)
def test_a_run_without_options_is_the_first_case(diagram: str) -> None:
    name = FIRST[diagram]
    plain, case = run_of(name, ""), run_of(name, name)
    assert plain.parameters == case.parameters
    assert all(np.array_equal(plain[state], case[state]) for state in CASES[name].states)


def test_the_switches_of_the_meissner_equation_are_hit_at_their_times() -> None:
    run = run_of("C06u", "C06u")
    switches = [event.time for event in run.events]
    assert switches == pytest.approx([n * pi / 2 for n in range(1, 32)], rel=1e-12)
    assert {event.kind for event in run.events} == {"scheduled"}


def test_no_diagram_is_without_a_case_and_no_case_without_a_preset() -> None:
    files = {path.stem for path in FOLDER.glob("c0*.yaml")}
    files |= {path.stem for path in FOLDER.glob("c1[0-8]*.yaml")}
    assert files == set(FIRST)
    presets = {name for diagram in files for name in model_of(diagram).flat.presets}
    assert presets - set(CASES) == {"C16b_fig9"} and presets >= set(CASES)
