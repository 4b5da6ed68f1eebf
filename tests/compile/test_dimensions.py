"""Units that contradict each other, at every wire: what is told, and what is not."""

from __future__ import annotations

from pathlib import Path

import pytest
from tracewire.compile import compile, unit_problems
from tracewire.diagram import read, read_text

ROOT = Path(__file__).parents[2]
BODY = """\
parameters:
  m: {value: 2, unit: kg}
  k: {value: 3, unit: N/m}
  c: {value: 0.1, unit: N s/m}
  level: {value: 1, unit: N}
blocks:
  x: {type: integrator, of: v, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  spring: {type: gain, of: x, k: -k}
  damper: {type: gain, of: v, k: -c}
  friction: {type: coulomb, rate: v, level: level}
  force: {type: sum, of: [spring, damper, friction]}
  a: {type: gain, of: force, k: 1/m}
"""
HINT = "Correct a unit, or give the number between them a unit. What has no unit may have any."


def told(text: str) -> list[str]:
    return [str(p) for p in unit_problems(compile(read_text(text), backend="quick").flat)]


def test_units_that_go_together_are_not_told() -> None:
    assert told(BODY) == []


def shipped() -> list[Path]:
    """Diagrams; those of measured sets whose data are absent cannot be read."""
    files = sorted(ROOT.glob("diagrams/**/*.yaml"))
    return [f for f in files if "\nblocks:" in f.read_text("utf-8") and "real" not in f.parts]


