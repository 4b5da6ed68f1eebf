"""Places: the sums that feed a rate, and the signals around them."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest
from oracles.written import with_effects
from tracewire.compile import compile
from tracewire.diagram import read, read_text
from tracewire.solve import simulate
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import Place, describe_no_sum, find_places
from tracewire.trace.candidates.signal_scales import SignalScale, SignalScales
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.probes import add_probes

OPTIONS = TraceOptions()

PENDULUM = Path(__file__).parents[3] / "diagrams/papers/a_torsion/pendulum.yaml"
LEVELS = SignalScales({"u": SignalScale(1.0, 2.0), "x": SignalScale(2.0, 4.0)}, 10.0, 0.01)


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
          spring: {type: stiffness, of: x, k: 1}
        """
    )
    assert found == [Place("force", "sum", "force", "x", "v", "a")]


@pytest.mark.parametrize(
    ("body", "x", "v"),
    [
        ("mass, force: net, mass: 2", "x", "v"),
        ("rotating_mass, torque: net, inertia: 2", "angle", "rate"),
        ("gear, torque2: net, ratio: 3, inertia1: 1, inertia2: 2", "angle2", "rate2"),
    ],
)
def test_a_sum_before_a_body_is_a_place(body: str, x: str, v: str) -> None:
    (found,) = places(
        f"""
        blocks:
          body: {{type: {body}}}
          spring: {{type: stiffness, of: body.{x}, k: 1}}
          net: {{type: sum, of: [spring]}}
        """
    )
    assert (found.name, found.q, found.v) == ("net", f"body.{x}", f"body.{v}")


ROTOR = """
blocks:
  phi: {type: integrator, of: omega}
  omega: {type: integrator, of: alpha}
  alpha: {type: expression, formula: FORMULA}
  drag: {type: gain, of: omega, k: -1}
  net: {type: sum, of: [drag]}
  other: {type: sum, of: [phi]}
parameters: {J: 2, k: 3}
"""


@pytest.mark.parametrize("formula", ["net/J", "-k*net/(J + phi**2)", "net/other", "k*(-net)"])
def test_a_sum_to_which_an_expression_is_proportional_is_a_place(formula: str) -> None:
    assert places(ROTOR.replace("FORMULA", formula)) == [
        Place("net", "sum", "net", "phi", "omega", "alpha")
    ]


@pytest.mark.parametrize("formula", ["tanh(net)", "net*other", "net**2", "k/net", "net + 1"])
def test_where_no_sum_is_a_place_that_is_said(formula: str) -> None:
    model = compile(read_text(ROTOR.replace("FORMULA", formula)))
    found = find_places(model)
    assert found == []
    (said,) = describe_no_sum(model, found)
    assert said.startswith("nothing is tried at sums: from net, other to a rate")
    assert said.endswith("say so in it, as in `place: {q: SIGNAL, v: SIGNAL}`")


def test_a_sum_that_only_feeds_another_sum_is_left_out() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: total}
          total: {type: sum, of: [spring, losses]}
          losses: {type: sum, of: [-v]}
          spring: {type: stiffness, of: x, k: 1}
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
    assert found == [Place("a", "sum", "a", "", "v", "a")]


def test_the_diagram_can_say_which_sum_is_the_place() -> None:
    column, contact, *others = find_places(compile(read(PENDULUM)))
    bodies = ("phi1", "phi1_dot"), ("phi2", "phi2_dot")
    drives = ("f_e",)
    one, two = bodies
    assert column == Place("column", "sum", "column", *one, "phi1_ddot", (two,), drives)
    assert contact == Place("contact", "sum", "contact", *two, "phi2_ddot", (one,), drives)
    assert [(place.name, place.kind) for place in others] == [
        ("drive.f_e", "drive"),
        ("sensor.phi2", "sensor"),
    ]


