"""Vector signals: shapes, elements, and what they become."""

from __future__ import annotations

import numpy as np
import pytest
from compile.calls import Point, values
from solve.models import made, run
from tracewire.compile.vectors import find_shapes
from tracewire.errors import DiagramError, OptionError
from tracewire.formula import Call, Expression, Name, Number, parse
from tracewire.solve import parameter_values

CHAIN = """
span: [0, 2]
record: [q]
parameters: {c: 3}
blocks:
  q: {type: integrator, of: v, start: [0.1, {value: 20, unit: deg, fit: [0, 90]}, 0], unit: rad}
  v: {type: integrator, of: force, unit: rad/s}
  force: {type: matrix_gain, of: q, matrix: [[-2*c, c, 0], [c, -2*c, c], [0, c, -c]]}
"""


def test_a_chain_of_three_bodies_moves_in_its_eigenmodes() -> None:
    result = run(CHAIN)
    assert list(result.signals) == ["q[0]", "q[1]", "q[2]"]
    matrix = 3.0 * np.array([[-2, 1, 0], [1, -2, 1], [0, 1, -1]])
    squares, shapes = np.linalg.eigh(-matrix)
    start = np.array([0.1, np.deg2rad(20), 0.0])
    modal = np.cos(np.sqrt(squares) * result.t[:, None]) * (shapes.T @ start)
    found = np.stack(list(result.signals.values()), axis=1)
    assert found == pytest.approx(modal @ shapes.T, abs=1e-5)


def test_a_vector_is_its_elements() -> None:
    model = made(CHAIN)
    assert model.states == ("q[0]", "q[1]", "q[2]", "v[0]", "v[1]", "v[2]")
    assert model.recorded == ("q[0]", "q[1]", "q[2]")
    assert model.flat.shapes == {"q": (3,), "v": (3,), "force": (3,)}
    assert model.flat.units["q[1]"] == "rad"
    assert model.flat.blocks["force[2]"].definition == "force"
    assert "q[0]' = v[0]" in model.equations


def test_an_element_of_a_start_is_a_parameter_of_its_own() -> None:
    model = made(CHAIN)
    assert model.flat.parameters["q.start[1]"].fit == pytest.approx((0, np.pi / 2))
    assert parameter_values(model, {})["q.start[1]"] == pytest.approx(np.deg2rad(20))
    with_preset = made(CHAIN + "presets: {low: {'q.start[1]': 9}}\n")
    assert parameter_values(with_preset, {}, "low")["q.start[1]"] == pytest.approx(np.deg2rad(9))


TABLE = [1.0, 2.0, 0.0, 1.0, 0.0, 2.0, 2.0]
"""A table of [0, 0] and [1, 2]: where it begins, the number of points, x, y, slope."""
ALL = """
record: [y, z]
blocks:
  u: {type: expression, formula: [1, t, -3]}
  w: {type: mux, of: [a, "u[1]", -a]}
  a: {type: constant, value: 4}
  M: {type: expression, formula: [[1, 2, 0], [0, t, 5]]}
  y: {type: constant, value: 0}
  z: {type: %s}
"""


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("mux, of: [u, a]", [1, 2, -3, 4]),
        ("mux, of: [-u, w]", [-1, -2, 3, 4, 2, -4]),
        ("demux, of: u, index: 1", [2]),
        ("dot, of: u, other: w", [1 * 4 + 2 * 2 + 3 * 4]),
        ("total, of: u", [0]),
        ("matrix_gain, of: u, matrix: M", [5, 2 * 2 - 15]),
        ("matrix_gain, of: u, matrix: [[1, 0, 0], ['a', 0, 't']]", [1, 4 - 6]),
        ("matrix_gain, of: a, matrix: M", [12, 28]),
        ("gain, of: u, k: 2", [2, 4, -6]),
        ("gain, of: u, k: [2, 3, 4]", [2, 6, -12]),
        ("gain, of: a, k: [2, 3]", [8, 12]),
        ("gain, of: 'u[2]', k: 1", [-3]),
        ("gain, of: '-M[1, 2]', k: 1", [-5]),
        ("gain, of: 'M[1]', k: 1", [0, 2, 5]),
        ("sum, of: [u, -w, a]", [1 - 4 + 4, 2 - 2 + 4, -3 + 4 + 4]),
        ("product, of: [u, w]", [4, 4, 12]),
        ("abs, of: u", [1, 2, 3]),
        ("saturation, of: u, low: -1, high: [0, 9, 9]", [0, 2, -1]),
        ("table, of: u, points: [[0, 0], [1, 2]]", [2, 2, 0]),
        ("expression, formula: 2*u - a", [-2, 0, -10]),
        ("expression, formula: '[1]'", None),
        ("expression, formula: ['u[0] + a', 't**2']", [5, 4]),
        ("expression, formula: 'dot(M, u) + 1'", [6, -10]),
        ("expression, formula: 'sqrt(dot(u, u))'", [14**0.5]),
        ("expression, formula: 'u if a >= 5 else w'", [4, 2, -4]),
        ("expression, formula: [u, w]", [1, 2, -3, 4, 2, -4]),
    ],
)
def test_blocks_work_on_vectors(block: str, expected: list[float] | None) -> None:
    if expected is None:
        with pytest.raises(DiagramError, match="a list is not part of the formula language"):
            made(ALL % block)
        return
    model = made(ALL % block)
    modes = [0.0] * len(model.modes)
    for _ in range(3):  # the modes of abs, saturation and table follow their guards
        where = Point(2.0, [], [*modes, *modes], [], TABLE)
        guards = values(model, "guards", where)
        modes = [
            float(np.searchsorted([0.0, 1.0], g, "right") if m.kind == "segment" else g >= 0)
            for m, g in zip(model.modes, guards, strict=True)
        ]
    where = Point(2.0, [], [*modes, *modes], [], TABLE)
    assert values(model, "outputs", where)[1:] == pytest.approx(expected)


