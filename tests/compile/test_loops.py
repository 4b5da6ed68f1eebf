"""Algebraic loops: found port by port, eliminated or searched, refused without a solution."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
import pytest
from compile.calls import LAZY, Point, bits, both, moved, values
from hypothesis import given, settings
from hypothesis import strategies as st
from solve.models import made, run
from tracewire.compile import Model
from tracewire.errors import DiagramError, SimulationError

HEAD = """
span: [0, 1]
parameters: {k: 2.5}
blocks:
  x: {type: integrator, of: y, start: 0.4}
"""


def point(
    x: Sequence[float] = (0.4,), t: float = 0.0, k: float = 2.5, m: Sequence[float] = ()
) -> Point:
    return Point(t, x, [*m, *(0.0 for _ in m)], [k], [])


def at(blocks: str, *record: str, **given: float) -> list[float]:
    """The values of signals at a point, the same bits from both back ends."""
    machine, python = both(HEAD + blocks, record)
    where = point(**given)  # type: ignore[arg-type]
    found = values(machine, "outputs", where)
    assert bits(found) == bits(values(python, "outputs", where))
    return found[-len(record) :] if record else found


def refused(blocks: str) -> str:
    with pytest.raises(DiagramError) as caught:
        made(blocks)
    return str(caught.value)


# linear loops


def test_a_linear_loop_has_its_exact_solution() -> None:
    blocks = "  y: {type: expression, formula: x - k*z}\n  z: {type: gain, of: y, k: 3}\n"
    y, z = at(blocks, "y", "z", k=0.5)
    assert y == pytest.approx(0.4 / 2.5, rel=1e-15)
    assert z == 3 * y


def test_a_signal_may_read_itself() -> None:
    assert at("  y: {type: expression, formula: 3*x - 5*y}\n", "y") == pytest.approx([0.2])


def test_a_loop_of_numbers_costs_nothing_at_run_time() -> None:
    model = made("blocks: {y: {type: expression, formula: 3 - 2*y}, x: {type: integrator, of: y}}")
    assert model.lowered.tape.value(model.lowered.entries["y"]) == 1.0


def test_a_run_of_a_loop() -> None:
    """x' = y, y = -x - 3*y: x = e^(-t/4)."""
    result = run(HEAD + "  y: {type: expression, formula: -x - 3*y}\n")
    assert result["x"] == pytest.approx(0.4 * np.exp(-result.t / 4), rel=1e-5)


