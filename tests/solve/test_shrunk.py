"""What random diagrams and parameters once broke, shrunk to what matters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT, when
from solve.models import run
from tracewire.errors import SimulationError
from tracewire.solve import Run


@pytest.mark.parametrize("method", METHODS)
def test_a_rate_that_is_zero_but_for_rounding_is_zero(method: str) -> None:
    """0.1*3 - 0.3 is 5.6e-17: at rest on the limit of its friction, until the push turns."""
    text = """
span: [0, 1]
blocks:
  v: {type: integrator, of: a}
  a: {type: expression, formula: 0.1*3 - 0.3*sign(v) - t}
"""
    result = run(text, method=method, **TIGHT)
    assert when(result)[-1:] == pytest.approx([0.6], abs=1e-9)
    assert result.statistics.steps < 200
    assert result["v"] == pytest.approx(-(np.maximum(result.t - 0.6, 0) ** 2) / 2, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("inner", ["v if v < 0.1 else 0.1", "max(v, -0.1)", "min(2*v, 0.3)"])
def test_a_guard_that_reads_another_mode_is_decided_at_the_start(inner: str, method: str) -> None:
    text = f"""
span: [0, 0.01]
blocks:
  v: {{type: integrator, of: a}}
  u: {{type: expression, formula: "{inner}"}}
  s: {{type: sign, of: u}}
  a: {{type: expression, formula: s - 2}}
"""
    result = run(text, ("s",), method=method, **TIGHT)
    assert result.events == ()
    assert set(result["s"]) == {-1.0}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("formula", "before", "after"),
    [
        ("floor(v*abs(v))", -1, 0),
        ("floor(-v*abs(v))", 0, -1),
        ("floor(v**3)", -1, 0),
        ("sign(v*abs(v))", -1, 1),
        ("sign(v**3)", -1, 1),
        ("sign(v**5)", -1, 1),
    ],
)
def test_a_guard_may_cross_with_a_flat_tangent(
    formula: str, before: float, after: float, method: str
) -> None:
    text = f"""
span: [0, 1.9]
blocks:
  v: {{type: integrator, of: one, start: -1}}
  one: {{type: constant, value: 1}}
  s: {{type: expression, formula: "{formula}"}}
  z: {{type: integrator, of: s}}
"""
    result = run(text, method=method, **TIGHT)
    assert result.final["z"] == pytest.approx(before + 0.9 * after, abs=1e-3)
    assert result.statistics.steps < 500
    if "5" not in formula:
        assert sorted(set(np.round(when(result), 9))) == [1.0]
        assert result.final["z"] == pytest.approx(before + 0.9 * after, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_floor_logs_each_of_its_crossings_once(method: str) -> None:
    """v = -0.5*exp(t), as it came: the one at 2.611 was found twice, 1e-14 s apart."""
    text = """
span: [0, 3]
blocks:
  v: {type: integrator, of: v, start: -0.5}
  s: {type: expression, formula: floor(2*sin(v))}
  z: {type: integrator, of: s}
"""
    result = run(text, rtol=1e-9, method=method)
    base = [n * math.pi / 6 for n in (1, 5, 6, 7, 11, 12)]  # 2 sin is whole there, and crosses
    angles = [angle + 2 * math.pi * k for angle in base for k in range(3)]
    times = sorted(math.log(2 * angle) for angle in angles if 0.5 < angle < math.exp(3) / 2)
    assert when(result) == pytest.approx(times, abs=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_a_floor_and_a_sign_of_one_signal_are_decided_together(method: str) -> None:
    """At v = 0 both sides fall with 0.5, and x = -t**2/4 leaves its whole number with them."""
    text = """
span: [0, 0.4]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  a: {type: expression, formula: floor(2*sin(v)) - 0.5*sign(v)}
  z: {type: integrator, of: s}
  s: {type: expression, formula: floor(2*sin(x))}
"""
    result = run(text, method=method, **TIGHT)
    assert result.events == ()
    assert result.final == pytest.approx({"x": -0.04, "v": -0.2, "z": -0.4}, abs=1e-9)


def test_friction_of_the_wrong_sign_does_not_creep() -> None:
    """It drives what it should hold: any honest end is right, but not thousands of steps."""
    text = """
