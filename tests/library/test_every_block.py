"""Every block of signals, control and bodies: refuses what is wrong, and is used somewhere.

A block added to one of these families needs an exact test `test_...NAME...` in a file beside this
one, a line in `BAD`, a source, and a place in a diagram of diagrams/gallery.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from library.values import library
from solve.models import LIMITS
from tracewire.compile import compile
from tracewire.diagram import read, read_text
from tracewire.errors import TracewireError
from tracewire.formula import Number
from tracewire.library import describe
from tracewire.solve import simulate

GALLERY = Path(__file__).parents[2] / "diagrams" / "gallery"
FAMILIES = (
    *("control", "filters", "waves", "noise", "discrete", "logic", "delay"),
    *("bodies", "transmission", "brakes", "friction_laws", "slip", "tables"),
)
BLOCKS = [name for name, family in library().families.items() if family in FAMILIES]
BLOCKS += ["quantizer", "spline_table", "monotone_table"]

DEGREE = "the numerator is of degree 2, and the denominator of degree 1: it would be a derivative"
NOT_ABOVE = "parameter '{}' must be above 0{}, not {}."
NOT_GIVEN = "parameter '{0}' is not given. Write {0}: ..."
ROW = "a row of 2 cannot be multiplied with a number in 'matrix_times([0, 1], u)'"
BAD = {
    "transfer_function": ("of: u, numerator: [1, 0, 0], denominator: [1, 1]", DEGREE),
    "state_space": ("of: u, A: [[1, 0], [0, 1]], B: [0, 1], C: [1, 0]", ROW),
    "pid": ("of: u, kp: 1, low: 2, high: 1", "the parameters must meet low <= high, and low = 2,"),
    "first_order": ("of: u, lag: 0", NOT_ABOVE.format("lag", " s", 0)),
    "lead_lag": ("of: u, lead: 1, lag: -1", NOT_ABOVE.format("lag", " s", -1)),
    "derivative": ("of: u", NOT_GIVEN.format("lag")),
    "second_order": ("of: u, frequency: 1", NOT_GIVEN.format("damping")),
    "low_pass": ("of: u, frequency: 0", NOT_ABOVE.format("frequency", " Hz", 0)),
    "high_pass": ("of: u, frequency: -2", NOT_ABOVE.format("frequency", " Hz", -2)),
    "band_pass": ("of: u, frequency: 1, damping: -1", "'damping' must be at least 0, not -1."),
    "notch": ("of: u", NOT_GIVEN.format("frequency")),
    "pulse": ("amplitude: 1, period: 1, duty: 1.5", "'duty' must be at most 1, not 1.5."),
    "sawtooth": ("amplitude: 1, period: 0", NOT_ABOVE.format("period", " s", 0)),
    "triangle": ("amplitude: 1, period: -1", NOT_ABOVE.format("period", " s", -1)),
    "chirp": (
        "amplitude: 1, first: 1, last: 2, duration: 0",
        NOT_ABOVE.format("duration", " s", 0),
    ),
    "multisine": (
        "frequencies: [1, 2], phases: [1, 2, 3]",
        "a vector of 2 and a vector of 3 do not go together",
    ),
    "prbs": ("period: 1, register: [1, 2]", "parameter 'register' must be at most 1, not 2."),
    "random_steps": ("period: 1, seed: 1, low: 3", "must meet low <= high, and low = 3, high = 1."),
    "noise": ("period: 1, seed: 1.5, sigma: 1", "must meet floor(seed) >= seed, and seed = 1.5."),
    "unit_delay": ("of: u, period: 0", NOT_ABOVE.format("period", " s", 0)),
    "discrete_integrator": ("of: u, period: 1, weight: 2", "'weight' must be at most 1, not 2."),
    "discrete_transfer_function": (
        "of: u, period: 1, numerator: [1, 0, 0], denominator: [1, 1]",
        DEGREE,
    ),
    "discrete_state_space": (
        "of: u, period: 1, A: [[1, 0], [0, 1]], B: [0, 1], C: [1, 0]",
        "a row of 2",
    ),
    "discrete_pid": ("of: u, kp: 1, period: 1, n: 0", NOT_ABOVE.format("n", " rad/s", 0)),
    "compare": ("of: [u, u]", "input 'of' takes one signal."),
    "and": ("threshold: 1", "input 'of' is not connected."),
    "or": ("of: v", "unknown signal 'v'"),
    "xor": ("of: u, level: 1", "unknown input or parameter of 'xor' 'level'"),
    "not": ("of: u, threshold: x", "unknown parameter 'x'"),
    "select": ("index: u", "input 'of' is not connected."),
    "edge": ("of: u", NOT_GIVEN.format("period")),
    "monostable": ("of: u, duration: 0", NOT_ABOVE.format("duration", " s", 0)),
    "timer": ("of: u, threshold: u", "'u' is a signal, and a value is fixed"),
    "jk_flip_flop": ("j: u, k: u, clock: u, start: 2", "'start' must be at most 1, not 2."),
    "delay": ("of: u, time: 0", NOT_ABOVE.format("time", " s", 0)),
    "variable_delay": (
        "of: u, time: u, shortest: 2, longest: 1",
        "the parameters must meet shortest <= longest, and shortest = 2, longest = 1.",
    ),
    "pade_delay": ("of: u, delay: 0", NOT_ABOVE.format("delay", " s", 0)),
    "spline_table": ("points: [[0, 1], [0, 2]]", "the points must ascend in x, and 0 is not"),
    "monotone_table": ("points: [[0, 1]]", "a table needs at least two points"),
    "mass": ("mass: 0", NOT_ABOVE.format("mass", " kg", 0)),
    "rotating_mass": ("inertia: -1", NOT_ABOVE.format("inertia", " kg m^2", -1)),
    "gear": (
        "ratio: 0, inertia1: 1, inertia2: 1",
        "the parameters must meet ratio**2 > 0, and ratio = 0.",
    ),
    "rack": ("radius: 0, inertia: 1, mass: 1", NOT_ABOVE.format("radius", " m", 0)),
    "lever": (
        "a: 1, b: 0, inertia: 1",
        "the parameters must meet b**2 > 0, and b = 0.",
    ),
    "belt": (
        "angle1: u, rate1: u, angle2: u, rate2: u, r1: 0.1, r2: 0, k: 1",
        "the parameters must meet r2**2 > 0, and r2 = 0.",
    ),
    "spring_damper": ("of: u, rate: u, k: 1, c: -2", "'c' must be at least 0, not -2."),
    "rope": ("of: u, rate: u, k: 1, length: -1", "'length' must be at least 0, not -1."),
    "elastic_gear": (
        "angle1: u, rate1: u, angle2: u, rate2: u, k: 1, efficiency: 1.2",
        "'efficiency' must be at most 1, not 1.2.",
    ),
    "brake": (
        "rate: u, normal: u, friction: 0.4, stick: 0.3",
        "the parameters must meet friction <= stick, and friction = 0.4, stick = 0.3.",
    ),
    "clutch": ("rate: u, normal: u, friction: 0.4", "input 'other_rate' is not connected."),
    "eddy_brake": ("rate: u, peak: 1, speed: 0", NOT_ABOVE.format("speed", "", 0)),
    "stribeck_friction": (
        "rate: u, slip: 3, stick: 2, speed: 1",
        "the parameters must meet slip <= stick, and slip = 3, stick = 2.",
    ),
    "friction_table": (
        "rate: u, points: [[-1, 2], [0, 1], [1, 2]]",
        "parameter 'points' must be at least 0, not -1.",
    ),
    "rolling_resistance": ("rate: u, load: u, c0: -1", "'c0' must be at least 0, not -1."),
    "maxwell_slip": (
        "rate: u, k: [1, 2], level: [1, 2, 3]",
        "a vector of 3 and a vector of 2 do not go together",
    ),
    "maxwell_element": ("rate: u, k: 1, level: 0, c: 1", NOT_ABOVE.format("level", "", 0)),
    "signal_builder": ("times: [1, 0], values: [1, 2]", "the times must ascend, and 0 is not"),
    "lookup_table_2d": (
        "of: u, other: u, rows: [0, 1], columns: [0, 1], values: [1, 2]",
        "the values are a vector of 2, and not 2 rows of 2 values",
    ),
    "debounce": ("of: u, duration: 0", NOT_ABOVE.format("duration", " s", 0)),
    "quantizer": ("of: u, interval: 0", NOT_ABOVE.format("interval", "", 0)),
}


@pytest.mark.parametrize("name", BLOCKS)
def test_a_wrong_setting_is_told_with_its_line_and_block(name: str) -> None:
    settings, told = BAD[name]
    text = f"span: [0, 1]\nblocks:\n  u: {{type: time}}\n  y: {{type: {name}, {settings}}}\n"
    with pytest.raises(TracewireError) as caught:
        compile(read_text(text))
    assert re.match(r"<text>:4:\d+: block 'y': ", str(caught.value))
    assert told in str(caught.value)
    assert len(caught.value.problems) == 1


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_has_an_exact_test(name: str) -> None:
    tests = [
        p.read_text("utf-8") for p in Path(__file__).parent.glob("test_*.py") if p != Path(__file__)
    ]
    assert any(re.search(rf"def test_\w*{name}|^    \"{name}\": \(", text, re.M) for text in tests)


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_says_where_it_is_from(name: str) -> None:
    block = library()[name]
    assert block.source
    assert block.source in describe(library(), name)


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_is_used_in_the_gallery(name: str) -> None:
    diagrams = [path.read_text("utf-8") for path in GALLERY.glob("*.yaml")]
    assert any(re.search(rf"type: {name}\b", text) for text in diagrams)


@pytest.mark.parametrize("file", sorted(GALLERY.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_diagram_of_the_gallery_runs(file: Path) -> None:
    diagram = read(file)
    result = simulate(compile(diagram), limits=LIMITS)
    assert diagram.span is not None
    assert Number(result.t[-1]) == diagram.span[1].formula
    assert not result.warnings