@pytest.mark.parametrize("file", shipped(), ids=lambda file: file.stem)
def test_the_units_of_each_shipped_diagram_go_together(file: Path) -> None:
    assert unit_problems(compile(read(file), backend="quick").flat) == []


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "[spring, damper, friction]",
            "[spring, x]",
            "<text>:12:3: block 'force': 'spring' (line 9) is in N and 'x' (line 7) is in m: they "
            "cannot be added or compared. ",
        ),
        (
            "unit: N/m}",
            "unit: N/m^2}",
            "<text>:12:3: block 'force': 'spring' (line 9) is in N/m and 'damper' (line 10) is in "
            "N: they cannot be added or compared. ",
        ),
        (
            "v: {type: integrator, of: a, unit: m/s}",
            "v: {type: integrator, of: a, unit: m}",
            "<text>:7:3: block 'x': 'x' is in m, and is the integral of what is in m; it needs a "
            "rate in m/s. ",
        ),
        (
            "sum, of: [spring, damper, friction]",
            "expression, formula: spring + damper + level*sin(v)",
            "<text>:12:3: block 'force': 'v' (line 8) is in m/s where a number or an angle is "
            "needed. ",
        ),
        (
            "sum, of: [spring, damper, friction]}",
            "sum, of: [spring, damper, friction], unit: J}",
            "<text>:12:3: block 'force': 'force' is in J, and its formula is in N. ",
        ),
        (
            "of: v, unit: m}",
            "of: v, unit: m, start: level}",
            "<text>:7:3: block 'x': 'x' is in m, and 'level' (line 5) is in N. ",
        ),
        (
            "sum, of: [spring, damper, friction]",
            "expression, formula: spring if x > v else damper",
            "<text>:12:3: block 'force': 'x' (line 7) is in m and 'v' (line 8) is in m/s: they "
            "cannot be added or compared. ",
        ),
        (
            "1, unit: N}",
            "k*m, unit: N}",
            "<text>:5:10: 'level' is in N, and its value is in kg^2/s^2. ",
        ),
        (
            "blocks:",
            "events: [{when: x - 1, set: {v: -x}}]\nblocks:",
            "'v' (line 9) is in m/s, and what 'events[0]' sets it to is in m. ",
        ),
    ],
)
def test_what_contradicts_is_told_with_both_ends(old: str, new: str, message: str) -> None:
    assert old in BODY
    first = told(BODY.replace(old, new))[0]
    assert message in first
    assert HINT in first


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (
            "mass, force: u, mass: {value: 2, unit: m}",
            "<text>:3:35: block 'b': 'b.mass' is in m, and the block takes it in kg. Correct a",
        ),
        (
            "unit_delay, of: u, period: {value: 100, unit: Hz}",
            "<text>:3:40: block 'b': 'b.period' is in Hz, and the block takes it in s. Correct a",
        ),
        (
            "unit_delay, of: u, period: rate",
            "<text>:3:40: block 'b': 'rate' (line 1) is in Hz, and the block takes it in s. ",
        ),
        (
            "sine, amplitude: 1, omega: {value: 3, unit: Hz}",
            "'b.omega' is in Hz, and the block takes it in rad/s. 1 Hz is 2*pi rad/s: write the",
        ),
        (
            "low_pass, of: u, frequency: {value: 3, unit: rad/s}",
            "'b.frequency' is in rad/s, and the block takes it in Hz. 1 Hz is 2*pi rad/s: write ",
        ),
        ("unit_delay, of: u, period: 1/rate", ""),
        ("unit_delay, of: u, period: {value: 10, unit: ms}", ""),
        ("sine, amplitude: 1, omega: 2*pi*rate", ""),
    ],
)
def test_the_unit_of_a_value_is_that_of_its_block(block: str, message: str) -> None:
    found = told(f"""\
parameters: {{rate: {{value: 100, unit: Hz}}}}
blocks:
  b: {{type: {block}}}
  u: {{type: constant, value: 1}}
""")
    assert len(found) == bool(message)
    assert message in "".join(found)


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (
            "relay, of: u, on_at: {value: 2, unit: m}, off_at: {value: 1, unit: N}",
            "block 'b': 'u' (line 4) is in N and 'b.on_at' is in m: they cannot be added or compa",
        ),
        (
            "latch, set: u, reset: u, threshold: {value: 1, unit: V}",
            "block 'b': 'u' (line 4) is in N and 'b.threshold' is in V: they cannot be added or c",
        ),
        (
            "quantizer, of: u, interval: {value: 1, unit: mm}",
            "block 'b': 'b.interval' is in m, and the block takes it in N. ",
        ),
        ("relay, of: u, on_at: {value: 2, unit: kN}, off_at: 1", ""),
        ("quantizer, of: u, interval: {value: 2, unit: mN}", ""),
    ],
)
def test_the_levels_of_a_block_with_memory_have_the_unit_of_its_input(
    block: str, message: str
) -> None:
    found = told(f"""\
parameters: {{F: {{value: 3, unit: N}}}}
blocks:
  b: {{type: {block}}}
  u: {{type: sine, amplitude: F, omega: 1, unit: N}}
""")
    assert bool(found) == bool(message)
    assert message in "".join(found)


@pytest.mark.parametrize(
    ("unit", "gain", "told_of"),
    [
        ("'%'", "N/%", ""),
        ("'%'", "N", ""),
        ("'%'", "kg", "'u' (line 4) is in kg"),
        ("V", "kg", "'u' (line 4)"),
    ],
)
def test_a_signal_in_percent_is_a_plain_number(unit: str, gain: str, told_of: str) -> None:
    found = told(f"""\
inputs: {{spool: {{unit: {unit}, default: 0}}}}
parameters: {{k: {{value: 3, unit: {gain}}}, F: {{value: 1, unit: N}}}}
blocks:
  u: {{type: gain, of: spool, k: k}}
  load: {{type: constant, value: F, unit: N}}
  net: {{type: sum, of: [u, load]}}
""")
    assert bool(found) == bool(told_of)
    assert told_of in "".join(found)


def test_a_parameter_in_percent_is_a_plain_number() -> None:
    text = "parameters: {p: {value: 3, unit: '%'}, m: {value: 1, unit: kg}}\nrequire: [p < m]\n"
    (found,) = told(text + "blocks: {x: {type: constant, value: m}}\n")
    assert "they cannot be added or compared" in found