span: [0, 2]
blocks:
  v0: {type: integrator, of: a}
  v1: {type: integrator, of: b}
  rate: {type: sum, of: [v0, -v1]}
  between: {type: dry_friction, rate: rate, slip: 0.3, stick: 1.033}
  ground: {type: coulomb, rate: v0, level: 0.46}
  a: {type: expression, formula: t + ground}
  b: {type: expression, formula: -0.86 + between}
"""
    try:
        result = run(text, **TIGHT)
    except SimulationError as error:
        told = str(error)
    else:
        told = ""
        assert result.statistics.steps < 1000
    assert "more than" not in told


@pytest.mark.parametrize("rtol", [1e-7, 1e-9, 1e-10])
@pytest.mark.parametrize("method", METHODS)
def test_a_flat_crossing_beside_a_held_mass_is_at_its_instant(method: str, rtol: float) -> None:
    """As above, with a friction elsewhere that holds, and changes no derivative of the floor."""
    text = """
span: [0, 1]
blocks:
  x: {type: integrator, of: v, start: 0.5}
  v: {type: integrator, of: a, start: 0.5}
  a: {type: expression, formula: 2*v - 1.9*x}
  w: {type: integrator, of: friction}
  friction: {type: dry_friction, rate: w, slip: 0.1, stick: 1}
  u: {type: quad_drag, rate: v, c: 1}
  s: {type: floor, of: u}
  z: {type: integrator, of: s}
"""
    result = run(text, method=method, rtol=rtol)
    turns = math.atan(math.sqrt(0.9) / 0.9) / math.sqrt(0.9)
    assert when(result) == pytest.approx([turns] * 2, abs=10 * rtol)
    assert np.ptp(when(result)) < 1e-12


@pytest.mark.parametrize("rtol", [1e-7, 1e-9, 1e-10])
@pytest.mark.parametrize("method", METHODS)
def test_what_reads_a_rate_that_leaves_zero_tangentially_changes_with_it(
    method: str, rtol: float
) -> None:
    """The breakaway is located on steps to rounding: as near to zero is the rate's derivative."""
    text = """
span: [0, 2]
blocks:
  v: {type: integrator, of: a}
  friction: {type: coulomb, rate: v, level: 1}
  a: {type: sum, of: [pull, friction]}
  pull: {type: integrator, of: z}
  z: {type: integrator, of: b}
  u: {type: asymmetric_viscous, rate: v, c_l: 1.0, c_r: 0.5}
  s: {type: sign, of: u}
  b: {type: sum, of: [z, s]}
"""
    result = run(text, method=method, rtol=rtol)
    leaves = 1.14619322062058  # exp(t) - t = 2
    assert when(result) == pytest.approx([leaves] * 2, abs=10 * rtol)
    assert np.ptp(when(result)) < 1e-12
    exact = (math.exp(leaves) - 2) * math.exp(2 - leaves) + 1
    assert result.final["z"] == pytest.approx(exact, abs=1000 * rtol)


REFUSED = "no consistent mode at t = 0.693147181 s for the guards 'v' in drag, 'drag' in s"


@pytest.mark.parametrize("method", METHODS)
def test_the_sign_of_a_drag_holds_where_the_rate_is_zero_or_is_refused(method: str) -> None:
    """v*abs(v) is zero with a flat tangent, and shares its surface with its own abs.

    A slide on it needs a gradient: it is found on the surface of v where rounding leaves that one
    alone there, and refused in words where both are zero together.
    """
    text = """
span: [0, 2]
blocks:
  v: {type: integrator, of: a, start: 1}
  drag: {type: quad_drag, rate: v, c: 1}
  s: {type: sign, of: drag}
  a: {type: sum, of: [s, -v]}
"""
    try:
        result = run(text, method=method, rtol=1e-9)
    except SimulationError as error:
        told = str(error)
    else:
        told = REFUSED
        assert result["v"] == pytest.approx(np.maximum(2 * np.exp(-result.t) - 1, 0), abs=1e-8)
        assert sorted(set(np.round(when(result), 8))) == [round(math.log(2), 8)]
    assert REFUSED in told


