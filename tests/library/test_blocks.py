"""The shipped blocks: what their formulas do at numbers."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library.values import library, output
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import TracewireError
from tracewire.library import Block, describe_json
from tracewire.solve import simulate

REAL = st.floats(-1e3, 1e3)
SIZE = st.floats(0.0, 1e3)

FAMILIES = {
    "sources": "constant bias harmonic time sine square step ramp table"
    " spline_table monotone_table",
    "linear": "integrator gain sum product divide",
    "math": "expression sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt"
    " power floor mod",
    "switching": "switch sign abs min max saturation dead_zone quantizer",
    "friction": "viscous cubic_damping quad_drag arctan_friction asymmetric_viscous"
    " asymmetric_arctan smoothed_stribeck asym_viscous viscous_drift",
    "dry_friction": "coulomb dry_friction asymmetric_coulomb asym_coulomb stribeck disp_friction"
    " position_friction friction_drift load_friction",
    "hysteresis": "hysteresis dahl lugre bouc_wen play play_q stop_q",
    "stiffness": "stiffness quad_stiffness cubic_stiffness asym_stiffness backlash stiffness_drift"
    " parametric cogging coupling_q coupling_v inertia elastic_load viscous_load"
    " relaxing_spring asymmetric_stiffness asymmetric_cubic_spring",
    "barrier": "voigt_barrier barrier overflow barrier_hi barrier_lo hunt_crossley",
    "drive": "drive_gain drive_lag drive_delay drive_saturation drive_dead_zone drive_quantiser"
    " drive_2nd_harm drive_3rd_harm",
    "memory": "relay play_operator latch toggle counter",
    "sampling": "sample_and_hold zero_order_hold",
    "limited": "limited_integrator reset_integrator rate_limiter",
    "vector": "mux demux dot total matrix_gain solve",
    "contact": "hard_stop bouncing_body collision one_way_clutch",
    "waves": "pulse sawtooth triangle chirp multisine",
    "noise": "prbs random_steps noise",
    "discrete": "unit_delay discrete_integrator discrete_transfer_function discrete_state_space"
    " discrete_pid",
    "logic": "compare and or xor not select edge monostable timer jk_flip_flop debounce",
    "delay": "delay variable_delay pade_delay",
    "control": "transfer_function state_space pid",
    "bodies": "mass rotating_mass gear rack lever",
    "transmission": "spring_damper rope elastic_gear belt",
    "brakes": "brake clutch eddy_brake",
    "friction_laws": "stribeck_friction friction_table rolling_resistance",
    "slip": "maxwell_slip maxwell_element",
    "tables": "signal_builder lookup_table_2d",
    "filters": "first_order lead_lag derivative second_order low_pass high_pass band_pass notch",
}


def test_the_families_hold_the_blocks_that_diagrams_are_written_with() -> None:
    names = {name: family for family, text in FAMILIES.items() for name in text.split()}
    assert dict(library().families) == names


def text_of(block: Block) -> str:
    """All that a block does, as the text of its formulas."""
    given = [o.formula for o in block.outputs] + [s.rate for s in block.states]
    given += [value for event in block.events for value in event.set.values()]
    parts = [p for g in given for p in ([g] if isinstance(g, str) else g.values())]
    parts += [state.start for state in block.states]
    parts += [mode.start or "" for mode in block.modes]
    parts += [text for t in block.transitions for text in (t.when, *t.set.values())]
    parts += [text for e in block.events for text in (*e.guards, e.every or "", e.offset)]
    return " ".join(parts + [str(port.default) for port in block.inputs])


@pytest.mark.parametrize("block", [*library().blocks.values()], ids=[*library()])
class TestEveryBlock:
    def test_says_in_one_sentence_what_it_is(self, block: Block) -> None:
        assert block.doc[0].isupper()
        assert block.doc.endswith(".")
        assert ". " not in block.doc
        assert "\n" not in block.doc

    def test_has_formulas_that_read_every_port_and_parameter(self, block: Block) -> None:
        read = set().union(
            *(feed for output in block.outputs if (feed := block.feedthrough(output.name))),
        )
        words = set(text_of(block).translate(str.maketrans("()[]+-*/,<>=", " " * 12)).split())
        declared = {port.name for port in block.inputs} | {p.name for p in block.parameters}
        assert declared <= words
        assert read <= declared

    def test_can_be_told_to_a_program(self, block: Block) -> None:
        told = json.loads(json.dumps(describe_json(library(), block.name)))
        assert told["name"] == block.name
        assert told["place"]["line"] > 0


# sources


def test_sine() -> None:
    assert output("sine", t=0.25, amplitude=3, omega=2 * math.pi, offset=1) == pytest.approx(4)
    assert output("sine", t=0, amplitude=3, omega=5, phase=math.pi / 6) == pytest.approx(1.5)


@given(st.floats(-50, 50), st.floats(0.1, 5), st.floats(-6, 6))
def test_square_is_the_sign_of_the_sine(t: float, frequency: float, phase: float) -> None:
    wave = math.sin(2 * math.pi * frequency * t + phase)
    assume(abs(wave) > 1e-6)
    level = output("square", t=t, amplitude=2.5, frequency=frequency, phase=phase)
    assert level == math.copysign(2.5, wave)


@pytest.mark.parametrize(("t", "sign"), [(0, 1), (0.49, 1), (0.5, -1), (0.99, -1), (1, 1)])
def test_square_takes_the_new_level_at_the_time_of_a_jump(t: float, sign: int) -> None:
    assert output("square", t=t, amplitude=1, frequency=1) == sign


def test_step_and_ramp_begin_at_their_time() -> None:
    assert [output("step", t=t, height=2, at=1, offset=5) for t in (0.9, 1, 7)] == [5, 7, 7]
    assert [output("ramp", t=t, slope=2, at=1, offset=5) for t in (0.9, 1, 3)] == [5, 5, 9]


def test_table_reads_the_time_or_its_wire_and_holds_its_ends() -> None:
    points = [(0.0, 1.0), (2.0, 5.0), (4.0, 0.0)]
    assert [output("table", t=t, points=points) for t in (-1, 1, 3, 9)] == [1, 3, 2.5, 0]
    assert output("table", t=0, of=1, points=points) == 3


def test_constant_bias_and_time() -> None:
    assert output("constant", value=-3) == -3
    assert output("bias", level=0.5) == 0.5
    assert output("time", t=2.5) == 2.5


# linear and math

ONE = {"sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt"}


def test_integrator_integrates_its_wire_from_its_start() -> None:
    block = library()["integrator"]
    (state,) = block.states
    assert (state.rate, state.start) == ("of", "start")
    assert output("integrator", of=3, x=7) == 7
    assert block.feedthrough("y") == frozenset()


def test_linear_blocks() -> None:
    assert output("gain", of=3, k=-2) == -6
    assert output("sum", of=[1, -2, 4]) == 3
    assert output("product", of=[2, -2, 4]) == -16
    assert output("divide", of=3, by=4) == 0.75
    assert library()["sum"].feedthrough("y") == {"of"}


@pytest.mark.parametrize("name", sorted(ONE))
@given(u=st.floats(0.01, 0.99))
def test_functions_are_those_of_mathematics(name: str, u: float) -> None:
    assert output(name, of=u) == getattr(math, name)(u)


def test_functions_of_two_signals() -> None:
    assert output("atan2", y=1, x=-1) == math.atan2(1, -1)
    assert output("power", of=2, exponent=0.5) == math.sqrt(2)
    assert output("floor", of=-0.5) == -1
    assert [output("mod", of=u, by=b) for u, b in ((7, 3), (-1, 3), (1, -3))] == [1, 2, -2]


def test_expression_is_the_formula_that_its_user_gives() -> None:
    (parameter,) = library()["expression"].parameters
    assert parameter.kind == "formula"
    assert output("expression", formula=4.0) == 4.0


# switching


@pytest.mark.parametrize(("control", "passed"), [(0.9, 2), (1, 1), (1.1, 1)])
def test_switch_passes_above_from_its_threshold_on(control: float, passed: float) -> None:
    assert output("switch", control=control, above=1, below=2, threshold=1) == passed


@given(REAL, REAL)
def test_sign_abs_min_and_max(u: float, v: float) -> None:
    assert output("sign", of=u) * output("abs", of=u) == u
    assert output("min", of=u, other=v) + output("max", of=u, other=v) == u + v
    assert output("min", of=u, other=v) <= output("max", of=u, other=v)


@given(REAL, REAL, SIZE)
def test_saturation_and_dead_zone_share_a_signal(u: float, low: float, width: float) -> None:
    high = low + width
    held = output("saturation", of=u, low=low, high=high)
    beyond = output("dead_zone", of=u, low=low, high=high)
    assert low <= held <= high
    assert held + beyond == pytest.approx(u, rel=1e-12, abs=1e-12)
    assert (beyond == 0) == (low <= u <= high)


# friction

LAWS: dict[str, dict[str, float]] = {
    "viscous": {"c": 2},
    "coulomb": {"level": 2},
    "cubic_damping": {"c": 2},
    "dry_friction": {"slip": 2, "stick": 3},
    "quad_drag": {"c": 2},
    "arctan_friction": {"level": 2, "eps": 10},
    "asymmetric_viscous": {"c_l": 2, "c_r": 2},
    "asymmetric_coulomb": {"level_l": 2, "level_r": 2},
    "asymmetric_arctan": {"level_l": 2, "level_r": 2, "c_l": 1, "c_r": 1, "eps": 10},
    "smoothed_stribeck": {
        "level_l": 2,
        "level_r": 2,
        "decay_l": 0.5,
        "decay_r": 0.5,
        "alpha": 0.15,
        "beta": 2.2,
    },
}
EACH_LAW = pytest.mark.parametrize("law", LAWS)


@EACH_LAW
@given(rate=REAL, data=st.data())
def test_friction_takes_energy_out_whatever_its_parameters(
    law: str, rate: float, data: st.DataObject
) -> None:
    # alpha*rate stays below 710, where cosh leaves the double precision numbers
    given = {name: data.draw(st.floats(0, 0.7), label=name) for name in LAWS[law]}
    assert output(law, rate=rate, **given) * rate <= 0


@EACH_LAW
@given(rate=st.floats(1e-9, 1e3))
def test_friction_with_equal_sides_is_odd(law: str, rate: float) -> None:
    assert output(law, rate=rate, **LAWS[law]) == -output(law, rate=-rate, **LAWS[law])


@pytest.mark.parametrize("law", [law for law in LAWS if "asymmetric" in law or "stribeck" in law])
def test_l_is_the_side_of_positive_rates(law: str) -> None:
    only_l = {
        name: 0 if name[:-1].endswith("_") and name.endswith("r") else number
        for name, number in LAWS[law].items()
    }
    assert output(law, rate=2, **only_l) == output(law, rate=2, **LAWS[law]) < 0
    assert output(law, rate=-2, **only_l) == 0


def test_levels_of_friction() -> None:
    assert output("viscous", rate=3, c=2) == -6
    assert output("coulomb", rate=1e-9, level=2) == -2
    assert output("dry_friction", rate=-1e-9, slip=2, stick=5) == 2
    assert output("quad_drag", rate=-3, c=2) == 18
    assert output("arctan_friction", rate=1e9, level=2, eps=1) == pytest.approx(-2)
    assert output("arctan_friction", rate=0.1, level=2, eps=10) == pytest.approx(-1)


@pytest.mark.parametrize(
    ("levels", "told"),
    [
        ("slip: 2, stick: 1", "the parameters must meet slip <= stick, and slip = 2, stick = 1."),
        ("slip: high, stick: 1", "the parameters do not meet 'high <= 1': high = 2. Its block"),
    ],
)
def test_dry_friction_that_slips_above_its_sticking_level_is_refused(
    levels: str, told: str
) -> None:
    text = f"""
