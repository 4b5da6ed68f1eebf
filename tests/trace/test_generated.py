"""Cases of the benchmark in which a law was named that only looks like the truth."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.trace import trace

from benchmarks.tracing.cases import chosen
from benchmarks.tracing.make import make


@pytest.mark.slow
def test_drag_beside_a_friction_that_falls_with_the_speed(tmp_path: Path) -> None:
    """The declared model takes that fall for zero, its bound. Cubic damping promised twice as much
    there as the drag, which was never refitted."""
    (case,) = chosen("single/quad_drag@double_torsion", draw=47)
    found = trace(compile(read(make(case, tmp_path))), options={"only": ["contact"]})
    assert [(e.name, e.place) for e in found.effects] == [("quad_drag", "contact")]
    assert found.effects[0].params["c"] == pytest.approx(0.004186, rel=0.01)
    assert found.values["T_02"] == pytest.approx(0.504, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "draw", "place", "level"),
    [
        # creeps near rest, as with a width; Stribeck friction that sticks was preferred to Coulomb
        # friction that does
        ("single/coulomb_smooth@driven", 47, "torque", 0.002636),
        # one window of a refit began in another minimum, where Coulomb friction left 92 times as
        # much and Stribeck friction nothing
        ("single/coulomb@double_torsion", 46, "column", 0.0008476),
    ],
)
def test_coulomb_friction_is_no_stribeck_friction(
    name: str, draw: int, place: str, level: float, tmp_path: Path
) -> None:
    (case,) = chosen(name, draw=draw)
    found = trace(compile(read(make(case, tmp_path))), options={"only": [place]})
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place) == ("coulomb", place)
    assert effect.params["level"] == pytest.approx(level, rel=0.01)
