"""Probes: added test signals change nothing by themselves, and show what a force would do."""

from __future__ import annotations

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import Diagram, read_text
from tracewire.solve import simulate
from tracewire.trace.candidates.places import find_places
from tracewire.trace.screen.probes import add_probes

PENDULUM = """
span: [0, 1]
every: 0.1
blocks:
  theta: {type: integrator, of: omega, start: 1}
  omega: {type: integrator, of: torque}
  torque: {type: sum, of: [gravity, friction]}   # the place
  gravity: {type: expression, formula: "-20*sin(theta)"}
  friction: {type: coulomb, rate: omega, level: 0.5}
"""
TWO_MASSES = """
span: [0, 1]
every: 0.1
parameters: {k: 4, probe: 2}
blocks:
  x1: {type: integrator, of: v1, start: 1}
  v1: {type: integrator, of: force1}
  force1: {type: sum, of: [-pull, -x1]}
  x2: {type: integrator, of: v2}
  v2: {type: integrator, of: force2}
  force2:
    type: sum
    of:
      - pull   # one wire a line
  pull: {type: expression, formula: "k*(x1 - x2)*probe"}
"""
DRIVEN = """
span: [0, 1]
every: 0.1
inputs: {u: {default: 0}, probe_input_0: {default: 0}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  force: {type: sum, of: [-x, u, bent, inside.y]}
  bent: {type: expression, formula: "0.3*u**2"}
  inside: {type: half, u: u}
  hum: {type: sine, amplitude: 1, omega: 5}
  more: {type: gain, of: hum, k: 0.2}
  also: {type: sum, of: [force, more]}
  y: {type: integrator, of: also}
subsystems:
  half: {inputs: [u], outputs: {y: y}, blocks: {y: {type: gain, of: u, k: 0.5}}}
events:
  - {when: "hum - 2*u - 3", crosses: up, set: {v: hum}}
"""


@pytest.mark.parametrize("text", [PENDULUM, TWO_MASSES, DRIVEN])
def test_a_run_with_probes_is_the_run_without_them(text: str) -> None:
    diagram = read_text(text)
    places = find_places(compile(diagram))
    with_probes, names = add_probes(diagram, places, 3)
    assert len(names) == len(places)
    assert len(set().union(*names)) == 3 * sum(place.kind != "sensor" for place in places)
    before, after = simulate(compile(diagram)), simulate(compile(with_probes))
    for name, values in before.signals.items():
        np.testing.assert_allclose(after.signals[name], values, rtol=1e-9, atol=1e-12)


def test_new_names_do_not_clash_and_inputs_come_last() -> None:
    diagram = read_text(DRIVEN)
    with_probes, names = add_probes(diagram, find_places(compile(diagram)), 2)
    new = list(with_probes.inputs)[len(diagram.inputs) :]
    assert len(new) == 2
    old = {*diagram.inputs, *diagram.parameters, *diagram.blocks}
    assert old.isdisjoint([*new, *(name for group in names for name in group)])


def by_hand(text: str, addend: str) -> Diagram:
    """The diagram with `hat`, an input that is multiplied with `size`, put in by hand."""
    assert addend in text
    text = text.replace(addend, f"{addend}, push", 1)
    text = text.replace("blocks:", "blocks:\n  push: {type: product, of: [hat, amount]}", 1)
    text = text.replace("blocks:", "blocks:\n  amount: {type: gain, of: one, k: size}", 1)
    text = text.replace("blocks:", "blocks:\n  one: {type: constant, value: 1}", 1)
    return read_text(text + "\nparameters: {size: 0}\ninputs: {hat: {default: 0}}\n")


def test_the_sensitivity_to_a_probe_is_the_answer_to_its_signal() -> None:
    diagram = read_text(PENDULUM)
    model = compile(diagram)
    with_probes, ((first, second),) = add_probes(diagram, find_places(model), 2)
    new = list(with_probes.inputs)
    hats = {
        new[0]: ([0, 0.2, 0.4], [0, 1, 0]),
        new[1]: ([0.2, 0.4, 0.6], [0, 1, 0]),
    }
    run = simulate(compile(with_probes), inputs=hats, sensitivities=[first, second], rtol=1e-9)
    pushed = compile(by_hand(PENDULUM, "gravity, friction"))
    for name, hat in zip((first, second), hats.values(), strict=True):
        step = 1e-4
        up, down = (
            simulate(pushed, inputs={"hat": hat}, parameters={"size": size}, rtol=1e-12)
            for size in (step, -step)
        )
        answer = (up.signals["theta"] - down.signals["theta"]) / (2 * step)
        np.testing.assert_allclose(run.sensitivities[name]["theta"], answer, atol=1e-6)


def test_a_probe_at_a_drive_reaches_all_its_readers() -> None:
    diagram = read_text(DRIVEN)
    places = find_places(compile(diagram))
    with_probes, names = add_probes(diagram, places, 1)
    hat = list(with_probes.inputs)[-1]
    at = {place.name: group[0] for place, group in zip(places, names, strict=True) if group}
    model = compile(with_probes)
    t = [0, 10]
    ones = {hat: (t, [1, 1])}
    # u + 0.7 through the probe is what u + 0.7 would be as an input
    seen = simulate(model, parameters={at["drive.u"]: 0.7}, inputs=ones | {"u": (t, [0.1, 0.1])})
    real = simulate(compile(diagram), inputs={"u": (t, [0.8, 0.8])})
    for name in ("x", "v", "y"):
        np.testing.assert_allclose(seen.signals[name], real.signals[name], rtol=1e-6, atol=1e-9)
    shifted = DRIVEN.replace("omega: 5}", "omega: 5, offset: 0.7}")
    seen = simulate(model, parameters={at["drive.hum"]: 0.7}, inputs=ones)
    real = simulate(compile(read_text(shifted)))
    for name in ("x", "v", "y"):
        np.testing.assert_allclose(seen.signals[name], real.signals[name], rtol=1e-6, atol=1e-9)
