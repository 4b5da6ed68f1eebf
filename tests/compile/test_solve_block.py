"""The block `solve`, M x = f: against numpy, its derivatives, and a double pendulum."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from compile.calls import Point, bits, both, moved, values
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import made, run
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.errors import DiagramError, SimulationError
from tracewire.solve import simulate

ROOT = Path(__file__).parents[2]


def diagram(size: int, more: str = "") -> str:
    """A system of any numbers, which stand in parameters."""
    rows = [[f"m{i}{j}" for j in range(size)] for i in range(size)]
    right = [f"f{i}" for i in range(size)]
    names = [*itertools.chain(*rows), *right]
    return f"""
span: [0, 1]
record: [a]
parameters: {{{", ".join(f"{name}: 1" for name in names)}}}
blocks:
  a: {{type: solve, matrix: [{", ".join(f"[{', '.join(row)}]" for row in rows)}],
       right: [{", ".join(right)}]}}
  x: {{type: integrator, of: a}}
{more}"""


SYSTEMS = {size: both(diagram(size)) for size in range(1, 6)}


def solved(matrix: np.ndarray, right: np.ndarray) -> list[float]:
    machine, python = SYSTEMS[len(right)]
    where = Point(0.0, [0.0] * len(right), [], [*matrix.flatten(), *right], [])
    found = values(machine, "outputs", where)
    assert bits(found) == bits(values(python, "outputs", where))
    return found


@given(size=st.integers(1, 5), seed=st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_it_solves_as_numpy_does(size: int, seed: int) -> None:
    draw = np.random.default_rng(seed)
    # many zeros, and sizes that differ much, so that rows have to be exchanged
    matrix = draw.normal(size=(size, size)) * draw.integers(0, 2, (size, size))
    matrix *= 10.0 ** draw.integers(-3, 4, (size, 1))
    right = draw.normal(size=size)
    condition = np.linalg.cond(matrix)
    if condition > 1e10:
        return
    expected = np.linalg.solve(matrix, right)
    scale = np.max(np.abs(expected))
    assert solved(matrix, right) == pytest.approx(expected, abs=1e-14 * condition * scale)


def test_a_zero_on_the_diagonal_is_no_obstacle() -> None:
    assert solved(np.array([[0.0, 2.0], [4.0, 0.0]]), np.array([6.0, 8.0])) == [2.0, 3.0]
    text = "blocks: {a: {type: solve, matrix: [[0, k], [4, 0]], right: [6, 8]}}"
    model = made(f"record: [a]\nparameters: {{k: 2}}\n{text}")
    assert values(model, "outputs", Point(0, [], [], [2.0], [])) == [2.0, 3.0]


def test_the_growth_of_errors_is_that_of_partial_pivoting() -> None:
    """Without exchange of rows the small pivot loses every digit."""
    found = solved(np.array([[1e-20, 1.0], [1.0, 1.0]]), np.array([1.0, 2.0]))
    assert found == pytest.approx([1.0, 1.0], rel=1e-15)


def test_what_is_known_to_be_zero_costs_nothing() -> None:
    text = "blocks: {a: {type: solve, matrix: [[k, 0, 0], [0, k, 0], [0, 0, 1]], right: [1, 2, t]}}"
    model = made(f"record: [a]\nparameters: {{k: 2}}\n{text}")
    tape = model.lowered.tape
    outputs = [model.lowered.entries[f"a[{i}]"] for i in range(3)]
    operations = {tape.entries[i].op for i in tape.needed(outputs) if tape.entries[i].operands}
    assert operations == {"/"}


@pytest.mark.parametrize("seed", range(20))
def test_derivatives_are_those_of_finite_differences(seed: int) -> None:
    text = """
blocks:
  x: {type: integrator, of: "a[0]"}
  y: {type: integrator, of: "a[1]"}
  z: {type: integrator, of: "a[2]"}
  a:
    type: solve
    matrix:
      - [2 + x*x, cos(x - y), z]
      - [cos(x - y), 1 + t, 0.1]
      - [x*y, 0.2, 3 + sin(z)]
    right: [-x, sin(z*y), t*x - y]
  s: {type: expression, formula: "sign(a[0] + a[1]*a[2])"}
"""
    machine, python = both(text)
    draw = np.random.default_rng(seed)
    at = Point(float(draw.random()), draw.normal(size=3).tolist(), [1.0, 0.0], [], [])

    def differences(name: str, index: int) -> np.ndarray:
        def slope(h: float) -> np.ndarray:
            high, low = (np.array(values(machine, name, moved(at, index, s))) for s in (h, -h))
            return (high - low) / (2 * h)

        return (4 * slope(5e-5) - slope(1e-4)) / 3

    exact = np.reshape(values(machine, "jacobian", at), (3, 4))
    found = np.stack([differences("rhs", index) for index in (0, 1, 2, -1)], axis=1)
    assert exact == pytest.approx(found, rel=1e-7, abs=1e-7 * np.max(np.abs(exact)))
    flow = [*values(machine, "rhs", at), 1.0]
    for lower, higher in (("guards", "guard_rates"), ("guard_rates", "guard_second")):
        along = sum(
            differences(lower, i) * rate for i, rate in zip((0, 1, 2, -1), flow, strict=True)
        )
        assert values(machine, higher, at) == pytest.approx(along, rel=1e-6, abs=1e-6)
    for name in ("jacobian", "guard_second", "guard_fourth"):
        assert bits(values(machine, name, at)) == bits(values(python, name, at))


def test_a_singular_matrix_ends_the_run_at_its_block() -> None:
    text = """
