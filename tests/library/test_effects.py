"""The shipped effects: their formulas, what they may be tried with, and that they can be."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library.values import library, output
from tracewire.formula import has_delay
from tracewire.library import SENSOR_TERMS, Block

POSITIVE_ONLY = (
    "viscous coulomb quad_drag cubic_damping stribeck disp_friction position_friction backlash"
    " barrier barrier_hi barrier_lo hunt_crossley hysteresis dahl lugre bouc_wen drive_lag"
    " drive_delay drive_saturation drive_dead_zone drive_quantiser load_friction elastic_load"
    " viscous_load overflow"
)
OF_EITHER_SIGN = (
    "bias asym_coulomb asym_viscous stiffness cubic_stiffness quad_stiffness asym_stiffness"
    " harmonic parametric cogging stiffness_drift viscous_drift friction_drift coupling_q"
    " coupling_v drive_gain drive_2nd_harm drive_3rd_harm inertia play play_q stop_q"
)
EFFECTS = library().effects()
EACH = pytest.mark.parametrize("block", EFFECTS.values(), ids=EFFECTS)
FREE = tuple(
    name
    for name, block in EFFECTS.items()
    if not block.states and not any(map(has_delay, block.formulas.values()))
)
Q, V = st.floats(-3, 3), st.floats(-9, 9)


def sign(u: float) -> float:
    return float((u > 0) - (u < 0))


def clip(u: float, s: float) -> float:
    return max(-s, min(u, s))


# what each is per unit coefficient: the formula, and values for its shapes
FORMULAS: dict[str, tuple[Callable[..., float], dict[str, float]]] = {
    "bias": (lambda **_: 1.0, {}),
    "coulomb": (lambda v, **_: -sign(v), {}),
    "viscous": (lambda v, **_: -v, {}),
    "quad_drag": (lambda v, **_: -v * abs(v), {}),
    "cubic_damping": (lambda v, **_: -(v**3), {}),
    "asym_coulomb": (lambda v, **_: -(math.tanh(v / 0.3) ** 2), {"width": 0.3}),
    "asym_viscous": (lambda v, **_: -abs(v), {}),
    "stribeck": (lambda v, **_: -math.exp(-((v / 0.7) ** 2)) * sign(v), {"speed": 0.7}),
    "disp_friction": (lambda q, v, **_: -abs(q) * sign(v), {}),
    "position_friction": (
        lambda q, v, **_: -(math.cos((3 * q + 0.4) / 2) ** 2) * sign(v),
        {"pitch": 2 * math.pi / 3, "phase": 0.4},
    ),
    "stiffness": (lambda q, **_: -q, {}),
    "cubic_stiffness": (lambda q, **_: -(q**3), {}),
    "quad_stiffness": (lambda q, **_: -(q**2), {}),
    "asym_stiffness": (lambda q, **_: -abs(q), {}),
    "backlash": (lambda q, **_: clip(q, 0.4), {"gap": 0.4}),
    "barrier": (lambda q, **_: -(q - clip(q, 0.4)), {"gap": 0.4}),
    "barrier_hi": (lambda q, **_: -max(0, q - 0.4), {"gap": 0.4}),
    "barrier_lo": (lambda q, **_: -min(0, q + 0.4), {"gap": 0.4}),
    "hunt_crossley": (
        lambda q, v, **_: -(max(0, q - 0.4) ** 1.5) * max(0, 1 + v / 2),
        {"wall": 0.4, "speed": 2.0},
    ),
    "harmonic": (
        lambda t, **_: math.sin(2 * math.pi * 0.8 * t + 0.3),
        {"period": 1.25, "phase": 0.3},
    ),
    "parametric": (
        lambda q, t, **_: -math.sin(2 * math.pi * 0.8 * t + 0.3) * q,
        {"period": 1.25, "phase": 0.3},
    ),
    "cogging": (
        lambda q, **_: math.sin(12 * q + 0.3),
        {"pitch": 2 * math.pi / 12, "phase": 0.3},
    ),
    "stiffness_drift": (lambda q, t, **_: -q * t, {}),
    "viscous_drift": (lambda v, t, **_: -v * t, {}),
    "friction_drift": (lambda v, t, **_: -sign(v) * t, {}),
    "coupling_q": (lambda other_q, **_: -other_q, {}),
    "coupling_v": (lambda other_v, **_: -other_v, {}),
    "drive_gain": (lambda u, **_: u, {}),
    "drive_2nd_harm": (
        lambda t, **_: 1.7 * math.sin(2 * (2 * math.pi * 0.8 * t + 0.3) + 0.5),
        {"size": 1.7, "period": 1.25, "start": 0.3, "phase": 0.5},
    ),
    "drive_3rd_harm": (
        lambda t, **_: 1.7 * math.sin(3 * (2 * math.pi * 0.8 * t + 0.3) + 0.5),
        {"size": 1.7, "period": 1.25, "start": 0.3, "phase": 0.5},
    ),
    "inertia": (lambda a, **_: -a, {}),
    "load_friction": (lambda u, v, **_: -abs(u) * sign(v), {}),
    "overflow": (lambda v, **_: -max(0, v - 0.4), {"edge": 0.4}),
    "drive_saturation": (lambda u, **_: clip(u, 0.7) - u, {"limit": 0.7}),
    "drive_dead_zone": (lambda u, **_: -clip(u, 0.2), {"zone": 0.2}),
    "drive_quantiser": (lambda u, **_: 0.3 * math.floor(u / 0.3 + 0.5) - u, {"step": 0.3}),
}
SENSOR = {f"sensor_{name}" for name in SENSOR_TERMS}


def force(block: Block, coefficient: float, shapes: dict[str, float], **signals: float) -> float:
    assert block.effect is not None
    wires = {port: signals[symbol] for port, symbol in block.effect.inputs.items()}
    given = {block.effect.coefficient: coefficient} | shapes
    return output(block.name, t=signals["t"], **wires, **given)


def test_every_effect_has_its_physical_sign() -> None:
    signs = {name: block.effect.sign for name, block in EFFECTS.items() if block.effect}
    assert signs == dict.fromkeys(POSITIVE_ONLY.split(), 1) | dict.fromkeys(
        OF_EITHER_SIGN.split(), 0
    )


def test_effects_without_a_memory_are_all_compared_with_a_formula() -> None:
    assert set(FREE) == FORMULAS.keys()


@pytest.mark.parametrize("name", FREE)
@given(q=Q, v=V, c=st.floats(-4, 4), t=st.floats(0, 20))
def test_an_effect_is_its_coefficient_times_its_formula(
    name: str, q: float, v: float, c: float, t: float
) -> None:
    formula, shapes = FORMULAS[name]
    signals = {"q": q, "v": v, "a": 2 - q, "u": v / 3, "other_q": -q, "other_v": 1 - v, "t": t}
    found = force(EFFECTS[name], c, shapes, **signals)
    assert found == pytest.approx(c * formula(**signals), rel=1e-9, abs=1e-9)
    assert force(EFFECTS[name], 0.0, shapes, **signals) == 0


SMOOTHED = [name for name in FREE if "width" in EFFECTS[name].effect.shapes]  # type: ignore[union-attr]


def test_coulomb_like_effects_have_a_width() -> None:
    expected = "coulomb asym_coulomb stribeck disp_friction position_friction friction_drift "
    expected += "load_friction"
    assert set(SMOOTHED) == set(expected.split())


@pytest.mark.parametrize("name", [name for name in SMOOTHED if name != "asym_coulomb"])
@given(q=Q, v=V, width=st.floats(1e-3, 5))
def test_a_width_makes_the_sign_of_the_rate_a_tanh(
    name: str, q: float, v: float, width: float
) -> None:
    shapes, signals = FORMULAS[name][1], {"q": q, "t": 3.0, "u": 1 - q}
    sharp = force(EFFECTS[name], 1.0, shapes, v=math.copysign(v, 1) or 1e-300, **signals)
    found = force(EFFECTS[name], 1.0, shapes | {"width": width}, v=v, **signals)
    assert found == pytest.approx(sharp * math.tanh(v / width), rel=1e-9, abs=1e-12)


def test_asymmetric_coulomb_without_a_width_is_a_bias() -> None:
    """Beside a set-valued coulomb the two are one law: levels of 2 + 0.5 and 2 - 0.5."""
    block = library()["asym_coulomb"]
    for v in (-1.0, 0.0, 1.0):
        assert output(block.name, rate=v, level=0.5) == -0.5
        both = output("coulomb", rate=v, level=2) + output(block.name, rate=v, level=0.5)
        assert both == (-2.5 if v > 0 else 1.5 if v < 0 else -0.5)


FRICTION = "coulomb viscous quad_drag cubic_damping stribeck disp_friction position_friction"
FRICTION += " load_friction"


@pytest.mark.parametrize("name", FRICTION.split())
@given(q=Q, v=V)
def test_friction_takes_energy_out(name: str, q: float, v: float) -> None:
    assert force(EFFECTS[name], 1.5, FORMULAS[name][1], q=q, v=v, u=2 - q, t=1.0) * v <= 0


@given(st.floats(0.4, 2), V)
def test_contact_never_pulls_and_takes_more_going_in_than_it_gives_going_out(
    q: float, v: float
) -> None:
    given = {"k": 3.0, "speed": 2.0}
    pushed = output("hunt_crossley", of=q, rate=v, wall=0.4, **given)
    assert pushed <= 0
    assert output("hunt_crossley", of=q, rate=abs(v), wall=0.4, **given) <= pushed
    assert output("hunt_crossley", of=-q, rate=-v, wall=-0.4, **given) == -pushed
    assert output("hunt_crossley", of=-q, rate=v, wall=0.4, **given) == 0


@EACH
def test_the_trace_has_a_value_for_every_parameter(block: Block) -> None:
    effect = block.effect
    assert effect is not None
    for parameter in block.parameters:
        tried = parameter.name == effect.coefficient or parameter.name in effect.shapes
        assert tried or parameter.default is not None
    assert len(block.outputs) == 1
    for shape in effect.shapes.values():
        assert len(set(shape.at)) == len(shape.at)


def test_the_frequencies_of_a_harmonic_lie_as_close_as_the_record_resolves_them() -> None:
    effect = library()["harmonic"].effect
    assert effect is not None
    periods = effect.shapes["period"]
    assert periods.of == "T"
    frequencies = [1 / at for at in periods.at]
    assert [b - a for a, b in pairwise(frequencies)] == pytest.approx([1.0] * 57)


@EACH
def test_aliases_are_other_effects(block: Block) -> None:
    assert block.effect is not None
    assert set(block.effect.alias) <= (EFFECTS.keys() | SENSOR) - {block.name}


def test_effects_at_the_drive_are_what_they_take_away() -> None:
    """The drive and what is added to it together: limited, without a middle, in steps."""
    for u in (-2.0, -0.65, -0.1, 0.0, 0.16, 0.9, 3.0):
        limited = u + output("drive_saturation", of=u, share=1, limit=0.7)
        assert limited == pytest.approx(clip(u, 0.7))
        rest = u + output("drive_dead_zone", of=u, share=1, zone=0.2)
        assert rest == pytest.approx(0 if abs(u) <= 0.2 else u - math.copysign(0.2, u))
        stepped = u + output("drive_quantiser", of=u, share=1, step=0.3)
        assert stepped == pytest.approx(0.3 * round(u / 0.3), abs=1e-12)
