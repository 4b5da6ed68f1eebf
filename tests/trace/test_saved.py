"""A saved trace is read again as it was, and what is none is told in one message."""

from __future__ import annotations

import copy
import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tracewire as tw
from show.traces import FOUND, NULL, TEXT, UNEXPLAINED, missing_of_two
from tracewire.diagram import read_text
from tracewire.errors import OptionError
from tracewire.show import report
from tracewire.show.trace_summary import paragraph_of
from tracewire.trace import Found, TraceOptions
from tracewire.trace.found import Dependence, Explained, Force, HeldOut, Remainder

JUDGED = replace(
    FOUND,
    explained=Explained(0.98, 0.96, 0.99),
    remainder=(Remainder("theta", "rad", 0.005, 1.25, 0.04),),
    remainder_depends=(Dependence("torque", ("q", "v"), 0.35),),
    held_out=(HeldOut(0.5, ("a", "b"), np.arange(2.0), np.ones(2), np.ones(2), np.zeros(0)),),
    options=TraceOptions(only=("torque",), effects=2, horizon=1.5),
)


@pytest.mark.parametrize(
    "found", [JUDGED, NULL, UNEXPLAINED, replace(UNEXPLAINED, missing=missing_of_two())]
)
def test_a_saved_trace_is_read_as_it_was(tmp_path: Path, found: Found) -> None:
    again = tw.load(tw.save(found, tmp_path / "trace.json"))
    assert json.dumps(again.json(), default=str) == json.dumps(found.json(), default=str)
    assert again.patch == found.patch
    assert again.options == found.options
    for one, other in zip(again.forces, found.forces, strict=True):
        np.testing.assert_array_equal(one.needed, other.needed)
        assert one.names == other.names
    for curve, as_it_was in zip(again.curves, found.curves, strict=True):
        np.testing.assert_array_equal(curve.windowed_after, as_it_was.windowed_after)
    np.testing.assert_array_equal(again.confusable[1].ravel(), found.confusable[1].ravel())


def test_the_report_of_a_saved_trace_is_the_same(tmp_path: Path) -> None:
    again = tw.load(tw.save(JUDGED, tmp_path / "trace.json"))
    assert report(again).markdown() == report(JUDGED).markdown()


def test_effects_are_applied_by_choice(tmp_path: Path) -> None:
    (name,) = (str(effect) for effect in FOUND.effects)
    two = replace(
        FOUND,
        effects=(*FOUND.effects, replace(FOUND.effects[0], place="drive.u")),
        find_diagram=lambda effects: replace(FOUND.diagram, title=" and ".join(effects)),
    )
    assert two.apply() == two.diagram == two.apply(effects=[name, str(two.effects[1])])
    assert two.apply(effects=[]) == two.original
    assert two.apply(effects=[name]).title == name
    with pytest.raises(OptionError, match="unknown effect of the trace 'x'"):
        two.apply(effects=["x", name])
    again = tw.load(tw.save(two, tmp_path / "trace.json"))
    assert again.apply(effects=[name, str(two.effects[1])]).text == two.diagram.text
    with pytest.raises(OptionError, match="loaded is applied as a whole"):
        again.apply(effects=[name])


def test_what_only_approximates_is_applied_by_choice_alone() -> None:
    found = replace(
        UNEXPLAINED,
        effects=FOUND.effects,
        find_diagram=lambda effects: replace(FOUND.diagram, title=" and ".join(effects)),
    )
    assert found.apply() == found.diagram
    assert found.apply(effects=["coulomb @ torque"]).title == "coulomb @ torque"


def test_the_file_is_plain_json_without_nan(tmp_path: Path) -> None:
    def refuse(text: str) -> None:
        raise AssertionError(text)

    text = tw.save(FOUND, tmp_path / "trace.json").read_text(encoding="utf-8")
    data = json.loads(text, parse_constant=refuse)
    assert (data["kind"], data["version"]) == ("a trace of tracewire", 1)
    assert data["options"]["budget"] == "inf"
    assert data["original"]["text"] == TEXT