@pytest.mark.parametrize("given", ["", ", place: {q: x, v: v}"])
def test_each_element_of_a_sum_of_vectors_is_a_place(given: str) -> None:
    found = places(
        f"""
        blocks:
          x: {{type: integrator, of: v, start: [1, 2]}}
          v: {{type: integrator, of: force}}
          force: {{type: sum, of: [spring, same]{given}}}
          same: {{type: sum, of: [spring]}}
          spring: {{type: stiffness, of: x, k: 1}}
        """
    )
    one, two = ("x[0]", "v[0]"), ("x[1]", "v[1]")
    assert found == [
        Place("force[0]", "sum", "force", *one, "force[0]", (two,), element=(0, 2)),
        Place("force[1]", "sum", "force", *two, "force[1]", (one,), element=(1, 2)),
    ]


ROWS = """
parameters: {k: 3}
blocks:
  x: {type: integrator, of: v, start: [1, 0]}
  v: {type: integrator, of: a}
  a: {type: gain, of: force, k: [2, 4]}
  force: {type: sum, of: [spring]}
  spring: {type: gain, of: x, k: -k}
"""


def test_an_effect_at_an_element_is_written_with_a_gain_that_makes_a_vector_of_it() -> None:
    diagram = read_text(ROWS)
    model = compile(diagram, backend="quick")
    found = find_places(model)
    known = {
        (c.effect, c.place.name): c
        for c in find_candidates(model, found, LEVELS, OPTIONS.candidate)
    }
    viscous = known["viscous", "force[1]"]
    assert viscous.coefficient == "viscous_force_1.c"
    new = with_effects(diagram, [(viscous, {"c": 0.25})])
    assert "of: [spring, viscous_force_1_alone]" in new.text
    lines = new.text.splitlines()
    at = next(n for n, line in enumerate(lines) if "viscous_force_1:" in line)
    assert lines[at].startswith('  viscous_force_1: {type: viscous, rate: "v[1]", c: {value: 0.25,')
    assert lines[at + 1] == (
        "  viscous_force_1_alone: {type: gain, of: viscous_force_1, k: [0, 1]}"
    )
    run = simulate(compile(new, record=["x"]), span=(0, 1), start={"x[1]": 1.0, "x[0]": 1.0})
    # x0'' = -6 x0, and x1'' = -12 x1 - x1'
    assert run["x[0]"][-1] == pytest.approx(np.cos(np.sqrt(6.0)), abs=1e-5)
    w = np.sqrt(12.0 - 0.25)
    damped = np.exp(-0.5) * (np.cos(w) + 0.5 / w * np.sin(w))
    assert run["x[1]"][-1] == pytest.approx(damped, abs=1e-5)
    probe, names = add_probes(diagram, found, 1)
    push = {"probe_input_0": ([0, 1], [1, 1])}
    run = simulate(compile(probe), span=(0, 1), parameters={names[1][0]: 1.0}, inputs=push)
    assert run["x[0]"][-1] == pytest.approx(np.cos(np.sqrt(6.0)), abs=1e-5)
    assert run["x[1]"][-1] == pytest.approx((1 - np.cos(np.sqrt(12.0))) / 3, abs=1e-5)


