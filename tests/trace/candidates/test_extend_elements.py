"""Effects that read an element of a vector are written so that YAML reads them."""

from __future__ import annotations

from pathlib import Path

from oracles.written import with_effects
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import SignalScale, SignalScales
from tracewire.trace.options import TraceOptions

CRANE = """\
span: [0, 2]
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: "acceleration[0]", unit: m/s}
  q: {type: integrator, of: w, unit: rad}
  w: {type: integrator, of: "acceleration[1]", unit: rad/s}
  pull: {type: expression, formula: -x, unit: N}
  weight: {type: expression, formula: -sin(q), unit: N m}
  cart: {type: sum, of: [pull], unit: N, place: {q: x, v: v}}
  rod: {type: sum, of: [weight], unit: N m, place: {q: q, v: w}}
  acceleration: {type: solve, matrix: [[2, cos(q)], [cos(q), 2]], right: [cart, rod]}
"""
SIGNALS = ("x", "v", "q", "w", "cart", "rod", "acceleration[0]", "acceleration[1]")


def test_an_inertia_beside_a_solved_acceleration_can_be_added() -> None:
    model = compile(read_text(CRANE, Path("crane.yaml")))
    levels = SignalScales(
        {name: SignalScale(1.0, 2.0, 4.0, 0.1, 0.01) for name in SIGNALS}, 2.0, 0.01
    )
    known = find_candidates(model, find_places(model), levels, TraceOptions().candidate)
    (inertia,) = [c for c in known if str(c) == "inertia @ rod"]
    assert "acceleration[1]" in inertia.signals.values()
    diagram = with_effects(model.diagram, [(inertia, {inertia.parameter: 0.5})])
    assert 'of: "acceleration[1]"' in diagram.text
    assert compile(diagram).flat.states
