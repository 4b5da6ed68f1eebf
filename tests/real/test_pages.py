"""The pages of diagrams/real: their errors before and after, by fits of blocks put in by hand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tracewire.compile import compile
from tracewire.data.sets import SETS
from tracewire.diagram import read
from tracewire.fit import Fit, fit

ROOT = Path(__file__).parents[2]
REAL = ROOT / "diagrams" / "real"
SHARED = ROOT.parent / "shared" / "data"
DIAGRAMS = sorted(path.relative_to(REAL).as_posix() for path in REAL.glob("*/*.yaml"))
here = pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
Edit = tuple[str, str]
TO_8_S: Edit = ("    time: t\n", "    time: t\n    to: 8\n")
GYRO: Edit = ("unit: rad/s}}", "unit: rad/s, offset: {fit: [-1, 1]}}}")


def instead(old: str, *new: str) -> tuple[Edit, Edit]:
    """Edits that put blocks in the place of one: `name: {...}` each."""
    names = ", ".join(line.split(":")[0] for line in new)
    return (f"{old}]", f"{names}]"), (rf"\n  {old}: .*", "".join(f"\n  {line}" for line in new))


def beside(old: str, new: str) -> tuple[Edit, Edit]:
    """Edits that add a block to the sum in which another one stands last."""
    name = new.split(":")[0]
    return (f"{old}]", f"{old}, {name}]"), (rf"(\n  {old}: .*)", rf"\1\n  {new}")


COULOMB = "dry_bearing: {type: coulomb, rate: omega, level: {value: 0.163, fit: [0, 10]}}"
DRAG = "drag: {type: quad_drag, rate: omega, c: {value: 0.003, fit: [0, 1]}}"
DAHL = "{type: hysteresis, rate: v, level: {value: 150, fit: [0, 2000]}"
DAHL += ", deflection: {value: 0.03, unit: mm, fit: [0.001, 10]}}"
SOFT = "rubbing: {type: bouc_wen, rate: v, level: level, exponent: {value: 2, fit: [1, 20]}"
SOFT += ", beta: 0.5, deflection: {value: 0.05, unit: mm, fit: [0.005, 1]}, start: -1}"
AIR = "air: {type: viscous, rate: v, c: {value: 0.1, fit: [0, 10]}}"

# diagram, edits, error of the fitted series in SI: what the pages say
CASES: dict[str, tuple[str, tuple[Edit, ...], float]] = {
    "large": ("multiarm_pendulum/large.yaml", (), 27.9e-3),
    "large, both frictions": (
        "multiarm_pendulum/large.yaml",
        instead("bearing", COULOMB, DRAG),
        7.68e-3,
    ),
    "small": ("multiarm_pendulum/small.yaml", (TO_8_S,), 3.965e-3),
    "small, coulomb": (
        "multiarm_pendulum/small.yaml",
        (TO_8_S, *instead("bearing", COULOMB)),
        1.051e-3,
    ),
    "damper 4.1": ("mr_damper/run_4_1.yaml", (), 32.9),
    "damper 4.2": ("mr_damper/run_4_2.yaml", (), 101.8),
    "damper 4.4": ("mr_damper/run_4_4.yaml", (), 86.0),
    "damper 4.4, hysteresis": ("mr_damper/run_4_4.yaml", beside("oil", f"w: {DAHL}"), 23.6),
    "axial": ("bicycle_wheel_pendulum/axial.yaml", (), 31.0e-3),
    "axial, offset": ("bicycle_wheel_pendulum/axial.yaml", (GYRO,), 7.96e-3),
    "radial": ("bicycle_wheel_pendulum/radial.yaml", (), 16.96e-3),
    "radial, offset": ("bicycle_wheel_pendulum/radial.yaml", (GYRO,), 10.17e-3),
    "tribometer": ("tribometer_presliding/loop.yaml", (), 2.01),
    "tribometer, presliding": (
        "tribometer_presliding/loop.yaml",
        ((r"\n  rubbing: .*", f"\n  {SOFT}"),),
        0.103,
    ),
    "whiffle ball, drag": ("falling_balls/whiffle_ball.yaml", beside("weight", AIR), 0.133),
    "bowling ball, drag": ("falling_balls/bowling_ball.yaml", beside("weight", AIR), 0.135),
}


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that `data get` makes of every set, from the files at hand."""
    pytest.importorskip("openpyxl")
    folder = tmp_path_factory.mktemp("real")
    for name, found in SETS.items():
        data = folder / name / "data"
        data.mkdir(parents=True)
        for file in found.files:
            (data / file.name).symlink_to(SHARED / name / file.name)
        for made, text_of in found.made.items():
            (data / made).write_text(text_of(data), encoding="utf-8")
        for diagram in (REAL / name).glob("*.yaml"):
            (folder / name / diagram.name).write_bytes(diagram.read_bytes())
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
def test_a_diagram_finds_its_files_and_has_one_place(name: str, home: Path) -> None:
    diagram = read(home / name)
    assert diagram.measured
    assert sum("place:" in line for line in diagram.text.splitlines()) == 1


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
    name, edits, error = CASES[case]
    (train,) = (c for c in fitted(name, edits, home).comparisons if c.use == "train")
    assert train.rmse_after == pytest.approx(error, rel=0.01)


@here
@pytest.mark.slow
def test_two_swings_of_one_pendulum_agree_on_its_dry_friction(home: Path) -> None:
    levels = [
        fitted(name, edits, home).values["dry_bearing.level"]
        for name, edits, _ in (CASES["large, both frictions"], CASES["small, coulomb"])
    ]
    assert levels[0] == pytest.approx(levels[1], rel=0.02)
