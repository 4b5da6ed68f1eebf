from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from diagram.small_library import LIBRARY, refused
from tracewire.diagram import (
    Diagram,
    difference,
    find_parameter,
    read_text,
    replace_series,
    series_parts,
    with_series_of,
    write_out,
)
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_own import add_own
from tracewire.diagram.edit_sensors import add_sensor, set_sensors
from tracewire.diagram.edit_values import set_values
from tracewire.diagram.rewire import add_to_drive
from tracewire.errors import DiagramError, OptionError
from tracewire.formula import Number

BASE = """
title: base
span: [0, 2]
record: [x]
inputs: [F]
parameters:
  k: {value: 3, unit: N/mm, fit: [0, 10]}
  c: 0.1
require: [c >= 0]
subsystems:
  damper:
    inputs: [rate]
    outputs: [force]
    parameters: {c: 2}
    blocks: {force: {type: viscous, rate: rate, c: c}}
blocks:
  x: {type: integrator, of: v, start: {value: 1, unit: mm}}
  v: {type: integrator, of: force}
  spring: {type: expression, formula: k*x}
  damping: {type: damper, rate: v, c: c}
  force: {type: sum, of: [F, -spring, damping.force]}
events: [{when: x - 1, set: {v: 0}}]
presets: {soft: {k: 1}, light: {c: 0}}
measured:
  run_1: {file: run.csv, time: t, signals: {x: x, v: {column: v, gain: {fit: free, value: 1}}}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "base.yaml").write_text(BASE)
    (tmp_path / "parts" / "run.csv").write_text("t,x,v\n0,0,0\n1,1,1\n")
    return tmp_path


def extended(folder: Path, changes: str = "") -> Diagram:
    text = f"extends: parts/base.yaml\n{changes}"
    return read_text(text, folder / "top.yaml", library=LIBRARY)


def same_as(folder: Path, changes: str, old: str, new: str) -> bool:
    """Whether the changes make the base with `new` in place of `old`, written out."""
    assert old in BASE
    whole = read_text(BASE.replace(old, new), folder / "parts" / "whole.yaml", library=LIBRARY)
    return said(extended(folder, changes)) == said(whole)


CHANGES = {
    "nothing": ("", "", ""),
    "a title": ("title: other", "title: base", "title: other"),
    "a list is replaced": ("record: [v]", "record: [x]", "record: [v]"),
    "an input comes behind": ("inputs: {G: {default: 0}}", "[F]", "{F: {}, G: {default: 0}}"),
    "a number keeps unit and bounds": ("parameters: {k: 5}", "value: 3", "value: 5"),
    "bounds keep the number": (
        "parameters: {k: {fit: [1, 9]}, c: {fit: free}}",
        "fit: [0, 10]}\n  c: 0.1",
        "fit: [1, 9]}\n  c: {value: 0.1, fit: free}",
    ),
    "a parameter is added": ("parameters: {m: 2}", "c: 0.1\n", "c: 0.1\n  m: 2\n"),
    "a setting": ("blocks: {damping: {c: 7}}", "rate: v, c: c", "rate: v, c: 7"),
    "a start in its unit": ("blocks: {x: {start: 4}}", "start: {value: 1", "start: {value: 4"),
    "a type replaces the block": (
        "blocks: {spring: {type: gain, of: x, k: k}}",
        "{type: expression, formula: k*x}",
        "{type: gain, of: x, k: k}",
    ),
    "a block inside": (
        "subsystems: {damper: {blocks: {force: {c: 2*c}}}}",
        "rate: rate, c: c",
        "rate: rate, c: 2*c",
    ),
    "an output of a list": (
        "subsystems: {damper: {outputs: {minus: -force}}}",
        "outputs: [force]",
        "outputs: {force: force, minus: -force}",
    ),
    "events are added": (
        "events: [{when: x - 2, set: {v: 1}}]",
        "set: {v: 0}}]",
        "set: {v: 0}}, {when: x - 2, set: {v: 1}}]",
    ),
    "conditions are added": ("require: [k > 0]", "[c >= 0]", "[c >= 0, k > 0]"),
    "a preset": ("presets: {soft: {k: 2, c: 3}}", "soft: {k: 1}", "soft: {k: 2, c: 3}"),
    "a column": ("measured: {run_1: {signals: {v: x}}}", "{column: v,", "{column: x,"),
    "a series": ("measured: {run_1: {burn_in: 0.1}}", "time: t,", "time: t, burn_in: 0.1,"),
    "a block goes": (
        "remove: [damping, force]\nblocks: {force: {type: sum, of: [F, -spring]}}",
        "  damping: {type: damper, rate: v, c: c}\n  force: {type: sum, of: [F, -spring, "
        "damping.force]}",
        "  force: {type: sum, of: [F, -spring]}",
    ),
    "a section goes": ("remove: events", "events: [{when: x - 1, set: {v: 0}}]", ""),
    "bounds go": ("remove: [k.fit]", ", fit: [0, 10]", ""),
    "a preset goes": ("remove: [presets.soft]", "soft: {k: 1}, ", ""),
    "an input goes": (
        "remove: [F]\nblocks: {force: {of: [-spring]}}",
        "inputs: [F]",
        "inputs: []\n",
    ),
}


@pytest.mark.parametrize("case", CHANGES)
def test_changes_are_as_if_written_out(folder: Path, case: str) -> None:
    changes, old, new = CHANGES[case]
    if case == "an input goes":
        diagram = extended(folder, changes)
        assert not diagram.inputs
        assert [wire.signal for wire in diagram.blocks["force"].inputs["of"]] == ["spring"]
        return
    assert same_as(folder, changes, old, new)
    diagram = extended(folder, changes)
    again = read_text(write_out(diagram), folder / "top.yaml", library=LIBRARY)
    assert said(again) == said(diagram)


MESSAGES = {
    "no file": ("extends: base.yml", "top.yaml:1:10: unknown file 'base.yml' in"),
    "two files": ("extends: [a, b]", "top.yaml:1:10: 'extends' names one file. Write extends:"),
    "itself": ("extends: top.yaml", "diagrams extend each other: top.yaml -> top.yaml. Move"),
    "in a circle": ("extends: ring.yaml", "each other: top.yaml -> ring.yaml -> top.yaml. Move"),
    "what is not there": (
        "extends: parts/base.yaml\nremove: [sprung]",
        "top.yaml:2:10: unknown part to remove 'sprung'; there are: F, blocks, c, damper, damping, "
        "events, force, inputs, k, light, measured, parameters and 11 more. Did you mean 'spring'",
    ),
    "nothing extended": (
        "remove: [x]\nblocks: {}",
        "top.yaml:1:1: 'remove' takes parts of another diagram away, and this one extends none. "
        "Write extends: FILE, or take the parts away here.",
    ),
    "in the base": (
        "extends: parts/base.yaml\nremove: [c]",
        "parts/base.yaml:9:11: unknown parameter 'c'; there are: k",
    ),
    "in the changes": (
        "extends: parts/base.yaml\nblocks: {v: {of: y}}",
        "top.yaml:2:18: block 'v': unknown signal 'y'",
    ),
    "a name of another kind": (
        "extends: parts/base.yaml\nparameters: {x: 1}",
        "parts/base.yaml:17:3: two definitions of 'x': a block here, and a parameter in ",
    ),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_messages(folder: Path, case: str) -> None:
    text, message = MESSAGES[case]
    (folder / "ring.yaml").write_text("extends: top.yaml\n")
    (folder / "top.yaml").write_text(text)
    assert message in refused(text, folder / "top.yaml")


def test_a_name_in_two_sections_needs_its_section(folder: Path) -> None:
    changes = "extends: parts/base.yaml\nmeasured: {x: {file: a.csv}}\n"
    (folder / "middle.yaml").write_text(changes)
    told = refused("extends: middle.yaml\nremove: [x]", folder / "top.yaml")
    assert "top.yaml:2:10: 'x' may mean several parts of the diagram that is extended" in told
    assert "there are: blocks.x, measured.x. Write one of them." in told


def test_diagrams_in_a_long_row_are_refused(tmp_path: Path) -> None:
    for i in range(40):
        (tmp_path / f"f{i}.yaml").write_text(f"extends: f{i + 1}.yaml")
    told = refused("extends: f0.yaml", tmp_path / "top.yaml")
    assert "diagrams extend each other more than 30 levels deep" in told


def test_a_row_of_diagrams(folder: Path) -> None:
    (folder / "middle.yaml").write_text("extends: parts/base.yaml\nparameters: {k: 5, c: 4}\n")
    text = "extends: middle.yaml\nparameters: {k: 6}\n"
    diagram = read_text(text, folder / "top.yaml", library=LIBRARY)
    numbers = {name: value.formula for name, value in diagram.parameters.items()}
    assert numbers == {"k": Number(6.0), "c": Number(4.0)}
    assert diagram.measured["run_1"].file.resolve() == folder / "parts" / "run.csv"


def si(diagram: Diagram, path: str) -> float:
    value = find_parameter(diagram, path)
    assert value is not None and isinstance(value.formula, Number)
    return value.formula.value * value.factor


def test_a_value_of_the_base_is_changed_in_the_text_that_extends_it(folder: Path) -> None:
    old = extended(folder)
    new = set_values(old, {"k": 4200.0, "c": 0.25, "x.start": 0.002})
    assert new.text == (
        "extends: parts/base.yaml\n"
        "parameters:\n  k: {value: 4.2, unit: N/mm, fit: [0, 10]}\n  c: 0.25\n"
        "blocks:\n  x: {start: {value: 2, unit: mm}}\n"
    )
    assert [si(new, path) for path in ("k", "c", "x.start")] == [4200.0, 0.25, 0.002]
    assert (folder / "parts" / "base.yaml").read_text() == BASE
    assert set_values(new, {"k": 4200.0}).text == new.text
    one = "-  k: {value: 4.2, unit: N/mm, fit: [0, 10]}\n+  k: {value: 5, unit: N/mm, fit: [0, 10]}"
    assert one in difference(new, set_values(new, {"k": 5000.0}))


def test_a_value_inside_a_subsystem_of_the_base(folder: Path) -> None:
    old = extended(folder, "remove: [damping.c]\n")
    new = set_values(old, {"damping.c": 3.0})
    assert new.text == old.text + "subsystems:\n  damper: {parameters: {c: 3}}\n"
    assert si(new, "damping.c") == 3.0


def test_an_addend_of_a_sum_of_the_base(folder: Path) -> None:
    old = extended(folder, "blocks: {v: {start: 1}}\n")
    new = add_addend(old, "force", "drag", "{type: viscous, rate: v, c: 0}")
    assert [wire.signal for wire in new.blocks["force"].inputs["of"]][-1] == "drag"
    assert new.text == (
        "extends: parts/base.yaml\nblocks: {v: {start: 1}, force: {of: [F, -spring, damping.force, "
        "drag]}, drag: {type: viscous, rate: v, c: 0}}\n"
    )


def test_an_addend_to_a_drive_of_the_base(folder: Path) -> None:
    new = add_to_drive(extended(folder), "v", "late", "{type: gain, of: v, k: 0}")
    readers = {name: use.inputs for name, use in new.blocks.items()}
    assert readers["x"]["of"][0].signal == readers["damping"]["rate"][0].signal == "v_seen"
    assert said(extended(folder).blocks["force"]) == said(new.blocks["force"])
    with pytest.raises(OptionError, match="an event that reads the drive stands in another file"):
        add_to_drive(extended(folder), "x", "late", "{type: gain, of: x, k: 0}")


def test_sensors_and_series_of_the_base(folder: Path) -> None:
    old = extended(folder)
    new = add_sensor(old, "x", "offset", 0.5, (0.0, 1.0))
    offset = new.measured["run_1"].channels["x"].offset
    assert offset is not None and offset.formula == Number(0.5)
    new = set_sensors(new, {"offset.x": 0.25, "gain.v": 1.5})
    channels = new.measured["run_1"].channels
    assert [channels["x"].offset, channels["v"].gain] != [None, None]
    assert "gain: {fit: free, value: 1.5}" in new.text
    assert channels["v"].column == "v"
    own = add_own(new, {"run_1": {"k": 2000.0, "c": 1.0}}, {"c": (0.0, 2.0)})
    assert "parameters: {k: 2, c: {value: 1, fit: [0, 2]}}" in own.text
    again = set_sensors(own, {"c@run_1": 1.25})
    assert again.measured["run_1"].parameters["c"].formula == Number(1.25)


def test_other_series_in_place_of_those_of_the_base(folder: Path) -> None:
    old = extended(folder, "measured: {run_1: {burn_in: 0.5}}\nremove: [soft]\n")
    assert series_parts(old, "run_1")["file"] == "parts/run.csv"
    new = replace_series(old, {"mine": "{file: parts/run.csv, time: t, signals: {x: x}}"})
    assert list(new.measured) == ["mine"]
    assert list(new.presets) == ["light"]
    changed = set_values(add_sensor(new, "x", "offset", 0.5), {"c": 1.0})
    back = with_series_of(changed, old)
    assert list(back.measured) == ["run_1"]
    assert back.measured["run_1"].burn_in == 0.5
    assert si(back, "c") == 1.0
    assert back.measured["run_1"].channels["x"].offset is not None


def test_what_is_included_is_not_changed_by_an_edit(tmp_path: Path) -> None:
    (tmp_path / "steel.yaml").write_text("parameters: {rho: 7850}\n")
    text = "include: steel.yaml\nblocks: {x: {type: gain, of: x, k: rho}}\n"
    diagram = read_text(text, tmp_path / "top.yaml", library=LIBRARY)
    with pytest.raises(OptionError, match="'rho' is defined in a file that is included"):
        set_values(diagram, {"rho": 1.0})


def test_a_base_that_is_no_yaml(folder: Path) -> None:
    (folder / "parts" / "base.yaml").write_text("a: [")
    with pytest.raises(DiagramError, match=r"base.yaml:2:1: this is not YAML"):
        extended(folder)


def test_needed_libraries_are_merged_by_name(tmp_path: Path) -> None:
    base = 'libraries: {tracewire: ">=0.1"}\nblocks: {y: {type: constant, value: 1}}\n'
    (tmp_path / "base.yaml").write_text(base)
    text = "extends: base.yaml\nlibraries: {tracewire: '>=0.0'}\n"
    assert "libraries: {tracewire: '>=0.0'}" in write_out(read_text(text, tmp_path / "top.yaml"))