parameters: {{high: 2}}
blocks:
  v: {{type: integrator, of: b, start: 1}}
  b: {{type: dry_friction, rate: v, {levels}}}
"""
    with pytest.raises(TracewireError) as refused:
        simulate(compile(read_text(text)), span=(0, 1))
    assert str(refused.value).startswith("<text>:5:3: block 'b': " + told)


def test_dry_friction_sticks_at_its_slip_level_unless_told() -> None:
    assert {p.name: p.default for p in library()["dry_friction"].parameters}["stick"] == "slip"


def test_smoothed_stribeck_is_equation_24_of_the_paper() -> None:
    """0.025/(1 + 0.505*2)*(1 + 2.2/cosh(0.3))*tanh(0.3) at v = 2, and cosh(0.3) = 1.0453385141,

    tanh(0.3) = 0.2913126125, so it is 0.0124378109*3.1045814061*0.2913126125 = 0.0112488025.
    """
    table = {"level_l": 0.025, "level_r": 0.045, "decay_l": 0.505, "decay_r": 0.503}
    force = output("smoothed_stribeck", rate=2, alpha=0.15, beta=2.2, **table)
    assert force == pytest.approx(-0.0112488025, abs=1e-10)
    back = output("smoothed_stribeck", rate=-2, alpha=0.15, beta=2.2, **table)
    assert back == pytest.approx(-force * (0.045 / 2.006) / (0.025 / 2.01), rel=1e-12)


# springs and barriers

SPRINGS: dict[str, dict[str, float]] = {
    "stiffness": {"k": 2},
    "cubic_stiffness": {"k": 2},
    "asymmetric_stiffness": {"k_l": 2, "k_r": 5},
}


@pytest.mark.parametrize("spring", SPRINGS)
@given(of=REAL)
def test_a_spring_pulls_back(spring: str, of: float) -> None:
    assert output(spring, of=of, **SPRINGS[spring]) * of <= 0


def test_forces_of_springs() -> None:
    assert output("stiffness", of=3, k=2) == -6
    assert output("cubic_stiffness", of=-3, k=2) == 54
    assert [output("asymmetric_stiffness", of=u, k_l=2, k_r=5) for u in (3, -3)] == [-6, 15]


def test_asymmetric_cubic_spring_is_equation_23_of_the_paper() -> None:
    """f_s = kappa1*phi_f + kappa2*phi_f^3 with phi_f = -of; the sign of phi1 decides l or r."""
    table = {"k1_l": 0.0135, "k1_r": 0.0203, "k3_l": 0.0243, "k3_r": 0.0365}
    phi_f = -0.4
    for phi1, kappa1, kappa2 in (
        (0.1, 0.0135, 0.0243),
        (0, 0.0135, 0.0243),
        (-0.1, 0.0203, 0.0365),
    ):
        f_s = kappa1 * phi_f + kappa2 * phi_f**3
        force = output("asymmetric_cubic_spring", of=-phi_f, side=phi1, **table)
        assert force == pytest.approx(f_s, rel=1e-12)


BARRIER = {"high": 0.25, "k": 300.0, "c_l": 12.0, "c_r": 20.0}


@given(st.floats(-0.249999, 0.249999), REAL, st.sampled_from([0.0, 1.0]))
def test_a_barrier_does_nothing_between_its_limits(of: float, rate: float, adhesive: float) -> None:
    assert output("voigt_barrier", of=of, rate=rate, adhesive=adhesive, **BARRIER) == 0


@given(st.floats(0.25, 2), REAL)
def test_a_barrier_is_a_spring_and_a_damper_beyond_its_limits(of: float, rate: float) -> None:
    above = output("voigt_barrier", of=of, rate=rate, **BARRIER)
    below = output("voigt_barrier", of=-of, rate=-rate, **BARRIER)
    assert above == pytest.approx(-300 * (of - 0.25) - 12 * rate, rel=1e-12, abs=1e-9)
    assert below == pytest.approx(300 * (of - 0.25) + 20 * rate, rel=1e-12, abs=1e-9)


@given(st.floats(0.25, 2), REAL)
def test_a_barrier_that_is_not_adhesive_only_pushes(of: float, rate: float) -> None:
    adhesive = output("voigt_barrier", of=of, rate=rate, **BARRIER)
    assert output("voigt_barrier", of=of, rate=rate, adhesive=0, **BARRIER) == min(adhesive, 0)
    adhesive = output("voigt_barrier", of=-of, rate=rate, **BARRIER)
    assert output("voigt_barrier", of=-of, rate=rate, adhesive=0, **BARRIER) == max(adhesive, 0)


def test_a_barrier_may_have_limits_that_are_not_symmetric() -> None:
    given = {"low": 1.0, "high": 2.0, "k": 10.0, "c_l": 0.0}
    assert [output("voigt_barrier", of=u, rate=0, **given) for u in (0, 1.5, 3)] == [10, 0, -10]
