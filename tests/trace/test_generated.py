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
    found = trace(compile(read(make(case, tmp_path))))
    assert found.verdict == "effect"
    (effect,) = found.effects
    assert (effect.name, effect.place) == ("coulomb", place)
    assert effect.params["level"] == pytest.approx(level, rel=0.01)
