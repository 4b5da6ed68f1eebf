from __future__ import annotations

from pathlib import Path

import pytest
from diagram.small_library import LIBRARY, refused
from tracewire.diagram import read_text
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_values import set_values
from tracewire.errors import OptionError

PARTS = """
title: parts
subsystems:
  bearing:
    inputs: [rate]
    outputs: {torque: total}
    parameters: {c: 2}
    blocks:
      drag: {type: viscous, rate: rate, c: c}
      total: {type: sum, of: [drag]}
"""
TOP = "include: [parts/bearings.yaml]\ninputs: [u]\nblocks: {b: {type: bearing, rate: u}}\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "bearings.yaml").write_text(PARTS)
    return tmp_path


def test_included_subsystems_can_be_used(folder: Path) -> None:
    diagram = read_text(TOP, folder / "top.yaml", library=LIBRARY)
    bearing = diagram.subsystems["bearing"]
    assert diagram.blocks["b"].subsystem is bearing
    assert bearing.file == folder / "parts" / "bearings.yaml"
    assert bearing.text == PARTS
    assert bearing.place.file == str(bearing.file)


def test_one_name_stands_for_a_list(folder: Path) -> None:
    text = TOP.replace("[parts/bearings.yaml]", "parts/bearings.yaml")
    assert refused(text, folder / "top.yaml") == ""


def test_paths_start_at_the_including_file(folder: Path) -> None:
    (folder / "parts" / "more.yaml").write_text(
        "include: bearings.yaml\nsubsystems:\n"
        "  two: {inputs: [u], outputs: {y: b}, blocks: {b: {type: bearing, rate: u}}}"
    )
    text = "include: [parts/more.yaml, parts/bearings.yaml]\nblocks: {z: {type: two, u: b}, b: "
    told = refused(text + "{type: bearing, rate: o}, o: {type: integrator, of: z}}", folder / "t")
    assert told == ""


def test_mistakes_in_an_included_file_name_that_file(folder: Path) -> None:
    file = folder / "parts" / "bearings.yaml"
    file.write_text(PARTS.replace("rate: rate", "rate: rte"))
    told = refused("titel: x\n" + TOP, folder / "top.yaml").splitlines()
    assert told[0].startswith(f"{folder / 'top.yaml'}:1:1")
    assert told[1].startswith(f"{file}:9:35: block 'bearing.drag': unknown signal 'rte'")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("blocks: {}", "unknown section of an included file 'blocks'; there are: include, lib"),
        ("a: [", "this is not YAML"),
        ("text", "an included file must be a mapping"),
        ("", "the file is empty"),
        ("include: ../top.yaml", "files include each other: top.yaml -> bearings.yaml -> top.yaml"),
        ("include: bearings.yaml", "files include each other: bearings.yaml -> bearings.yaml"),
        ("include: [a]", "unknown file 'a' in"),
    ],
)
def test_what_may_not_be_included(folder: Path, content: str, message: str) -> None:
    (folder / "parts" / "bearings.yaml").write_text(content)
    (folder / "top.yaml").write_text(TOP)
    assert message in refused(TOP, folder / "top.yaml")


def test_a_missing_file_is_told_where_it_is_named(folder: Path) -> None:
    told = refused(TOP.replace("bearings.", "bearing."), folder / "top.yaml")
    assert f"{folder / 'top.yaml'}:1:11: unknown file 'bearing.yaml'" in told
    assert "Did you mean 'bearings.yaml'?" in told


def test_a_subsystem_cannot_come_from_two_files(folder: Path) -> None:
    (folder / "other.yaml").write_text(PARTS)
    text = TOP.replace("[parts/", "[other.yaml, parts/")
    assert "two definitions of 'bearing': one in 'parts/" in refused(text, folder / "top.yaml")
    own = TOP + "subsystems: {bearing: {inputs: [rate], outputs: {y: rate}, blocks: {}}}"
    assert "two definitions of 'bearing'" in refused(own, folder / "top.yaml")


MATERIALS = """
parameters:
  rho: {value: 7850, unit: kg/m^3}
  weight: rho*g
presets: {aluminium: {rho: 2700}}
"""


def test_parameters_and_presets_of_included_files_are_those_of_the_diagram(folder: Path) -> None:
    (folder / "parts" / "materials.yaml").write_text(f"include: gravity.yaml{MATERIALS}")
    (folder / "parts" / "gravity.yaml").write_text("parameters: {g: 9.81}\n")
    text = TOP.replace("[parts/", "[parts/materials.yaml, parts/gravity.yaml, parts/")
    text += "parameters: {c: weight/1000}\npresets: {heavy: {rho: 9000, c: 1}}\n"
    diagram = read_text(text, folder / "top.yaml", library=LIBRARY)
    assert list(diagram.parameters) == ["g", "rho", "weight", "c"]
    assert diagram.parameters["rho"].unit == "kg/m^3"
    assert diagram.parameters["rho"].place.file == str(folder / "parts" / "materials.yaml")
    assert list(diagram.presets) == ["aluminium", "heavy"]
    # a subsystem sees its own parameters only, those of its file not
    part = folder / "parts" / "bearings.yaml"
    part.write_text(PARTS.replace("c: c}", "c: rho}") + "parameters: {other: 1}")
    told = refused(text, folder / "top.yaml")
    assert "bearings.yaml:9:44: block 'bearing.drag': unknown parameter 'rho'" in told


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("parameters: {k: 1}", "'k': one in 'parts/more.yaml', the other in {top}:4:14. Rename"),
        ("presets: {p: {}}", "'p': one in 'parts/more.yaml', the other in {top}:5:11. Rename"),
        ("parameters: [k]", "more.yaml:1:13: 'parameters' must be a mapping. Write it like {{k: 2"),
        ("presets: {q: {z: 1}}", "more.yaml:1:15: unknown parameter 'z'; there are: b.c, k"),
        ("parameters: {b: 1}", "block here, and a parameter in {more}:1:14. Parameters, blocks"),
    ],
)
def test_messages_of_included_parameters(folder: Path, content: str, message: str) -> None:
    more, top = folder / "parts" / "more.yaml", folder / "top.yaml"
    more.write_text(content)
    text = TOP.replace("[parts/", "[parts/more.yaml, parts/")
    told = refused(f"{text}parameters: {{k: 1}}\npresets: {{p: {{k: 2}}}}\n", top)
    assert message.format(more=more, top=top) in told


def test_files_in_a_long_row_are_refused(tmp_path: Path) -> None:
    for i in range(40):
        (tmp_path / f"f{i}.yaml").write_text(f"include: f{i + 1}.yaml")
    told = refused("include: f0.yaml\nblocks: {}", tmp_path / "top.yaml")
    assert "files include each other more than 30 levels deep" in told


def test_what_another_file_defines_is_not_edited(folder: Path) -> None:
    diagram = read_text(TOP, folder / "top.yaml", library=LIBRARY)
    with pytest.raises(OptionError, match="'bearing' is defined in another file"):
        add_addend(diagram, "bearing.total", "x", "{type: viscous, rate: rate, c: 0}")
    with pytest.raises(OptionError, match="'bearing' is defined in another file"):
        set_values(diagram, {"b.c": 3})