@pytest.mark.parametrize("method", METHODS)
def test_a_large_rate_that_friction_holds_takes_no_steps_of_its_rounding(method: str) -> None:
    """v was 1e12 and is held: its forces round to more than a tolerance of 1e-11."""

    def pushed(length: float, time: float) -> Run:
        text = f"""
span: [0, {5 * time}]
blocks:
  x: {{type: integrator, of: v, start: {-length}}}
  v: {{type: integrator, of: a, start: {-1.5 * length / time}}}
  z: {{type: integrator, of: leak, start: {length}}}
  leak: {{type: gain, of: z, k: {-0.6 / time}}}
  friction: {{type: dry_friction, rate: v, slip: 0.9, stick: 1.1}}
  a: {{type: expression, formula: "{length / time**2}*friction + {0.7 / time**2}*(z - x)"}}
"""
        return run(text, method=method, rtol=1e-8)

    large, plain = pushed(5e5, 3e-7), pushed(1.0, 1.0)
    assert large.statistics.steps < 2 * plain.statistics.steps
    assert large.final["x"] / 5e5 == pytest.approx(plain.final["x"], abs=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_states_in_far_units_do_not_lose_each_other_on_a_slide(method: str) -> None:
    """z decays, whatever the others do: beside numbers of 1e14 its row was rounded to theirs."""
    text = """
span: [0, 7]
blocks:
  z: {type: integrator, of: dz, start: -1.05e-9}
  dz: {type: expression, formula: -0.134*z}
  u: {type: integrator, of: du, start: -2.6e-5}
  du: {type: expression, formula: -0.34*u}
  w: {type: integrator, of: dw, start: -1140}
  dw: {type: expression, formula: -0.236*w - 1.08e8*u + 3.86e11*z + 4657*s}
  level: {type: expression, formula: -0.00437*u - 2.78e-11*w}
  s: {type: sign, of: level}
"""
    result = run(text, method=method, rtol=1e-8)
    assert [event.kind for event in result.events] == ["stick"]
    assert result["z"] == pytest.approx(-1.05e-9 * np.exp(-0.134 * result.t), rel=1e-7)
    assert result.statistics.rejected < 20


def test_two_frictions_on_one_rate_hold_together_where_none_does_alone() -> None:
    """The push of 2 is more than 0.9 or 1.5, and less than both; the rates differ by a factor."""
    found = run("""
        span: [0, 3]
        blocks:
          v: {type: integrator, of: a, start: 1}
          a: {type: expression, formula: f - 1.5*s - 2}
          f: {type: dry_friction, rate: v, slip: 0.9, stick: 0.9}
          i: {type: expression, formula: 1.014*v}
          s: {type: sign, of: i}
    """)
    assert found["v"][-1] == pytest.approx(0.0, abs=1e-9)


def test_five_surfaces_through_the_origin_hold_two_states_there() -> None:
    """None can be left: two of them hold, the others are zero with these."""
    found = run("""
        span: [0, 1]
        blocks:
          x: {type: integrator, of: xd}
          y: {type: integrator, of: yd}
          xd: {type: expression, formula: -sign(x + y) - sign(x - y) - sign(2*x - y)}
          yd: {type: expression, formula: -sign(y + 2*x) - 2*sign(x)}
    """)
    assert found.final == {"x": 0.0, "y": 0.0}


def test_a_friction_that_holds_goes_on_where_a_relay_slides() -> None:
    """As v comes to zero, the relay r alone asks for 1 of the friction, or for none; between them v
    stays at zero, and the friction holds w with 0.5 of 0.6. It slips at 0.4, from 1 on."""
    found = run("""
        span: [0, 2]
        record: [v, w, f]
        blocks:
          v: {type: integrator, of: vd, start: 1}
          w: {type: integrator, of: wd}
          vd: {type: expression, formula: -r + 0*f}
          wd: {type: expression, formula: f + 0.5 - 0.5*r}
          f: {type: dry_friction, rate: w, slip: 0.4, stick: 0.6}
          r: {type: sign, of: v}
    """)
    assert found["v"][-1] == pytest.approx(0.0, abs=1e-12)
    assert found["w"][-1] == pytest.approx(0.0, abs=1e-12)
    assert found["f"][-1] == pytest.approx(-0.5, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rate", ["0", "-0.01*z", "0.01*e", "0.01*e - 0.1*z"])
def test_a_guard_that_a_clock_carries_off_and_a_reset_carries_back_has_crossed(
    rate: str, method: str
) -> None:
    """The clock sets z above 2.1, the event that it sets off puts it below: i has risen again."""
    found = run(
        f"""
        span: [0, 1.5]
        blocks:
          z: {{type: integrator, of: a, start: -1.6}}
          a: {{type: expression, formula: "{rate}"}}
          e: {{type: sign, of: d}}
          d: {{type: gain, of: z, k: -1}}
          j: {{type: expression, formula: 1 - 3*e}}
          i: {{type: expression, formula: 2.1 - z}}
          c: {{type: counter, of: i, threshold: 0}}
        events:
          - {{every: 1, offset: 1, set: {{z: 2.4}}}}
          - {{when: j, crosses: up, set: {{z: -0.138*z}}}}
        """,
        method=method,
    )
    assert found.final["c"] == 1.0


@pytest.mark.parametrize("push", [0.0, 0.5, -0.5])
def test_relays_that_drive_one_signal_apart_hold_it_by_their_difference(push: float) -> None:
    """-3 sign(2x) + 2 sign(3x) is -sign(x): it holds a push below 1. Each relay has its part."""
    found = run(f"""
        span: [0, 2]
        record: [x, one, other]
        blocks:
          x: {{type: integrator, of: xd, start: 0.5}}
          twice: {{type: gain, of: x, k: 2}}
          one: {{type: sign, of: twice}}
          less: {{type: gain, of: x, k: -3}}
          other: {{type: sign, of: less}}
          xd: {{type: expression, formula: -3*one - 2*other + {push}}}
    """)
    assert found.final == {"x": 0.0}
    assert found["one"][-1] == pytest.approx(push)
    assert found["other"][-1] == pytest.approx(-push)


@pytest.mark.parametrize("push", [0.0, 0.5, -0.5])
def test_relays_that_drive_one_signal_apart_by_a_parameter_are_refused_at_zero(push: float) -> None:
    """The same, but that the two signals are multiples is known only in the run."""
    with pytest.raises(SimulationError, match=r"no consistent mode at t = \S+ s"):
        run(f"""
            span: [0, 2]
            parameters: {{k: 2}}
            blocks:
              x: {{type: integrator, of: xd, start: 0.5}}
              twice: {{type: gain, of: x, k: k}}
              one: {{type: sign, of: twice}}
              other: {{type: sign, of: x}}
              xd: {{type: expression, formula: -3*one + 2*other + {push}}}
        """)


def test_comparisons_of_multiples_of_a_signal_that_rests_at_zero_are_each_their_own() -> None:
    """> and >= differ there, and relays alone share a mode."""
    found = run(
        """
        span: [0, 1]
        blocks:
          x: {type: integrator, of: none}
          none: {type: constant, value: 0}
          a: {type: expression, formula: "1 if x > 0 else 0"}
          b: {type: expression, formula: "1 if 2*x >= 0 else 0"}
          c: {type: expression, formula: "1 if -3*x > 0 else 0"}
          d: {type: expression, formula: "1 if 5*x > 0 else 0"}
        """,
        ("a", "b", "c", "d"),
    )
    assert [found[name][-1] for name in "abcd"] == [0.0, 1.0, 0.0, 0.0]


@pytest.mark.parametrize("method", METHODS)
def test_a_relay_slides_that_moves_what_it_reads_through_a_friction_alone(method: str) -> None:
    """A clutch that sticks hands the relay's force on: the relay takes what keeps both at rest, and
    has no part in 0, where it was once left and met again, 1e-7 of the span later."""
    text = """
span: [0, 10]
blocks:
  w1: {type: integrator, of: clutch, start: 0.1}
  w2: {type: integrator, of: pull, start: 0.1}
  clutch: {type: dry_friction, rate: slip, slip: 5, stick: 5}
  slip: {type: expression, formula: w1 - w2}
  pull: {type: expression, formula: cos(t) - clutch - 3*relay}
  relay: {type: sign, of: w1}
"""
    result = run(text, ("w1", "relay"), method=method, **TIGHT)
    rests = when(result)[-1]
    assert [event.kind for event in result.events] == ["stick"]
    after = result.t > rests
    assert np.all(result["w1"][after] == 0.0)
    assert result["relay"][after] == pytest.approx(np.cos(result.t[after]) / 3, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_relay_slides_that_moves_what_it_reads_through_a_contact_alone(method: str) -> None:
    """Two bodies are pressed together; the relay reads the rate of one and drives the other."""
    text = """
span: [0, 10]
blocks:
  x1: {type: integrator, of: v1}
  v1: {type: integrator, of: press, start: 0.2}
  x2: {type: integrator, of: v2}
  v2: {type: integrator, of: pull, start: 0.2}
  press: {type: constant, value: 1}
  pull: {type: expression, formula: 0.5*cos(t) - 1 - 3*relay}
  gap: {type: expression, formula: x2 - x1}
  relay: {type: sign, of: v1}
events:
  - {when: gap, crosses: down, set: {v1: 0.25*v1 + 0.75*v2, v2: 0.75*v1 + 0.25*v2}}
"""
    result = run(text, ("v1", "gap", "relay"), method=method, **TIGHT)
    assert [event.kind for event in result.events] == ["stick"]
    after = result.t > when(result)[0]
    assert np.all(result["v1"][after] == 0.0)
    assert result["gap"] == pytest.approx(np.zeros(len(result.t)), abs=1e-12)
    assert result["relay"][after] == pytest.approx(np.cos(result.t[after]) / 6, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_relay_slides_that_moves_what_it_reads_through_two_contacts(method: str) -> None:
    """The body in the middle hands the force on."""
    bodies = "".join(
        f"""
  x{n}: {{type: integrator, of: v{n}}}
  v{n}: {{type: integrator, of: force{n}, start: 0.2}}"""
        for n in (1, 2, 3)
    )
    hits = "".join(
        f"""
  - {{when: x{n + 1} - x{n}, crosses: down,
      set: {{v{n}: 0.25*v{n} + 0.75*v{n + 1}, v{n + 1}: 0.75*v{n} + 0.25*v{n + 1}}}}}"""
        for n in (1, 2)
    )
    text = f"""
span: [0, 10]
blocks:{bodies}
  force1: {{type: constant, value: 1}}
  force2: {{type: constant, value: 0}}
  force3: {{type: expression, formula: 0.5*cos(t) - 1 - 3*relay}}
  relay: {{type: sign, of: v1}}
events:{hits}
"""
    result = run(text, ("v1", "relay"), method=method, **TIGHT)
    assert [event.kind for event in result.events] == ["stick"]
    after = result.t > when(result)[0]
    assert np.all(result["v1"][after] == 0.0)
    assert result["relay"][after] == pytest.approx(np.cos(result.t[after]) / 6, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_play_is_let_go_at_the_turn_of_a_rate_that_a_slide_holds(method: str) -> None:
    """What put the rate back onto the surface of the slide moved it off the turn that was located
    there: by 1e-13 of the span it went the old way, and pushed what it had just let go."""
    text = """
span: [0, 30]
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: a}
  off: {type: expression, formula: v - cos(t)}
  relay: {type: sign, of: off}
  a: {type: expression, formula: -3*relay - 0.5*follower - 2*x}
  follower: {type: play_operator, of: x, rate: v, width: 0.2}
"""
    for rtol in 1e-5 * 0.5 ** np.arange(16):
        result = run(text, ("x", "follower"), method=method, rtol=float(rtol))
        middle = result["x"].max() / 2 + result["x"].min() / 2
        late = result.t > 2 * math.pi
        assert np.ptp(result["x"][late] - np.sin(result.t[late])) < 1e-4
        ends = np.array([result["follower"][late].max(), result["follower"][late].min()])
        assert ends - middle == pytest.approx([0.9, -0.9], abs=1e-3)