@given(size=st.integers(2, 6), seed=st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_random_linear_loops_are_those_of_numpy(size: int, seed: int) -> None:
    draw = np.random.default_rng(seed)
    gains = draw.normal(size=(size, size)) * draw.integers(0, 2, (size, size))
    ends = draw.normal(size=size)
    system = np.eye(size) - gains
    if np.linalg.cond(system) > 1e6:
        return
    names = [f"y{i}" for i in range(1, size)]
    lines = []
    for i, name in enumerate(["y", *names]):
        terms = [
            f"{ends[i]!r}",
            *(f"{g!r}*{n}" for g, n in zip(gains[i], ["y", *names], strict=True) if g),
        ]
        text = " + ".join(terms).replace("np.float64(", "").replace(")", "")
        # a parameter in one place keeps the loop from being folded to a number
        lines.append(f'  {name}: {{type: expression, formula: "{text} + k - 2.5"}}')
    found = at("\n".join(lines) + "\n", "y", *names)
    assert found == pytest.approx(np.linalg.solve(system, ends), rel=1e-8, abs=1e-9)


def test_a_ring_of_many_blocks_is_opened_once() -> None:
    count = 500
    lines = [
        f"  b{i}: {{type: expression, formula: 0.5*b{(i + 1) % count} + k}}" for i in range(count)
    ]
    model = made(HEAD + "\n".join([*lines, "  y: {type: gain, of: b7, k: 1}"]))
    (loop,) = model.flat.loops
    assert len(loop.unknowns) == 1
    assert values(model, "rhs", point()) == pytest.approx([5.0], rel=1e-12)


def test_loops_are_solved_one_after_the_other() -> None:
    blocks = """
  y: {type: expression, formula: a + b}
  b: {type: expression, formula: 1 + a - b}
  a: {type: expression, formula: 2*x - a}
"""
    assert len(made(HEAD + blocks).flat.loops) == 2
    assert at(blocks, "a", "b", "y") == pytest.approx([0.4, 0.7, 1.1], rel=1e-15)


# through subsystems

PORTS = """
blocks:
  s: {type: two, u: a, v: b}
  a: {type: gain, of: s.%s, k: 0.1}
  b: {type: gain, of: s.%s, k: 0.1}
subsystems:
  two:
    inputs: [u, v]
    outputs: {y: k, z: i, w: m}
    blocks:
      k: {type: gain, of: v, k: 2}
      i: {type: integrator, of: u, start: 1}
      m: {type: gain, of: u, k: 2}
"""


@pytest.mark.parametrize(
    ("a", "b", "loop"),
    [
        ("y", "z", ""),  # a reads v through the subsystem, b reads a state: no way around
        ("z", "z", ""),
        ("y", "w", "a -> s.m -> b -> s.k -> a"),
        ("w", "z", "a -> s.m -> a"),
        ("z", "y", "b -> s.k -> b"),
    ],
)
def test_a_subsystem_is_followed_port_by_port(a: str, b: str, loop: str) -> None:
    found = [found.text for found in made(PORTS % (a, b)).flat.loops]
    assert len(found) == bool(loop)
    names = loop.split(" -> ")[:-1]
    turned = [" -> ".join([*names[i:], *names[: i + 1]]) for i in range(len(names))]
    assert not loop or found[0] in turned


def test_a_loop_through_two_levels_and_a_plain_passage_is_solved() -> None:
    text = """
span: [0, 1]
blocks:
  a: {type: expression, formula: 3 - 2*o.y}
  o: {type: outer, u: p}
  p: {type: through, u: a}
  x: {type: integrator, of: a}
subsystems:
  through: {inputs: [u], outputs: {y: u}, blocks: {}}
  outer: {inputs: [u], outputs: {y: i}, blocks: {i: {type: inner, u: u}}}
  inner: {inputs: [u], outputs: {y: g}, blocks: {g: {type: gain, of: u, k: 0.5}}}
"""
    assert run(text, record=("a", "o.y"))["o.y"] == pytest.approx(0.75)


# loops that nothing solves


@pytest.mark.parametrize(
    ("text", "place", "loop"),
    [
        ("blocks: {a: {type: gain, of: a, k: 1}}", "1:10: block 'a'", "a -> a"),
        (
            "blocks:\n  a: {type: gain, of: d, k: 2}\n  x: {type: integrator, of: a}\n"
            "  d: {type: sum, of: [c, x]}\n  c: {type: expression, formula: 0.5*a}",
            "2:3: block 'a'",
            "a -> d -> a",
        ),
        (
            "blocks: {p: {type: s, u: p.y}}\n"
            "subsystems: {s: {inputs: [u], outputs: {y: u}, blocks: {}}}",
            "2:44",
            "p.y -> p.y",
        ),
    ],
)
def test_a_loop_with_the_gain_one_is_refused_with_the_whole_loop(
    text: str, place: str, loop: str
) -> None:
    told = refused(text)
    names = loop.split(" -> ")
    assert place in told
    assert "algebraic loop without a solution, or with any: " in told
    assert all(name in told for name in names)
    assert "The gain round the loop is exactly 1" in told


def test_two_loops_that_say_the_same_are_refused() -> None:
    text = """
blocks:
  a: {type: expression, formula: 2*a + b - 1}
  b: {type: expression, formula: a + 2*b - 1}
"""
    told = refused(text)
    assert "algebraic loops of 2 signals without a solution, or with any" in told
    assert ":3:3: block 'a'" in told


def test_loops_that_lack_an_equation_are_refused_whatever_their_numbers() -> None:
    text = """
parameters: {k: 2}
blocks:
  a: {type: expression, formula: a + k*c}
  b: {type: expression, formula: b + sin(c)}
  c: {type: expression, formula: a*b + c*k}
"""
    assert "algebraic loops of 3 signals without a solution" in refused(text)


def test_too_many_unknowns_are_refused() -> None:
    lines = [
        f"  b{i}: {{type: expression, formula: 0.1*b{(i + 1) % 70}*b{i} + 1}}" for i in range(70)
    ]
    told = refused("\n".join(["blocks:", *lines]))
    assert "algebraic loops: more than 60 signals depend on each other: b0 -> " in told
    assert "Break the loops with states" in told


def test_a_very_long_loop_is_shown_in_part() -> None:
    lines = [f"  b{i}: {{type: gain, of: b{(i + 1) % 300}, k: 1}}" for i in range(300)]
    told = refused("\n".join(["blocks:", *lines]))
    assert told.count("->") == 99
    assert "-> ... -> b0." in told


def test_a_gain_that_is_one_at_run_time_is_not_finite() -> None:
    assert at("  y: {type: expression, formula: x + k*y}\n", "y", k=1.0) == [math.inf]
    blocks = HEAD.replace("2.5", "1") + "  y: {type: expression, formula: x + k*y}\n"
    with pytest.raises(SimulationError, match="block 'y'"):
        run(blocks)


# nonlinear loops


def test_a_nonlinear_loop_is_searched() -> None:
    y, z = at(
        "  y: {type: expression, formula: cos(y) - 0.3*z*x}\n"
        '  z: {type: expression, formula: "y*z/5 + tanh(z + y)/2 + 1"}\n',
        "y",
        "z",
    )
    assert y == pytest.approx(math.cos(y) - 0.3 * z * 0.4, abs=1e-15)
    assert z == pytest.approx(y * z / 5 + math.tanh(z + y) / 2 + 1, abs=1e-15)


@pytest.mark.parametrize(("guess", "root"), [(1, math.sqrt(2)), (-0.1, -math.sqrt(2))])
def test_a_guess_says_which_solution_is_meant(guess: float, root: float) -> None:
    blocks = f"  y: {{type: expression, formula: y + 2 - y*y, guess: {guess}}}\n"
    assert at(blocks, "y") == pytest.approx([root], rel=1e-15)


def test_a_loop_is_opened_at_the_guess() -> None:
    blocks = "  y: {type: sqrt, of: z}\n  z: {type: expression, formula: y + 2, guess: 9}\n"
    assert made(HEAD + blocks).flat.loops[0].unknowns == ("z",)
    assert at(blocks, "y", "z") == pytest.approx([2, 4], rel=1e-15)


def test_steps_that_go_too_far_are_shortened() -> None:
    """Newton's plain search of atan(y) = 0 diverges from y = 5."""
    blocks = "  y: {type: expression, formula: y - atan(y), guess: 5}\n"
    assert at(blocks, "y") == pytest.approx([0], abs=1e-15)


@pytest.mark.parametrize("formula", ["y + 1 + y*y", "y + 2 + sin(y)", "y + log(y)"])
def test_a_search_that_ends_nowhere_is_not_finite(formula: str) -> None:
    blocks = f'  y: {{type: expression, formula: "{formula}"}}\n'
    assert not math.isfinite(at(blocks, "y")[0])
    with pytest.raises(SimulationError, match="block 'y'"):
        run(HEAD + blocks)


@given(a=st.floats(0.1, 3), b=st.floats(-3, 3), c=st.floats(-0.9, 0.9), x=st.floats(-5, 5))
@settings(max_examples=25, deadline=None)
def test_a_search_finds_the_solution_of_a_monotone_loop(
    a: float, b: float, c: float, x: float
) -> None:
    blocks = f'  y: {{type: expression, formula: "{c}*sin(y) - {a}*y**3 + {b} + x"}}\n'
    (y,) = at(blocks, "y", x=(x,))  # type: ignore[arg-type]
    assert y == pytest.approx(c * math.sin(y) - a * y**3 + b + x, abs=1e-12)


# derivatives

CURVED = """
span: [0, 1]
parameters: {k: 0.7}
blocks:
  x: {type: integrator, of: y, start: 0.3}
  v: {type: integrator, of: z, start: -0.3}
  y: {type: expression, formula: "cos(y) + 0.1*x - 0.2*sin(z)*k", guess: 0.5}
  z: {type: expression, formula: "0.3*z*sin(y) + exp(-z*z) + t*v"}
  p: {type: expression, formula: "x + 0.5*q - sin(v)*p"}
  q: {type: expression, formula: "t - 0.3*p*x"}
  s: {type: expression, formula: "sign(y + p + q) + sign(z*q - x)"}
"""
WHERE = Point(0.3, [0.3, -0.2], [1.0] * 4, [0.7], [])


def derivative(model: Model, name: str, index: int, step: float = 1e-4) -> np.ndarray:
    """The Richardson value of two central differences."""

    def slope(h: float) -> np.ndarray:
        high, low = (np.array(values(model, name, moved(WHERE, index, s))) for s in (h, -h))
        return (high - low) / (2 * h)

    return (4 * slope(step / 2) - slope(step)) / 3


def test_derivatives_are_those_of_finite_differences() -> None:
    model = made(CURVED)
    jacobian = np.reshape(values(model, "jacobian", WHERE), (2, 3))
    rates = [derivative(model, "rhs", index) for index in (0, 1, -1)]
    assert jacobian == pytest.approx(np.stack(rates, axis=1), rel=1e-8, abs=1e-9)
    gradients = np.reshape(values(model, "guard_gradients", WHERE), (-1, 2))
    rates = [derivative(model, "guards", index) for index in (0, 1)]
    assert gradients == pytest.approx(np.stack(rates, axis=1), rel=1e-8, abs=1e-9)
    curves = np.reshape(values(model, "guard_curves", WHERE), (-1, 3))
    rates = [derivative(model, "guard_rates", index) for index in (0, 1, -1)]
    assert curves == pytest.approx(np.stack(rates, axis=1), rel=1e-8, abs=1e-9)


def test_higher_derivatives_along_the_flow() -> None:
    model = made(CURVED)
    names = ("guard_rates", "guard_second", "guard_third", "guard_fourth")
    for lower, higher in itertools.pairwise(names):
        along = derivative(model, lower, -1)
        for index, rate in enumerate(values(model, "rhs", WHERE)):
            along = along + rate * derivative(model, lower, index)
        assert values(model, higher, WHERE) == pytest.approx(along, rel=1e-6, abs=1e-7)


def test_derivatives_are_the_same_bits_in_both_back_ends() -> None:
    machine, python = both(CURVED)
    for name in LAZY:
        assert bits(values(machine, name, WHERE)) == bits(values(python, name, WHERE))


def test_derivatives_in_parameters() -> None:
    model = made(CURVED)
    name = model.derivative("rhs", ["k"])
    from compile.calls import called  # the length of its result is told by nobody else

    def rates(k: float) -> np.ndarray:
        return np.array(values(model, "rhs", Point(WHERE.t, WHERE.x, WHERE.m, [k], [])))

    c = called(model.routines.address("prepare"), model.routines.sizes.constants, x=WHERE.p)
    exact = called(model.routines.address(name), 2, WHERE.t, WHERE.x, WHERE.m, c)
    assert exact == pytest.approx((rates(0.70001) - rates(0.69999)) / 2e-5, rel=1e-7)


# loops through modes


def consistent(model: Model, t: float, x: Sequence[float] = (0.0,)) -> list[list[float]]:
    """The recorded signals in each combination of modes that its own guards agree with."""
    found = []
    for modes in itertools.product((0.0, 1.0), repeat=len(model.modes)):
        where = Point(t, x, [*modes, *(0.0 for _ in modes)], [], [])
        guards = values(model, "guards", where)
        if all((guard >= 0) == bool(mode) for guard, mode in zip(guards, modes, strict=True)):
            found.append(values(model, "outputs", where))
    return found


@pytest.mark.parametrize("t", [-7.5, -4.1, -3.9, 0.3, 2.0, 3.9, 4.1, 9.0])
def test_a_saturated_loop_is_solved_in_each_of_its_modes(t: float) -> None:
    """y = sat(t - 3*y) is t/4 within +-1."""
    model = made("""
record: [y]
blocks:
  e: {type: expression, formula: t - 3*y}
  y: {type: saturation, of: e, low: -1, high: 1}
""")
    assert consistent(model, t) == [[pytest.approx(np.clip(t / 4, -1, 1))]]
    assert model.lowered.loops == [(0, 1)]


@pytest.mark.parametrize("t", [-3.0, -0.2, 0.1, 0.9, 2.5])
def test_a_loop_through_several_kinks_has_one_solution(t: float) -> None:
    model = made("""
record: [y, z]
blocks:
  y: {type: expression, formula: "t - 0.5*abs(y) - 0.3*max(y, z)"}
  z: {type: expression, formula: "0.2*y + 1"}
""")
    ((y, z),) = consistent(model, t)
    assert y == pytest.approx(t - 0.5 * abs(y) - 0.3 * max(y, z), abs=1e-14)


@pytest.mark.parametrize(("t", "solutions"), [(-3.0, [-1.0]), (0.5, []), (3.0, [1.0])])
def test_a_loop_through_a_jump_may_have_no_solution_and_is_left_to_the_run(
    t: float, solutions: list[float]
) -> None:
    model = made("record: [y]\nblocks: {y: {type: expression, formula: t - 2*sign(y)}}")
    assert [y for (y,) in consistent(model, t)] == solutions


def test_guards_outside_of_a_loop_share_the_mode_inside() -> None:
    model = made("""
blocks:
  y: {type: expression, formula: "t - 0.5*abs(y)"}
  z: {type: abs, of: y}
  x: {type: integrator, of: z}
""")
    assert len(model.modes) == 1


def test_a_guard_that_its_own_loop_moves_is_no_known_time() -> None:
    """z = t - 3 - abs(z)/2 is (t - 3)/1.5 above zero and 2*(t - 3) below it: it is located."""
    text = """
span: [0, 6]
record: [z]
blocks:
  z: {type: expression, formula: "t - 3 - 0.5*abs(z)"}
  x: {type: integrator, of: z}
"""
    (mode,) = made(text).modes
    assert mode.timed is None
    result = run(text)
    past = result.t - 3
    assert result["z"] == pytest.approx(np.where(past > 0, past / 1.5, 2 * past), abs=1e-12)
    assert [event.time for event in result.events] == pytest.approx([3.0], abs=1e-12)


@pytest.mark.parametrize("low", [-2.0, -0.5])
def test_a_run_through_the_kinks_of_a_loop(low: float) -> None:
    """y = max(x - 2*y, low) falls with x' = -1 from x = 3 through 3*low."""
    text = f"""
span: [0, 12]
record: [x, y]
blocks:
  x: {{type: integrator, of: down, start: 3}}
  down: {{type: constant, value: -1}}
  y: {{type: expression, formula: "max(x - 2*y, {low})"}}
"""
    result = run(text)
    assert result["y"] == pytest.approx(np.maximum(result["x"] / 3, low), abs=1e-9)
    assert [event.time for event in result.events] == pytest.approx([3 - 3 * low])