def test_a_subsystem_takes_numbers_and_vectors() -> None:
    text = """
record: [one.y, three.y, three.part, "three.twice[1]", "three.inside[2]"]
blocks:
  u: {type: expression, formula: [1, 2, 3]}
  a: {type: constant, value: 5}
  one: {type: stage, u: a, v: u}
  three: {type: stage, u: u, v: u}
subsystems:
  stage:
    inputs: [u, v]
    outputs: {y: twice, part: "v[1]", minus: "-twice"}
    blocks:
      twice: {type: gain, of: inside, k: 2}
      inside: {type: gain, of: u, k: 1}
"""
    model = made(text)
    assert model.flat.shapes["three.y"] == (3,)
    assert "one.y" not in model.flat.shapes
    assert values(model, "outputs", Point(0, [], [], [], [])) == [10, 2, 4, 6, 2, 4, 3]


def test_events_set_vectors_and_elements() -> None:
    text = """
span: [0, 1]
blocks:
  q: {type: integrator, of: rate, start: [1, 2]}
  rate: {type: expression, formula: [1, 0]}
events:
  - {when: t - 0.5, crosses: up, set: {q: "[0, 1]"}}
"""
    assert "a list is not part" in _told(text)
    result = run(text.replace('"[0, 1]"', "-q"))
    assert result["q[0]"][-1] == pytest.approx(-1)
    assert result["q[1]"][-1] == -2
    result = run(text.replace('{q: "[0, 1]"}', '{"q[1]": "7 + q[0]"}'))
    assert result["q[0]"][-1] == pytest.approx(2)
    assert result["q[1]"][-1] == pytest.approx(8.5)


def test_signals_may_be_asked_for_when_the_model_is_made() -> None:
    assert made(CHAIN, ("v", "force[1]")).recorded[3:] == ("v[0]", "v[1]", "v[2]", "force[1]")
    with pytest.raises(OptionError, match=r"unknown signal 'force\[3\]'"):
        made(CHAIN, ("force[3]",))
    with pytest.raises(OptionError, match=r"unknown signal 'c\[0\]'"):
        made(CHAIN, ("c[0]",))


def test_a_loop_of_vectors_is_solved() -> None:
    """y = u - M y is (1 + M) y = u."""
    text = """
record: [y]
parameters: {k: 0.5}
blocks:
  u: {type: expression, formula: [1, 2, 3]}
  y: {type: sum, of: [u, -My]}
  My: {type: matrix_gain, of: y, matrix: [[k, 1, 0], [1, 3, k], [0, 1, 1]]}
"""
    matrix = np.array([[0.5, 1, 0], [1, 3, 0.5], [0, 1, 1]])
    expected = np.linalg.solve(np.eye(3) + matrix, [1, 2, 3])
    found = values(made(text), "outputs", Point(0, [], [], [0.5], []))
    assert found == pytest.approx(expected, rel=1e-14)


def test_guesses_of_a_vector() -> None:
    text = """
record: [y]
parameters: {k: 1}
blocks:
  y: {type: expression, formula: y + u*k - y*y, guess: [2, -2]}
  u: {type: expression, formula: [4, 9]}
"""
    found = values(made(text), "outputs", Point(0, [], [], [1.0], []))
    assert found == pytest.approx([2, -3], rel=1e-15)
    told = _told(text.replace("formula: [4, 9]", "formula: 4"))
    assert "'y' is a number, and its guess is a vector of 2" in told


# shapes


def shapes(**formulas: str | Expression) -> dict[str, tuple[int, ...]]:
    return find_shapes({n: (parse(f) if isinstance(f, str) else f,) for n, f in formulas.items()})