def test_units_stay_known_where_the_files_of_the_diagram_are_gone(tmp_path: Path) -> None:
    csv = tmp_path / "a.csv"
    csv.write_text("t,a\n0,0\n1,0\n", encoding="utf-8")
    text = TEXT + (
        "measured:\n  swing_3: {file: a.csv, time: t,"
        " signals: {theta: {column: a, unit: deg}}, start: {theta: 0}}\n"
    )
    original = read_text(text, tmp_path / "swing.yaml")
    bare = {name: unit for name, unit in FOUND.units.items() if "coulomb" not in name}
    found = replace(FOUND, original=original, units=bare)
    said = paragraph_of(found)
    assert "for theta from 10.5 to 0.234 deg" in said
    file = tw.save(found, tmp_path / "trace.json")
    csv.unlink()
    again = tw.load(file)
    assert paragraph_of(again) == said
    assert (again.original.title, again.original.text) == ("Swing & rest", text)


def test_forces_that_cannot_be_computed_do_not_cost_the_result(tmp_path: Path) -> None:
    def fail() -> tuple[Force, ...]:
        raise ZeroDivisionError("no window is left")

    again = tw.load(tw.save(replace(FOUND, find_forces=fail), tmp_path / "trace.json"))
    assert again.forces == ()
    assert "the needed force could not be computed: no window is left" in again.words


def test_a_trace_can_be_pickled_and_copied() -> None:
    live = replace(FOUND, find_forces=lambda: FOUND.forces)  # what no pickle could hold
    for again in (pickle.loads(pickle.dumps(live)), copy.copy(live), copy.deepcopy(live)):
        assert again.effects == FOUND.effects
        np.testing.assert_array_equal(again.forces[0].fitted, FOUND.forces[0].fitted)


def changed(**fields: Any) -> str:
    from tracewire.trace.saved import to_data

    return json.dumps(to_data(FOUND) | fields)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "trace.json: this is no saved trace. Name a file that `tracewire trace --save` has"),
        ("{", "this is no saved trace"),
        ("[1]", "this is no saved trace"),
        ('{"kind": "another"}', "this is no saved trace"),
        ("[" * 100_000, "this is no saved trace"),
        (
            '{"kind": "a fit of tracewire"}',
            "This is a saved fit: go on from it with `tracewire fit",
        ),
        (changed(version=2), "saved by a newer tracewire (format 2; this one reads 1). Update"),
        (changed(verdict="perhaps"), "the saved trace is damaged: 'verdict' is \"perhaps\". Trace"),
        (changed(effects=7), "damaged: 'effects' is no list"),
        (changed(effects=[{"name": "coulomb"}]), "damaged: 'effects.place' is missing"),
        (changed(rmse_after="small"), "damaged: 'rmse_after' is no number"),
        (changed(values=[1]), "damaged: 'values' is no object"),
        (changed(confusable=[[]]), "damaged: 'confusable' has 1 parts instead of 2"),
        (changed(confusable=[["a"], [[1], [1, 2]]]), "the rows of 'confusable' differ in length"),
        (changed(original=None), "damaged: 'original' is missing"),
        (changed(interrupted="no"), "damaged: 'interrupted' is \"no\""),
    ],
)
def test_what_is_no_saved_trace_is_told(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "trace.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(OptionError) as caught:
        tw.load(file)
    assert len(caught.value.problems) == 1
    assert said in str(caught.value)


def test_a_file_that_is_not_there_or_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"the saved trace cannot be read: No such file.*Check"):
        tw.load(tmp_path / "none.json")
    with pytest.raises(OptionError, match=r"cannot be written: No such file.*Name a file"):
        tw.save(NULL, tmp_path / "no" / "trace.json")