@pytest.mark.parametrize("condition", ["m > k", "m*k > k**2"])
def test_what_a_diagram_requires_compares_like_with_like(condition: str) -> None:
    (found,) = told(f"require: [{condition}]\n" + BODY)
    assert found.startswith("<text>:1:") and "they cannot be added or compared" in found


def test_a_row_of_blocks_is_told_once() -> None:
    text = """
inputs: {u: {unit: m}}
blocks:
  lag: {type: integrator, of: previous, unit: m, replicate: {count: 5, first: {of: u}}}
"""
    (only,) = told(text)
    assert only.startswith("<text>:4:3: block 'lag_1': ")
    assert "; so it is in 4 other blocks of this line. " in only


def test_plain_numbers_are_no_units() -> None:
    text = """
parameters: {rate: {value: 1}}
blocks:
  u: {type: step, height: 1}
  x: {type: integrator, of: dx}
  dx: {type: sum, of: [u, -x]}
  y: {type: integrator, of: dy}
  dy: {type: expression, formula: -y - rate*y**2}
"""
    assert told(text) == []
    assert told(text.replace("{value: 1}", "{value: 1, unit: 1/s}"))
    assert told(text.replace("of: dx}", "of: dx, unit: m}"))


def test_what_is_left_open_is_told_by_its_name() -> None:
    more = """
  nothing: {type: constant, value: 0}
  z: {type: integrator, of: nothing}
  odd: {type: expression, formula: z**2*x + z**2*v}
"""
    wanted = (
        "'z**2*x' is in s^2 m times the unit of 'nothing'^2 and "
        "'z**2*v' is in s m times the unit of 'nothing'^2: they cannot be added or compared."
    )
    assert wanted in told(BODY + more)[0]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("k: {value: 3, unit: N/m}", "k: 3"),  # a parameter without a unit
        ("m: {value: 2, unit: kg}", "m: 2"),
        ("k: -k}", "k: -3}"),  # a number
        ("unit: m}", "unit: mm}"),  # the same quantity
        ("unit: N s/m}", "unit: kg/s}"),
        ("sum, of: [spring, damper, friction]", "expression, formula: spring*sin(3*t) + damper"),
        ("gain, of: v, k: -c", "expression, formula: -0.2*abs(v)**1.7*sign(v)"),
    ],
)
def test_what_has_no_unit_may_have_any(old: str, new: str) -> None:
    assert old in BODY
    assert told(BODY.replace(old, new)) == []


def test_signals_get_the_units_that_their_equations_give_them() -> None:
    text = BODY.replace(", unit: m/s}", "}").replace(", unit: m}", "}")
    units = compile(read_text(text), backend="quick").flat.units
    forces = dict.fromkeys(("spring", "damper", "friction", "force"), "N")
    assert units == {"x": "m", "v": "m/s", "a": "m/s^2", **forces}


@pytest.mark.parametrize(
    "text",
    [
        "blocks: {x: {type: integrator, of: v}, v: {type: gain, of: x, k: -1}}",  # no unit at all
        # a rate in 1/s may be one in rad/s
        "parameters: {w: {value: 3, unit: rad/s}}\n"
        "blocks: {x: {type: integrator, of: v}, v: {type: constant, value: w}}",
        # units that contradict each other
        BODY.replace(", unit: m}", "}").replace("unit: m/s}", "unit: kg}"),
    ],
)
def test_no_unit_is_made_up(text: str) -> None:
    units = compile(read_text(text), backend="quick").flat.units
    assert units["x"] == ""


def test_a_signal_without_a_unit_has_that_of_its_equations() -> None:
    """That of the acceleration follows from its integral, that of the force from its terms."""
    text = BODY.replace("1/m}", "k/m}")
    assert told(text) == [
        f"<text>:13:3: block 'a': 'a' is in m/s^2, and its formula is in N/s^2. {HINT}"
    ]