def stack(*parts: str) -> Expression:
    return Call("stack", tuple(map(parse, parts)))


def test_shapes_are_found_against_the_order_of_the_diagram() -> None:
    found = shapes(
        a="2*b", b="c + 1", c=stack("1", "2"), d="a[0]", e=stack("a", "b"), f="dot(e, a)"
    )
    assert found == {"a": (2,), "b": (2,), "c": (2,), "e": (2, 2), "f": (2,)}


def test_shapes_go_round_a_circle() -> None:
    assert shapes(a="b", b="a + c", c=stack("1", "2")) == {"a": (2,), "b": (2,), "c": (2,)}
    assert shapes(a=stack("b", "1"), b="a[0]") == {"a": (2,)}
    assert shapes(q=stack("a", "b"), a="q[1]", b="q[0]") == {"q": (2,)}
    assert shapes(q=Call("join", (Name("a"), Name("b"))), a="q[1]*c", b="t", c=stack("1", "2")) == {
        "c": (2,),
        "a": (2,),
        "q": (3,),
    }
    assert shapes(a="b", b="a") == {}


def test_a_state_has_the_shape_of_its_start_or_of_its_rate() -> None:
    two = stack("1", "2")
    assert find_shapes({"x": (Number(0.0), Name("v")), "v": (two, Number(1.0))}) == {
        "x": (2,),
        "v": (2,),
    }


# messages


def _told(text: str) -> str:
    with pytest.raises(DiagramError) as caught:
        made(text)
    return str(caught.value)


WRONG = """
blocks:
  u: {type: expression, formula: [1, 2, 3]}
  v: {type: mux, of: [a, a]}
  a: {type: constant, value: 4}
  M: {type: expression, formula: [[1, 2], [3, 4]]}
"""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("sum, of: [u, v]", "a vector of 3 and a vector of 2 do not go together in 'u + v'"),
        ("gain, of: u, k: [1, 2]", "a vector of 2 and a vector of 3 do not go together in"),
        ("gain, of: 'u[3]', k: 1", "'u' is a vector of 3, and has no element [3]"),
        ("gain, of: 'u[0, 1]', k: 1", "'u' is a vector of 3, and has no element [0, 1]"),
        ("gain, of: 'a[0]', k: 1", "'a' is a number, and has no element [0]"),
        ("dot, of: u, other: v", "a vector of 3 and a vector of 2 do not go together in 'dot("),
        ("matrix_gain, of: u, matrix: M", "a 2x2 matrix and a vector of 3 do not go together in"),
        ("mux, of: [a, M]", "numbers and vectors are put end to end, and not a 2x2 matrix"),
        ("expression, formula: [a, u]", "a list holds numbers, or vectors of one length, and not"),
        ("demux, of: u, index: 1.5", "the index in 'u[1.5]' is no whole number"),
        (
            "integrator, of: u, start: [1, 2]",
            "'z' is a vector of 2, and its rate is a vector of 3. Give both the same length.",
        ),
        ("gain, of: s.y, k: 1}\n  s: {type: part, u: u", "has no element [5]: they are counted"),
    ],
)
def test_shapes_that_do_not_go_together_are_refused(line: str, told: str) -> None:
    part = 'subsystems: {part: {inputs: [u], outputs: {y: "u[5]"}, blocks: {}}}\n'
    message = _told(f"{WRONG}  z: {{type: {line}}}\n{part}")
    assert told in message
    assert message.startswith("<text>:")
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("events: [{when: u, set: {x: 0}}]", "'u' is a vector of 3, and a number is needed"),
        ("events: [{when: a, set: {x: u}}]", "'x' is a number, and its new value is a vector of 3"),
        ("events: [{when: a, set: {'x[0]': 1}}]", "'x' is a number, and has no element [0]"),
        ("events: [{when: a, set: {y: 1, 'y[1]': 1}}]", "'y[1]' is set twice. Leave one out."),
        ("record: ['u[7]']", "'u' is a vector of 3, and has no element [7]"),
        ("record: ['a[0]']", "'a' is a number, and has no element [0]"),
    ],
)
def test_elements_that_do_not_exist_are_refused(more: str, told: str) -> None:
    states = "  x: {type: integrator, of: a}\n  y: {type: integrator, of: u}\n"
    message = _told(WRONG + states + more)
    assert told in message
    assert message.startswith("<text>:9:")


def test_everything_that_is_wrong_is_told_at_once() -> None:
    lines = "  x: {type: sum, of: [u, v]}\n  y: {type: gain, of: 'u[8]', k: 1}\n"
    assert len(_told(WRONG + lines).splitlines()) == 2


def test_a_block_with_memory_takes_numbers() -> None:
    text = f"{WRONG}  r: {{type: relay, of: u, on_at: 1, off_at: 0}}\n"
    assert "a number is needed" in _told(text)
