from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from diagram.small_library import LIBRARY, refused
from tracewire.diagram import Diagram, read_text, write_out
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_values import set_values
from tracewire.errors import OptionError

CELL = """
parameters: {n: 3, k: 2}
subsystems:
  cell:
    inputs: [left, right]
    outputs: [x]
    parameters: {k: 1, start: 0}
    blocks:
      x: {type: integrator, of: v, start: start}
      v: {type: integrator, of: force}
      force: {type: sum, of: [left, right, spring]}
      spring: {type: gain, of: x, k: -2*k}
"""
ROW = """
blocks:
  wall: {type: integrator, of: wall}
  row:
    type: cell
    left: previous.x
    right: next.x
    start: 0.1*index
    replicate: {count: n, first: {left: wall}, last: {right: wall, k: k}}
"""
TOP = CELL + ROW
OUT = """
blocks:
  wall: {type: integrator, of: wall}
  row_1: {type: cell, left: wall, right: row_2.x, start: 0.1*1}
  row_2: {type: cell, left: row_1.x, right: row_3.x, start: 0.1*2}
  row_3: {type: cell, left: row_2.x, right: wall, start: 0.1*3, k: k}
"""


def made(text: str) -> Diagram:
    return read_text(text, library=LIBRARY)


def test_a_row_is_as_if_written_out() -> None:
    assert said(made(TOP)) == said(made(CELL + OUT))
    assert [use.row for use in made(TOP).blocks.values()] == ["", "row", "row", "row"]
    text = write_out(made(TOP))
    assert "  row_2: {type: cell, left: row_1.x, right: row_3.x, start: 0.1*2}\n" in text
    assert said(made(text)) == said(made(TOP))


def test_places_are_those_of_the_line() -> None:
    places = {use.place.line for use in made(TOP).blocks.values() if use.row}
    assert places == {16}
    told = refused(TOP.replace("right: next.x", "right: next.y"))
    assert "<text>:19:12: block 'row_1': unknown output 'row_2.y'; there are: row_2.x" in told


def test_a_row_of_blocks_that_are_no_subsystems() -> None:
    text = """
inputs: [u]
blocks:
  lag: {type: integrator, of: previous, replicate: {count: 2, first: {of: u}}}
  error:
    type: expression
    formula: previous - index*lag.last
    replicate: {count: 1, first: {formula: u}}
  same: {type: gain, of: -lag.first, k: 1}
  all: {type: sum, of: [u, -lag.all]}
"""
    diagram = made(text)
    assert list(diagram.blocks) == ["lag_1", "lag_2", "error_1", "same", "all"]
    wires = {name: use.inputs.get("of", ()) for name, use in diagram.blocks.items()}
    assert [wire.signal for wire in wires["lag_2"]] == ["lag_1"]
    assert [(wire.signal, wire.negative) for wire in wires["same"]] == [("lag_1", True)]
    found = [(wire.signal, wire.negative) for wire in wires["all"]]
    assert found == [("u", False), ("lag_1", True), ("lag_2", True)]


def test_an_input_may_have_the_name_of_a_text_elsewhere() -> None:
    """`source` and `note` are texts of a statement, and inputs here."""
    text = """
subsystems:
  cell:
    inputs: [source, note]
    outputs: [x]
    blocks: {x: {type: integrator, of: total}, total: {type: sum, of: [source, note]}}
blocks:
  wall: {type: integrator, of: row.last.x}
  row: {type: cell, source: previous.x, note: wall, replicate: {count: 2, first: {source: wall}}}
  end: {type: cell, source: row.last.x, note: row.first.x}
"""
    blocks = made(text).blocks
    assert blocks["row_2"].inputs["source"][0].signal == "row_1.x"
    assert blocks["end"].inputs["note"][0].signal == "row_1.x"


