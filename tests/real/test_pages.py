"""The pages of diagrams/real: their errors before and after, by fits of blocks put in by hand."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest
from tracewire.compile import compile
from tracewire.data.index import SETS
from tracewire.diagram import read
from tracewire.fit import Fit, fit

from benchmarks.tracing.sets import DIAGRAMS, REAL, SHARED, lay_out

here = pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
Edit = tuple[str, str]
TO_8_S: Edit = ("    time: t\n", "    time: t\n    to: 8\n")
GYRO: Edit = ("unit: rad/s}}", "unit: rad/s, offset: {fit: [-1, 1]}}}")


def instead(old: str, *new: str) -> tuple[Edit, Edit]:
    """Edits that put blocks in the place of one: `name: {...}` each."""
    names = ", ".join(line.split(":")[0] for line in new)
    return (f"{old}]", f"{names}]"), (rf"\n  {old}: .*", "".join(f"\n  {line}" for line in new))


def beside(old: str, *new: str) -> tuple[Edit, Edit]:
    """Edits that add blocks to the sum in which another one stands last."""
    names = ", ".join(line.split(":")[0] for line in new)
    return (f"{old}]", f"{old}, {names}]"), (
        rf"(\n  {old}: .*)",
        r"\1" + "".join(f"\n  {line}" for line in new),
    )


COULOMB = "dry_bearing: {type: coulomb, rate: omega, level: {value: 0.163, fit: [0, 10]}}"
DRAG = "drag: {type: quad_drag, rate: omega, c: {value: 0.003, fit: [0, 1]}}"
DAHL = "{type: hysteresis, rate: v, level: {value: 150, fit: [0, 2000]}"
DAHL += ", deflection: {value: 0.03, unit: mm, fit: [0.001, 10]}}"
SOFT = "rubbing: {type: bouc_wen, rate: v, level: level, exponent: {value: 2, fit: [1, 20]}"
SOFT += ", beta: 0.5, deflection: {value: 0.05, unit: mm, fit: [0.005, 1]}, start: -1}"
AIR = "air: {type: viscous, rate: v, c: {value: 0.1, fit: [0, 10]}}"
RUBBING = "rubbing: {type: coulomb, rate: v, level: {value: 20, unit: N, fit: [0, 200]}}"
DIRECTION = "direction: {type: asym_viscous, rate: v"
DIRECTION += ", c: {value: 0, unit: N s/m, fit: [-500, 500]}}"
LOSS = "loss: {type: hysteresis, rate: rate, level: {value: 4, unit: um, fit: [0, 50]}"
LOSS += ", deflection: {value: 0.5, unit: V, fit: [0.01, 50]}}"
WAVE = "n{n}: {{type: cogging, of: follower, amplitude: {{value: 0.3, unit: A, fit: [0, 3]}}"
WAVE += ", pitch: 2*pi/{n}, phase: {{value: 1, fit: [-10, 10]}}}}"
O_RING = "ring: {type: coulomb, rate: v, level: {value: 4, unit: N, fit: [0, 50]}}"
SHARE = "share: {type: hysteresis, rate: v, level: 1"
SHARE += ", deflection: {value: 0.3, unit: mm, fit: [0.01, 5]}}"
GROWN = "ring: {type: expression, formula: (level + slope*p)*share}"
GROWTH = r"\1\n  level: {value: 1, unit: N, fit: [0, 50]}"
GROWTH += r"\n  slope: {value: 1, unit: N/bar, fit: [0, 20]}"
SOFT_COUPLING = "soft: {type: hysteresis, rate: slip, level: {value: 200, fit: [0, 20000]}"
SOFT_COUPLING += ", deflection: {value: 0.01, fit: [0.0001, 1]}}"
VOLTAGE: Edit = ("q: {column: qm, unit: m}", "q: {column: qm, unit: m, weight: 1e-6}")
LATE: Edit = ("unit: um}}", "unit: um, delay: {fit: [0, 0.2]}}}")


class Case(NamedTuple):
    """A fit of a page: the edited diagram, the errors that it says in SI, and of which signal.

    `error` is that of the fitted series, or has those of several; `unseen` has the errors on the
    series for validation that the page has.
    """

    diagram: str
    edits: tuple[Edit, ...]
    error: float | tuple[float, ...]
    signal: str = ""
    unseen: tuple[float, ...] = ()


CASES: dict[str, Case] = {
    "large": Case("multiarm_pendulum/large.yaml", (), 27.9e-3),
    "large, both frictions": Case(
        "multiarm_pendulum/large.yaml",
        instead("bearing", COULOMB, DRAG),
        7.68e-3,
    ),
    "small": Case("multiarm_pendulum/small.yaml", (TO_8_S,), 3.965e-3),
    "small, coulomb": Case(
        "multiarm_pendulum/small.yaml",
        (TO_8_S, *instead("bearing", COULOMB)),
        1.051e-3,
    ),
    "damper 4.1": Case("mr_damper/run_4_1.yaml", (), 32.9),
    "damper 4.2": Case("mr_damper/run_4_2.yaml", (), 101.8),
    "damper 4.4": Case("mr_damper/run_4_4.yaml", (), 86.0),
    "damper 4.4, hysteresis": Case("mr_damper/run_4_4.yaml", beside("oil", f"w: {DAHL}"), 23.6),
    "axial": Case("bicycle_wheel_pendulum/axial.yaml", (), 31.0e-3),
    "axial, offset": Case("bicycle_wheel_pendulum/axial.yaml", (GYRO,), 7.96e-3),
    "radial": Case("bicycle_wheel_pendulum/radial.yaml", (), 16.96e-3),
    "radial, offset": Case("bicycle_wheel_pendulum/radial.yaml", (GYRO,), 10.17e-3),
    "tribometer": Case("tribometer_presliding/loop.yaml", (), 2.01),
    "tribometer, presliding": Case(
        "tribometer_presliding/loop.yaml",
        ((r"\n  rubbing: .*", f"\n  {SOFT}"),),
        0.103,
    ),
    "whiffle ball, drag": Case("falling_balls/whiffle_ball.yaml", beside("weight", AIR), 0.133),
    "bowling ball, drag": Case("falling_balls/bowling_ball.yaml", beside("weight", AIR), 0.135),
    "axis": Case("emps/axis.yaml", (VOLTAGE,), 0.2674, "voltage", (0.2806,)),
    "axis, coulomb": Case(
        "emps/axis.yaml",
        (VOLTAGE, *beside("constant", RUBBING)),
        0.0706,
        "voltage",
        (0.0964,),
    ),
    "axis, direction": Case(
        "emps/axis.yaml",
        (VOLTAGE, *instead("constant", RUBBING, DIRECTION)),
        0.0577,
        "voltage",
        (0.0863,),
    ),
    "piezo": Case("piezo_hysteresis/loops.yaml", (), 2.282e-6, unseen=(2.577e-6, 3.469e-6)),
    "piezo, delay": Case(
        "piezo_hysteresis/loops.yaml", (LATE,), 0.468e-6, unseen=(0.560e-6, 1.029e-6)
    ),
    "piezo, hysteresis": Case(
        "piezo_hysteresis/loops.yaml",
        beside("zero", LOSS),
        0.412e-6,
        unseen=(0.477e-6, 1.018e-6),
    ),
    "piezo, both": Case(
        "piezo_hysteresis/loops.yaml",
        (LATE, *beside("zero", LOSS)),
        0.300e-6,
        unseen=(0.362e-6, 0.866e-6),
    ),
    "motor": Case("motor_cogging/turn.yaml", (), 0.603, unseen=(0.604, 0.780)),
    "motor, 7 on a turn": Case(
        "motor_cogging/turn.yaml",
        beside("constant", WAVE.format(n=7)),
        0.258,
        unseen=(0.258, 0.513),
    ),
    "motor, six waves": Case(
        "motor_cogging/turn.yaml",
        beside("constant", *(WAVE.format(n=n) for n in (7, 12, 14, 28, 36, 84))),
        0.0964,
        unseen=(0.0985, 0.359),
    ),
    "cylinder": Case(
        "pneumatic_seal_friction/strokes.yaml", (), (4.34, 5.44, 6.83), unseen=(8.15,)
    ),
    "cylinder, coulomb": Case(
        "pneumatic_seal_friction/strokes.yaml",
        beside("zero", O_RING),
        (1.997, 0.916, 1.953),
        unseen=(3.48,),
    ),
    "cylinder, hysteresis grows with p": Case(
        "pneumatic_seal_friction/strokes.yaml",
        (
            ("zero]", "zero, ring]"),
            (r"(\n  tau: .*)", GROWTH),
            (r"(\n  zero: .*)", rf"\1\n  {SHARE}\n  {GROWN}"),
        ),
        (0.981, 0.809, 0.988),
        unseen=(1.913,),
    ),
    "bench": Case("twomass_bench/multisine.yaml", (), 1.196, "wm", (1.192,)),
    "bench, hysteresis": Case(
        "twomass_bench/multisine.yaml",
        beside("damper", SOFT_COUPLING),
        0.716,
        "wm",
        (0.722,),
    ),
}


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that `data get` makes of every set, from the files at hand."""
    pytest.importorskip("openpyxl")
    folder = tmp_path_factory.mktemp("real")
    for name in SETS:
        lay_out(name, folder)
    return folder


