"""Places: the sums that feed a rate, and the signals around them."""

from __future__ import annotations

from pathlib import Path

from tracewire.compile import compile
from tracewire.diagram import read, read_text
from tracewire.trace.places import Place, find_places

PENDULUM = Path(__file__).parents[2] / "diagrams/papers/a_torsion/pendulum.yaml"


def places(text: str) -> list[Place]:
    return find_places(compile(read_text(text)))


def test_a_sum_behind_gains_is_a_place_with_its_coordinate_and_rate() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: a}
          a: {type: gain, of: force, k: 2}
          force: {type: sum, of: [spring]}
          spring: {type: linear_stiffness, of: x, k: 1}
        """
    )
    assert found == [Place("force", "force", "v", "x")]


def test_a_sum_that_only_feeds_another_sum_is_left_out() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: total}
          total: {type: sum, of: [spring, losses]}
          losses: {type: sum, of: [-v]}
          spring: {type: linear_stiffness, of: x, k: 1}
        """
    )
    assert [place.name for place in found] == ["total"]


def test_a_sum_behind_a_function_is_no_place() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: bent}
          bent: {type: tanh, of: inner}
          inner: {type: sum, of: [-x]}
        """
    )
    assert found == []


def test_a_state_without_coordinate_has_none() -> None:
    found = places(
        """
        blocks:
          v: {type: integrator, of: a}
          a: {type: sum, of: [-v]}
        """
    )
    assert found == [Place("a", "a", "v", "")]


def test_the_diagram_can_say_which_sum_is_the_place() -> None:
    found = find_places(compile(read(PENDULUM)))
    assert found == [
        Place("column", "column", "phi1_dot", "phi1"),
        Place("contact", "contact", "phi2_dot", "phi2"),
    ]


def test_a_sum_of_vectors_is_no_place() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v, start: [1, 2]}
          v: {type: integrator, of: force}
          force: {type: sum, of: [spring, same], place: {q: x, v: v}}
          same: {type: sum, of: [spring]}
          spring: {type: linear_stiffness, of: x, k: 1}
        """
    )
    assert found == []


def test_a_sum_in_an_algebraic_loop_is_a_place() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: total}
          total: {type: sum, of: [spring, back, outer]}
          back: {type: gain, of: total, k: -0.5}
          spring: {type: linear_stiffness, of: x, k: 1}
          outer: {type: sum, of: [ring]}
          ring: {type: gain, of: outer, k: -2}
        """
    )
    assert {place.name for place in found} == {"total", "outer"}