span: [0, 2]
blocks:
  a: {type: solve, matrix: [["k", 1], [1, 1]], right: [1, 2]}
  x: {type: integrator, of: a}
parameters: {k: 1}
"""
    with pytest.raises(SimulationError, match=r"block 'a\["):
        run(text)


PENDULUM = ROOT / "diagrams" / "lessons" / "double_pendulum.yaml"


def test_a_double_pendulum_has_the_rates_of_its_closed_form() -> None:
    model = compile(read(PENDULUM))
    g, length = 9.81, 0.5
    for t1, t2, w1, w2 in ((2.0, 1.0, 0.0, 0.0), (0.3, -1.2, 4.0, -2.0), (3.0, 2.9, -1.0, 5.0)):
        d = t1 - t2
        below = length * (3 - math.cos(2 * d))
        a1 = -3 * g * math.sin(t1) - g * math.sin(t1 - 2 * t2)
        a1 -= 2 * math.sin(d) * length * (w2**2 + w1**2 * math.cos(d))
        a2 = 2 * w1**2 * length + 2 * g * math.cos(t1) + w2**2 * length * math.cos(d)
        a2 *= 2 * math.sin(d)
        rates = values(model, "rhs", Point(0.0, [t1, t2, w1, w2], [], [g, length], []))
        assert rates == pytest.approx([w1, w2, a1 / below, a2 / below], rel=1e-13)


def test_a_double_pendulum_keeps_its_energy() -> None:
    result = simulate(compile(read(PENDULUM)), rtol=1e-9)
    assert list(result.signals) == ["q[0]", "q[1]", "energy"]
    assert result["energy"] == pytest.approx(result["energy"][0], abs=1e-6)
    assert np.ptp(result["q[1]"]) > 2


def test_a_system_may_stand_in_a_loop() -> None:
    """M a = f - c*a with a wired back is (M + c) a = f."""
    text = """
record: [a]
parameters: {c: 0.5}
blocks:
  a: {type: solve, matrix: [[2, 1], [1, 3]], right: ["1 - c*a[0]", "2 - c*a[1]"]}
"""
    found = values(made(text), "outputs", Point(0, [], [], [0.5], []))
    assert found == pytest.approx(np.linalg.solve([[2.5, 1], [1, 3.5]], [1, 2]), rel=1e-14)


def test_a_number_is_a_system_of_one() -> None:
    model = made("record: [a]\nblocks: {a: {type: solve, matrix: 4, right: 2}}")
    assert values(model, "outputs", Point(0, [], [], [], [])) == [0.5]


@pytest.mark.parametrize(
    ("matrix", "right", "told"),
    [
        ("[[1, 2]]", "[1]", "the matrix in 'solve([[1, 2]], [1])' must be square, and it is 1x2"),
        ("[1, 2]", "[1, 2]", "must be square, and it is a vector of 2"),
        (
            "[[1, 2], [3, 4]]",
            "[1, 2, 3]",
            "a matrix of 2x2 and a vector of 3 do not go together in 'solve(",
        ),
        ("[[1, 2], [3]]", "[1, 2]", "a matrix has rows of one length, and row 1 has another"),
        ("[[1, 2], 3]", "[1, 2]", "a matrix has rows of one length, and row 1 has another"),
        ("[[[1]]]", "[1]", "a list of matrices is no matrix"),
        ("[]", "[1]", "a vector has at least one element"),
    ],
)
def test_shapes_that_do_not_go_together_are_refused(matrix: str, right: str, told: str) -> None:
    with pytest.raises(DiagramError) as caught:
        made(f"blocks:\n  a: {{type: solve, matrix: {matrix}, right: {right}}}")
    assert told in str(caught.value)
    assert "<text>:2:" in str(caught.value)
    assert "block 'a'" in str(caught.value)


def test_a_large_full_system_is_refused_at_once() -> None:
    with pytest.raises(DiagramError, match=r"100 unknowns.*Full ones may have 60") as caught:
        made(banded(100, 100))
    assert caught.value.problems[0].place.line > 0


def test_a_large_system_with_few_entries_is_solved() -> None:
    """4*a[i] + c*(a[i - 1] + a[i + 1]) = 1."""
    matrix = 4 * np.eye(70) + 0.1 * (np.eye(70, k=1) + np.eye(70, k=-1))
    result = run(banded(70, 1), times=[1.0])
    assert result.final["x"] == pytest.approx(np.linalg.solve(matrix, np.ones(70))[0], rel=1e-9)


def banded(size: int, width: int) -> str:
    """A system with a parameter beside its diagonal."""
    rows = [
        ["4" if i == j else "c" if abs(i - j) <= width else "0" for j in range(size)]
        for i in range(size)
    ]
    matrix = ", ".join(f"[{', '.join(row)}]" for row in rows)
    return f"""
span: [0, 1]
parameters: {{c: 0.1}}
blocks:
  x: {{type: integrator, of: "a[0]"}}
  a: {{type: solve, matrix: [{matrix}], right: [{", ".join(["1"] * size)}]}}
"""