def test_every_set_has_a_page_and_a_diagram() -> None:
    assert {path.parent.name for path in REAL.glob("*/README.md")} == set(SETS)
    assert {name.partition("/")[0] for name in DIAGRAMS} == set(SETS)


def test_a_page_names_repository_commit_and_licence() -> None:
    for name, found in SETS.items():
        page = (REAL / name / "README.md").read_text(encoding="utf-8")
        assert f"github.com/{found.repository} at {found.commit[:7]}" in " ".join(page.split())
        assert f"Licence: {found.licence}" in " ".join(page.split())
        assert f"tracewire data get {name}" in page


@here
@pytest.mark.parametrize("name", DIAGRAMS)
def test_a_diagram_finds_its_files_and_says_its_places(name: str, home: Path) -> None:
    diagram = read(home / name)
    assert diagram.measured
    assert "place:" in diagram.text


def fitted(name: str, edits: tuple[Edit, ...], home: Path) -> Fit:
    """The fit of an edited diagram; an edit's first text is a pattern where it has a backslash."""
    path = home / name
    text = path.read_text(encoding="utf-8")
    for old, new in edits:
        changed = re.sub(old if "\\" in old else re.escape(old), new, text, count=1)
        assert changed != text, f"{old} is not in {name}"
        text = changed
    edited = path.with_name(f"edited_{path.name}")
    edited.write_text(text, encoding="utf-8")
    return fit(compile(read(edited)), method="least_squares")


@here
@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_the_errors_of_the_pages(case: str, home: Path) -> None:
    name, edits, error, signal, unseen = CASES[case]
    compared = [c for c in fitted(name, edits, home).comparisons if signal in ("", c.signal)]
    trained = [c.rmse_after for c in compared if c.use == "train"]
    assert trained == pytest.approx(error if isinstance(error, tuple) else [error], rel=0.01)
    validated = [c.rmse_after for c in compared if c.use == "validate"]
    assert not unseen or validated == pytest.approx(unseen, rel=0.01)


@here
@pytest.mark.slow
def test_two_swings_of_one_pendulum_agree_on_its_dry_friction(home: Path) -> None:
    levels = [
        fitted(name, edits, home).values["dry_bearing.level"]
        for name, edits, *_ in (CASES["large, both frictions"], CASES["small, coulomb"])
    ]
    assert levels[0] == pytest.approx(levels[1], rel=0.02)
