"""The rigs of the benchmark: their diagrams compile, and answers are judged rightly."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from tracewire.compile import compile
from tracewire.diagram import read

from benchmarks.rigs.records import DIAGRAMS, RECORDS, generate
from benchmarks.rigs.score import grade
from benchmarks.rigs.truth import TRUTHS


def effect(name: str, *ties: str, **params: float) -> dict[str, Any]:
    """An effect `name @ place` of an answer."""
    what, where = name.split(" @ ")
    return {"name": what, "place": where, "params": params, "ties": list(ties)}


def judged(rig: str, verdict: str, *effects: dict[str, Any], **more: Any) -> str:
    """What an answer on a rig is worth."""
    return grade(TRUTHS[rig], {"verdict": verdict, "effects": list(effects), **more})


def test_a_record_is_generated_beside_its_diagrams(tmp_path: Path) -> None:
    file = generate("r08_torsion", tmp_path)
    lines = file.with_suffix(".csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "run,t,phi_deg"
    assert len(lines) == 1 + 3 * 2000
    assert file.is_file()
    assert (tmp_path / "r08_torsion_true.yaml").is_file()


@pytest.mark.parametrize("name", [f"{rig}{end}" for rig in RECORDS for end in ("", "_true")])
def test_a_diagram_compiles(name: str, tmp_path: Path) -> None:
    """Without its record, of which only the file has to be there."""
    (tmp_path / f"{name.removesuffix('_true')}.csv").touch()
    compile(read(shutil.copy(DIAGRAMS / f"{name}.yaml", tmp_path)))


def test_every_rig_has_a_truth() -> None:
    assert list(TRUTHS) == list(RECORDS)
    assert {file.stem.removesuffix("_true") for file in DIAGRAMS.iterdir()} == set(RECORDS)


def test_hidden_effects_are_right_alone_and_with_more_beside_others() -> None:
    cubic, dry = effect("cubic_stiffness @ acceleration"), effect("coulomb @ acceleration")
    other = effect("bias @ acceleration")
    assert judged("r02_base", "effect", dry, cubic) == "right"
    assert judged("r02_base", "effect", dry, cubic, other) == "with more"
    assert judged("r02_base", "unexplained", dry, cubic) == "partly"
    assert judged("r02_base", "effect", dry) == "partly"
    assert judged("r02_base", "effect", other) == "wrong"
    assert judged("r02_base", "null") == "wrong"


def test_a_tie_or_an_equal_effect_stands_for_one_hidden_effect() -> None:
    dry, drag = "coulomb @ acceleration", "cubic_damping @ acceleration"
    assert judged("r01_pendulum", "effect", effect(drag, "quad_drag @ acceleration")) == "right"
    both = effect("cubic_stiffness @ acceleration", dry)
    assert judged("r02_base", "effect", both) == "partly"
    motor = effect("coulomb @ shaft"), effect("bias @ shaft")
    assert judged("r04_motor", "effect", *motor) == "right"


def test_a_law_that_no_block_has_is_right_at_its_place() -> None:
    law = {"place": "heat1", "variables": ["rise1"]}
    assert judged("r05_heater", "unexplained", missing=law) == "right"
    assert judged("r05_heater", "unexplained", missing=law | {"variables": ["t"]}) == "partly"
    assert judged("r05_heater", "unexplained", missing=law | {"place": "heat2"}) == "wrong"
    assert judged("r05_heater", "effect", effect("cubic_stiffness @ heat1")) == "right"
    assert judged("r06_tank", "effect", effect("quad_stiffness @ balance")) == "partly"


def test_what_is_in_a_record_besides_is_no_stranger_beside_what_is_hidden() -> None:
    board = effect("position_friction @ torques", pitch=2.09)
    second = effect("position_friction @ torques", pitch=3.1)
    lag, ripple = effect("drive_lag @ drive.i"), effect("cogging @ torques")
    assert judged("r79_telescope", "effect", board, lag, ripple, second) == "right"
    assert judged("r79_telescope", "effect", board, lag, effect("bias @ torques")) == "with more"
    assert judged("r79_telescope", "effect", second, lag) == "partly"
    assert judged("r79_telescope", "effect", ripple) == "wrong"
    stays = effect("stop_q @ goal")
    assert judged("r72_piezo", "effect", stays, effect("play_q @ goal")) == "right"


def test_a_spring_that_drifts_is_named_with_its_period_or_not_at_all() -> None:
    assert judged("r10_stage", "null") == "right"
    assert judged("r10_stage", "effect", effect("parametric @ forces", period=47.1)) == "right"
    assert judged("r10_stage", "effect", effect("parametric @ forces", period=0.3)) == "wrong"


def test_the_second_wave_of_a_force_ripple_is_named_with_its_pitch_or_not_at_all() -> None:
    assert judged("r44_ripple", "null") == "right"
    assert judged("r44_ripple", "effect", effect("cogging @ forces", pitch=0.0151)) == "right"
    assert judged("r44_ripple", "effect", effect("cogging @ forces", pitch=0.02)) == "wrong"


def test_what_is_the_same_on_a_record_is_right_within_its_bounds() -> None:
    """One way round, bristles that bend at once rub as friction that is higher near rest does."""
    at_once = effect("lugre @ force", deflection=1e-6)
    slowly = effect("lugre @ force", deflection=1e-3)
    assert judged("r61_pin", "effect", at_once) == "right"
    assert judged("r61_pin", "effect", slowly) == "wrong"
    assert judged("r63_scooter", "effect", effect("drive_gain @ drive.F")) == "right"
    assert judged("r63_scooter", "effect", effect("drive_lag @ drive.F")) == "wrong"