def test_a_sum_in_an_algebraic_loop_is_a_place() -> None:
    found = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: total}
          total: {type: sum, of: [spring, back, outer]}
          back: {type: gain, of: total, k: -0.5}
          spring: {type: stiffness, of: x, k: 1}
          outer: {type: sum, of: [ring]}
          ring: {type: gain, of: outer, k: -2}
        """
    )
    assert {place.name for place in found} == {"total", "outer"}


DRIVEN = """
inputs: {u: {default: 0}, unused: {default: 0}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  force: {type: sum, of: [u, motor, hum, level, clock, wired, ripple]}
  motor: {type: sine, amplitude: 2, omega: 3}
  hum: {type: expression, formula: "0.1*sin(50*t)"}
  idle: {type: square, amplitude: 1, frequency: 2}
  level: {type: constant, value: 1}
  clock: {type: time}
  ripple: {type: harmonic, amplitude: 1, period: 0.1}
  wired: {type: expression, formula: "u*t"}
measured:
  run:
    file: run.csv
    use: train
    time: t
    signals: {x: {column: x}, v: {column: v}}
    inputs: {u: {column: u}}
"""


def test_drives_are_inputs_and_sources_that_something_reads(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("t,x,v,u\n0,0,0,0\n1,0,0,0\n")
    found = find_places(compile(read_text(DRIVEN, tmp_path / "driven.yaml")))
    assert [place.name for place in found] == [
        "force",
        "drive.u",
        "drive.motor",
        "drive.hum",
        "sensor.x",
        "sensor.v",
    ]
    assert found[0].drive == ("u", "motor", "hum")
    assert found[1].drive == ("u",)


def test_a_sum_of_a_drive_and_an_effect_at_it_is_the_drive() -> None:
    found = places(
        """
        inputs: {u: {default: 0}}
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: force}
          force: {type: sum, of: [u_seen, -x]}
          u_seen: {type: sum, of: [u, more]}
          more: {type: drive_gain, of: u, gain: 0.1}
          also: {type: gain, of: u_seen, k: 2}
        """
    )
    assert [place.name for place in found] == ["force", "drive.u"]


def test_a_signal_inside_a_subsystem_counts_where_a_port_carries_it() -> None:
    found = places(
        """
        blocks:
          force: {type: sum, of: [-body.position]}
          body: {type: cart, force: force}
          hidden: {type: sum, of: [-body.position]}
          other: {type: closed, force: hidden}
        subsystems:
          cart:
            inputs: [force]
            outputs: {position: x, speed: v}
            blocks: {x: {type: integrator, of: v}, v: {type: integrator, of: force}}
          closed:
            inputs: [force]
            outputs: {y: doubled}
            blocks:
              x: {type: integrator, of: v}
              v: {type: integrator, of: force}
              doubled: {type: gain, of: x, k: 2}
        """
    )
    assert found == [
        Place("force", "sum", "force", "body.position", "body.speed", "force"),
        Place("hidden", "sum", "hidden", "", "", "hidden", (("body.position", "body.speed"),)),
    ]


CART = """
        inputs: {u: {default: 0}, w: {default: 0}}
        blocks:
          body: {type: cart, u: u, w: -w}
        subsystems:
          cart:
            inputs: [u, w]
            outputs: {x: x}
            blocks:
              x: {type: integrator, of: v}
              v: {type: integrator, of: a}
              a: {type: gain, of: force, k: 2}
              force: {type: sum, of: [-x, u, w]}
"""


def test_a_sum_inside_the_only_subsystem_of_its_type_is_a_place() -> None:
    (place, *drives) = places(CART)
    # the drive w comes in with a minus: no block inside can read the drive itself
    assert place == Place(
        "body.force", "sum", "cart.force", "body.x", "body.v", "body.a", (), ("u",), "body"
    )
    assert [drive.name for drive in drives] == ["drive.u", "drive.w"]


DEEPER = """
          body: {type: cage, u: u}
        subsystems:
          cage:
            inputs: [u]
            outputs: {x: c.x}
            blocks: {c: {type: cart, u: u, w: u}}"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("w: -w}", "w: -w}\n          twin: {type: cart, u: u, w: w}"),
        ("w: -w}", "w: -w, replicate: 1}"),
    ],
    ids=["two uses", "a row"],
)
def test_what_an_effect_would_change_elsewhere_is_no_place(old: str, new: str) -> None:
    assert old in CART
    assert not [place for place in places(CART.replace(old, new)) if place.kind == "sum"]


SHALLOW = "\n          body: {type: cart, u: u, w: -w}\n        subsystems:"