def test_a_ring() -> None:
    text = TOP.replace("first: {left: wall}, last: {right: wall, k: k}", "%s")
    ring = made(text % "first: {left: last.x}, last: {right: first.x}")
    assert ring.blocks["row_1"].inputs["left"][0].signal == "row_3.x"
    assert ring.blocks["row_3"].inputs["right"][0].signal == "row_1.x"
    one = made(text.replace("n: 3", "n: 1") % "first: {left: last.x}, last: {right: first.x}")
    assert one.blocks["row_1"].inputs["left"][0].signal == "row_1.x"


def test_ends_and_all_of_a_row_in_other_sections(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,x\n0,0\n1,1\n")
    text = TOP + (
        "record: [row.all.x, row.last.v]\n"
        "events: [{when: row.last.x - 1, set: {wall: row.first.x}}]\n"
        "presets: {far: {row.last.start: 1}}\n"
        "measured: {run: {file: a.csv, time: t, signals: {row.last.x: x}}}\n"
        'expect: [{that: end(row.last.x), above: 0, source: "of row.last.x"}]\n'
    )
    diagram = read_text(text, tmp_path / "top.yaml", library=LIBRARY)
    assert list(diagram.record) == ["row_1.x", "row_2.x", "row_3.x", "row_3.v"]
    assert str(diagram.events[0].set["wall"]) == str(
        made(TOP + text[len(TOP) :].splitlines()[1]).events[0].set["wall"]
    )
    assert list(diagram.presets["far"]) == ["row_3.start"]
    assert list(diagram.measured["run"].channels) == ["row_3.x"]
    assert diagram.expect[0].name == "end(row_3.x)"
    assert diagram.expect[0].source == "of row.last.x"


INSIDE = (
    CELL
    + """
  line:
    inputs: [wall]
    outputs: {end: row.last.x}
    parameters: {m: 2}
    blocks:
      row: {type: cell, left: previous.x, right: next.x,
            replicate: {count: m, first: {left: wall}, last: {right: wall}}}
"""
)


def test_each_use_of_a_subsystem_may_have_a_count_of_its_own() -> None:
    text = (
        INSIDE + "inputs: [u]\nblocks: {a: {type: line, wall: u, m: 4}, b: {type: line, wall: u},"
    )
    diagram = made(text + " c: {type: line, wall: u, m: n}}")
    inside = {name: use.subsystem for name, use in diagram.blocks.items()}
    found = {name: len(sub.blocks) for name, sub in inside.items() if sub is not None}
    assert found == {"a": 4, "b": 2, "c": 3}
    assert [sub.outputs["end"].signal for sub in inside.values() if sub] == [
        "row_4.x",
        "row_2.x",
        "row_3.x",
    ]
    assert said(made(write_out(diagram))) == said(diagram)


MESSAGES = {
    "no whole number": (
        TOP.replace("n: 3", "n: 2.5"),
        "<text>:21:24: block 'row': the count of a row must be a whole number from 1 to 10000, not "
        "n = 2.5. Write a number, or a parameter of this diagram that has one",
    ),
    "nothing": (TOP.replace("count: n", "count: 0"), "from 1 to 10000, not 0. Write"),
    "a formula": (TOP.replace("count: n", "count: 2*n"), "from 1 to 10000, not 2*n. Write"),
    "an unknown name": (TOP.replace("count: n", "count: z"), "from 1 to 10000, not z. Write"),
    "too many": (TOP.replace("count: n", "count: 20000"), "from 1 to 10000, not 20000. Write"),
    "a list": (TOP.replace("count: n", "count: [1]"), "from 1 to 10000, not this. Write"),
    "no count": (TOP.replace("count: n, ", ""), "'replicate' needs 'count'. Write count: ..."),
    "another key": (TOP.replace("first:", "begin:"), "unknown key of 'replicate' 'begin'"),
    "an end that is no mapping": (
        TOP.replace("first: {left: wall}", "first: wall"),
        "<text>:21:34: block 'row': 'first' of a row must be a mapping. Write it like {left: wall}",
    ),
    "nothing before the first": (
        TOP.replace("first: {left: wall}, ", ""),
        "<text>:18:11: block 'row': 'left' reads 'previous', and the first block of the row has "
        "none. Write replicate: {count: ..., first: {left: ...}}.",
    ),
    "nothing behind the last": (
        TOP.replace(", last: {right: wall, k: k}", ""),
        "<text>:19:12: block 'row': 'right' reads 'next', and the last block of the row has none",
    ),
    "a name twice": (
        TOP + "  row_2: {type: gain, of: wall, k: 1}\n",
        "<text>:22:3: two definitions of 'row_2': a block here, and one of the row 'row'. Rename",
    ),
    "a name with another meaning": (
        TOP.replace("{n: 3", "{index: 3, n: 3"),
        "<text>:2:14: 'index' means a part of a row in 'row', and is a name here. Rename it.",
    ),
    "the row as a signal": (
        TOP + "  y: {type: gain, of: row.x, k: 1}\n",
        "<text>:22:23: block 'y': 'row' is a row of 3 blocks, and 'row.x' is no signal. Name one, "
        "as in row.first.x, row.last.x or row_2.x; in a list row.all.x.",
    ),
    "a fit of the count": (
        TOP.replace("n: 3", "n: {value: 3, fit: [1, 9]}"),
        "'n' says how many blocks there are, and a fit cannot change it. Take 'fit' away.",
    ),
    "a preset of the count": (
        TOP + "presets: {long: {n: 9}}",
        "'n' says how many blocks there are, and a run cannot change it. Change it where it is",
    ),
    "a preset of a count inside": (
        INSIDE + "inputs: [u]\nblocks: {a: {type: line, wall: u}}\npresets: {long: {a.m: 9}}",
        "'a.m' says how many blocks there are, and a run cannot change it.",
    ),
    "a count inside that is no parameter": (
        INSIDE.replace("parameters: {m: 2}", "parameters: {}")
        + "inputs: [u]\nblocks: {a: {type: line, wall: u, m: 4}}",
        "block 'line.row': the count of a row must be a whole number from 1 to 10000, not m. Write",
    ),
    "a formula for a count inside": (
        INSIDE + "inputs: [u]\nblocks: {a: {type: line, wall: u, m: 2*n}}",
        "'m' is the count of a row, and must be a number or a parameter with one. Write it without",
    ),
}


@pytest.mark.parametrize("case", MESSAGES)
def test_messages(case: str) -> None:
    text, message = MESSAGES[case]
    assert message in refused(text)


def test_edits_of_one_block_of_a_row_are_refused() -> None:
    diagram = made(TOP)
    line = "{type: gain, of: x, k: 0}"
    with pytest.raises(OptionError, match=r"'row_3\.k' belongs to a block of the row 'row', which"):
        set_values(diagram, {"row_3.k": 1.0})
    with pytest.raises(OptionError, match=r"'row_2\.k' belongs to a block of the row 'row', which"):
        set_values(diagram, {"row_2.k": 1.0})
    assert "k: 4}" in set_values(diagram, {"k": 4.0}).text
    text = "blocks:\n  x: {type: integrator, of: previous, replicate: {count: 2, first: {of: f_1}}}"
    sums = made(text + "\n  f: {type: sum, of: [x.all], replicate: 2}")
    with pytest.raises(OptionError, match="block 'f_1' is one of the row 'f', which have one"):
        add_addend(sums, "f_1", "x_1", line)


def test_an_addend_inside_the_subsystem_of_a_row() -> None:
    new = add_addend(made(TOP), "cell.force", "drag", "{type: viscous, rate: v, c: 0}")
    inside = new.blocks["row_2"].subsystem
    assert inside is not None
    assert [wire.signal for wire in inside.blocks["force"].inputs["of"]][-1] == "drag"
    assert "replicate: {count: n" in new.text