def test_a_sum_two_levels_deep_is_a_place() -> None:
    text = CART.replace(SHALLOW, DEEPER)
    diagram = read_text(dedent(text))
    model = compile(diagram, backend="quick")
    place = find_places(model)[0]
    # u goes through both ports; in the innermost diagram it has two names, of which one is taken
    assert place == Place(
        *("body.c.force", "sum", "cart.force", "body.c.x", "body.c.v", "body.c.a"),
        *((), ("u",), "body.c"),
    )
    found = find_candidates(model, [place], LEVELS, OPTIONS.candidate)
    known = {candidate.effect: candidate for candidate in found}
    assert known["viscous"].coefficient == "body.c.viscous.c"
    new = with_effects(diagram, [(known["viscous"], {"c": 0.25})])
    assert "      viscous: {type: viscous, rate: v, c: {value: 0.25, fit:" in new.text
    assert "body.c.viscous.c" in compile(new, backend="quick").flat.parameters
    probe, ((name,),) = add_probes(diagram, [place], 1)
    push = {"probe_input_0": ([0, 1], [1, 1])}
    run = simulate(compile(probe), span=(0, 1), parameters={name: 1.0}, inputs=push)
    # x'' = 2 (-x + 1), from rest
    assert run["body.c.x"][-1] == pytest.approx(1.0 - np.cos(np.sqrt(2.0)), abs=1e-6)


def test_two_definitions_of_one_name_are_no_places() -> None:
    text = CART.replace(SHALLOW, DEEPER).replace(
        "blocks: {c: {type: cart, u: u, w: u}}",
        """blocks: {c: {type: cart, u: u}}
            subsystems:
              cart:
                inputs: [u]
                outputs: [x]
                blocks: {x: {type: integrator, of: f}, f: {type: sum, of: [u, -x]}}""",
    )
    assert not [place for place in places(text) if place.kind == "sum"]


def test_an_effect_inside_a_subsystem_is_wired_to_the_names_there() -> None:
    diagram = read_text(dedent(CART))
    model = compile(diagram, backend="quick")
    place = find_places(model)[0]
    found = find_candidates(model, [place], LEVELS, OPTIONS.candidate)
    known = {candidate.effect: candidate for candidate in found}
    viscous = known["viscous"]
    assert (viscous.block, viscous.coefficient) == ("body.viscous", "body.viscous.c")
    assert viscous.parameter == "c"
    new = with_effects(diagram, [(viscous, {"c": 0.25})])
    assert "viscous: {type: viscous, rate: v, c: {value: 0.25, fit:" in new.text
    assert "of: [-x, u, w, viscous]" in new.text
    assert "body.viscous.c" in compile(new, backend="quick").flat.parameters


def test_a_place_that_names_a_coordinate_alone_is_kept() -> None:
    text = """
        inputs: {u: {default: 0}}
        blocks:
          x: {type: sum, of: [pull], place: {q: u}}
          pull: {type: gain, of: u, k: 2}
        """
    model = compile(read_text(text))
    (place, _) = find_places(model)
    assert place == Place("x", "sum", "x", "u", "", "", (), ("u",))
    known = {c.effect: c for c in find_candidates(model, [place], LEVELS, OPTIONS.candidate)}
    assert {"cubic_stiffness", "backlash", "cogging", "play_q", "stop_q", "bias"} <= known.keys()
    assert not known.keys() & {"coulomb", "viscous", "play", "hysteresis"}
    assert known["play_q"].signals == {"of": "u"}


def test_the_diagram_says_the_coordinate_of_a_sum_and_that_one_only() -> None:
    (place,) = places(
        """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: force}
          force: {type: sum, of: [-x], place: {q: x}}
        """
    )
    assert (place.q, place.v) == ("x", "")


def test_a_level_overflows_where_there_is_no_coordinate() -> None:
    text = "blocks: {h: {type: integrator, of: flow}, flow: {type: sum, of: [-h]}}"
    model = compile(read_text(text))
    levels = SignalScales({"h": SignalScale(1.0, 2.0), "flow": SignalScale(1.0, 1.0)}, 10.0, 0.01)
    known = {
        c.effect: c for c in find_candidates(model, find_places(model), levels, OPTIONS.candidate)
    }
    assert known["overflow"].signals == {"of": "h"}
    assert known["overflow"].limits["edge"] == pytest.approx((0.4, 2.0))
