from __future__ import annotations

import math
from pathlib import Path

import pytest
from diagram.small_library import LIBRARY, PENDULUM, made
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.diagram import Diagram, Value, difference, find_parameter, read, read_text, write
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_sensors import add_sensor, set_sensors
from tracewire.diagram.edit_values import set_values
from tracewire.errors import DiagramError, OptionError
from tracewire.formula import Number

DRAG = "{type: viscous, rate: omega, c: {value: 1e-5, unit: N m s/rad, fit: [0, 1]}}"


def changes(old: Diagram, new: Diagram) -> tuple[list[str], list[str]]:
    """The lines that went and those that came; every other line is the same, byte for byte."""
    lines = difference(old, new).splitlines()[2:]
    gone = [line[1:] for line in lines if line.startswith("-")]
    come = [line[1:] for line in lines if line.startswith("+")]
    return gone, come


def signals(diagram: Diagram, name: str) -> list[str]:
    return [wire.signal for wire in diagram.blocks[name].inputs["of"]]


def si(value: Value | None) -> float:
    assert value is not None and isinstance(value.formula, Number)
    return value.formula.value * value.factor


def test_an_addend_is_two_lines() -> None:
    old = made(PENDULUM)
    new = add_addend(old, "torque", "drag", DRAG)
    torque = (
        "  torque:  {type: sum, of: [column, bearing.torque, drive%s], place: {q: theta, v: omega}}"
    )
    assert changes(old, new) == ([torque % ""], [torque % ", drag", f"  drag:    {DRAG}"])
    assert signals(new, "torque")[-1] == "drag"
    assert new.blocks["drag"].settings["c"].fit == (0.0, 1.0)
    assert add_addend(old, "torque", "drag", f"drag: {DRAG}\n").text == new.text


@pytest.mark.parametrize(("short", "blank"), [("a:", ""), ("a:    ", "    ")])
def test_a_new_line_is_aligned_where_others_are(short: str, blank: str) -> None:
    text = f"""
blocks:
  {short} {{type: expression, formula: 1}}
  total: {{type: sum, of: [a]}}
"""
    new = add_addend(
        read_text(text, library=LIBRARY), "total", "b", "{type: expression, formula: 2}"
    )
    _, come = changes(read_text(text, library=LIBRARY), new)
    assert f"  b:{blank} {{type: expression, formula: 2}}" in come


def test_an_addend_of_a_list_of_lines_inside_a_subsystem() -> None:
    old = made(PENDULUM)
    line = "{type: viscous, rate: rate, c: 0}"
    new = add_addend(old, "journal_bearing.total", "drag", line)
    assert changes(old, new) == ([], ["          - drag", f"      drag: {line}"])
    assert "          - friction   # dry\n          - drag\n      drag:" in new.text


GAIN = "b: {type: gain, of: i, k: 1}"
STATE = "i: {type: integrator, of: s}"
LAYOUTS = [
    f"blocks: {{{STATE}, s: {{type: sum, of: %s}}, {GAIN}}}",
    f"blocks:\n  {STATE}\n  s: {{type: sum, of: %s}}  # c\n  {GAIN}",
    f"blocks:\n    {STATE}\n    {GAIN}\n    s:\n        type: sum\n        of: %s",
]
LISTS = {
    "i": ["i"],
    "'i'": ["i"],
    "-i.y": ["i.y"],
    "[]": [],
    "[i]": ["i"],
    "[i, ]": ["i"],
    "[ i, b ]": ["i", "b"],
    "[b, i, b]": ["b", "i", "b"],
    "[-b,\n          i   # the second\n          ]": ["b", "i"],
    "[b, # one, and\n          i]": ["b", "i"],
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("given", LISTS)
@pytest.mark.parametrize("ending", ["", "\n", "\r\n"])
def test_every_layout_of_a_sum_can_be_added_to(layout: str, given: str, ending: str) -> None:
    old = made((layout % given).replace("\n", ending or "\n") + ending)
    new = add_addend(old, "s", "drag", "{type: viscous, rate: i, c: 1}")
    assert signals(new, "s") == [*LISTS[given], "drag"]
    assert ("\r\n" in new.text) == ("\r\n" in old.text)
    assert "\n" not in new.text.replace("\r\n", "") or "\r\n" not in old.text
    assert [c for c in ("# c", "# the second", "# one, and") if c in old.text] == [
        c for c in ("# c", "# the second", "# one, and") if c in new.text
    ]


def test_values_are_written_in_the_users_unit() -> None:
    text = """\
parameters:
  a: {value: 90, unit: deg, fit: [0, 180]}   # an angle
  b: 2
  c: a/2
blocks: {d: {type: viscous, rate: d, c: {unit: N m s/rad, value: '1'}}}
""".replace("rate: d,", "rate: i,").replace("{d: {", "{i: {type: integrator, of: d}, d: {")
    old = made(text)
    new = set_values(old, {"a": math.pi / 4, "b": 1 / 3, "c": 1e-7, "d.c": 20})
    assert "  a: {value: 45, unit: deg, fit: [0, 180]}   # an angle\n" in new.text
    assert "  b: 0.333333\n  c: 1e-07\n" in new.text
    assert "c: {unit: N m s/rad, value: 20}" in new.text
    assert changes(old, set_values(old, {"b": 3}))[1] == ["  b: 3"]
    assert set_values(old, {}).text == old.text


def test_a_number_in_the_place_of_a_formula_is_in_the_unit_that_stands_there() -> None:
    """A formula is in SI whatever its unit, and a number is not."""
    text = "parameters: {k: 1, c: {value: 2*k, unit: mm}}\n"
    text += "blocks: {x: {type: integrator, of: x, start: {value: c, unit: mm}}}\n"
    changed = set_values(made(text), {"c": 0.004, "x.start": 0.005})
    assert changed.text == text.replace("2*k", "4").replace("value: c", "value: 5")


def test_a_value_in_a_list_is_set_where_it_stands() -> None:
    text = "blocks: {x: {type: integrator, of: x, start: [1, {value: 20, unit: deg}, 3]}}\n"
    diagram = made(text)
    assert find_parameter(diagram, "x.start[0]") is None
    assert find_parameter(diagram, "x.start[1,1]") is None
    changed = set_values(diagram, {"x.start[1]": math.radians(35)})
    assert changed.text == text.replace("20", "35")


@settings(deadline=None)
@given(st.floats(1e-3, 1e-2))
def test_a_value_within_its_bounds_stays_within_them(value: float) -> None:
    new = set_values(made(PENDULUM), {"stiffness": value})
    assert si(new.parameters["stiffness"]) == pytest.approx(value, rel=1e-5)


def test_a_value_outside_of_its_bounds_is_refused() -> None:
    with pytest.raises(DiagramError, match="outside of its bounds"):
        set_values(made(PENDULUM), {"stiffness": 1.0})
    with pytest.raises(OptionError, match="parameter 'stiffness' cannot become nan"):
        set_values(made(PENDULUM), {"stiffness": math.nan})


def test_a_bound_is_not_crossed_by_rounding() -> None:
    old = made("parameters: {a: {value: 0.1, fit: [0, 0.12345678]}}\nblocks: {}")
    assert "value: 0.12345678," in set_values(old, {"a": 0.12345678}).text
    assert (
        "value: 0.123457," in set_values(made(old.text.replace("678", "9")), {"a": 0.1234567}).text
    )


SHARED = """\
blocks:
  one: {type: tilted, angle: 5}
  two: {type: tilted, angle: tilt}
  three: {type: tilted}   # as it is
  four:
    type: tilted
  only: {type: single}
parameters: {tilt: 1}
subsystems:
  tilted:
    outputs: {y: e}
    parameters: {angle: {value: 10, unit: deg, fit: [0, 90]}}
    blocks: {e: {type: expression, formula: angle}, d: {type: viscous, rate: e, c: {value: 1}}}
  single:
    parameters: {c: {value: 1}}
    blocks: {a: {type: tilted}, d: {type: viscous, rate: a, c: {value: 1}}}
"""


def test_a_parameter_of_a_shared_subsystem_is_set_on_its_use() -> None:
    old = made(SHARED)
    half = math.pi / 6
    new = set_values(old, {f"{name}.angle": half for name in ("one", "two", "three", "four")})
    assert "  one: {type: tilted, angle: 30}\n" in new.text
    assert "  two: {type: tilted, angle: 30}\n" in new.text
    copy = "{value: 30, unit: deg, fit: [0, 90]}"
    assert f"  three: {{type: tilted, angle: {copy}}}   # as it is\n" in new.text
    assert f"    type: tilted\n    angle: {copy}\n" in new.text
    for name in ("one", "two", "three", "four"):
        assert si(find_parameter(new, f"{name}.angle")) == pytest.approx(half)
    assert new.subsystems == made(new.text).subsystems
    assert si(new.subsystems["tilted"].parameters["angle"]) == pytest.approx(math.pi / 18)


def test_a_parameter_of_a_subsystem_that_is_used_once_is_set_in_its_definition() -> None:
    old = made(SHARED)
    new = set_values(old, {"only.c": 2, "only.d.c": 3})
    assert "    parameters: {c: {value: 2}}\n" in new.text
    assert "c: {value: 3}" in new.text
    new = set_values(old, {"only.a.angle": math.pi / 3})
    assert "a: {type: tilted, angle: {value: 60, unit: deg, fit: [0, 90]}}," in new.text


def test_a_setting_inside_a_shared_subsystem_is_not_set() -> None:
    with pytest.raises(
        OptionError, match=r"stands in 'tilted', which several blocks are\. Make it"
    ):
        set_values(made(SHARED), {"one.d.c": 3})


def test_names_that_do_not_exist_are_refused() -> None:
    old = made(PENDULUM)
    with pytest.raises(
        OptionError, match=r"unknown parameter 'stifness'.*Did you mean 'stiffness'"
    ):
        set_values(old, {"stifness": 1})
    with pytest.raises(OptionError, match=r"unknown block 'torq'.*Did you mean 'torque'"):
        add_addend(old, "torq", "a", "{}")
    with pytest.raises(OptionError, match=r"unknown subsystem 'bearing'.*'journal_bearing'"):
        add_addend(old, "bearing.total", "a", "{}")
    with pytest.raises(OptionError, match="'column' is a gain, and has no input for several"):
        add_addend(old, "column", "a", "{}")
    with pytest.raises(DiagramError, match="two definitions of 'theta'"):
        add_addend(old, "torque", "theta", DRAG)
    with pytest.raises(DiagramError, match="unknown block type 'vicous'"):
        add_addend(old, "torque", "drag", DRAG.replace("viscous", "vicous"))


def test_a_nested_definition_may_be_named_in_short_where_it_is_clear() -> None:
    text = """
blocks: {a: {type: outer}}
subsystems:
  outer:
    blocks: {b: {type: inner}}
    subsystems: {inner: {blocks: {s: {type: sum, of: []}}}}
"""
    line = "{type: viscous, rate: s, c: 0}".replace("rate: s", "rate: i")
    text = text.replace("of: []}", "of: []}, i: {type: integrator, of: s}")
    assert add_addend(made(text), "inner.s", "d", line) == add_addend(
        made(text), "outer.inner.s", "d", line
    )
    twice = text + text[text.index("  outer:") :].replace("outer", "other")
    with pytest.raises(
        OptionError, match=r"may mean several blocks; there are: outer[.]inner[.]s,"
    ):
        add_addend(made(twice), "inner.s", "d", line)


def test_an_explicit_key_is_not_edited() -> None:
    text = "blocks:\n  ? s\n  : {type: sum, of: []}\n  i: {type: integrator, of: s}\n"
    with pytest.raises(DiagramError, match="laid out here in a way that cannot be edited"):
        add_addend(made(text), "s", "d", "{type: viscous, rate: i, c: 0}")


SERIES = """\
blocks: {theta: {type: integrator, of: theta}}
measured:
  one: {file: run.csv, time: t, signals: {theta: angle}}   # first
  two: {file: run.csv, time: t, use: gate, signals: {theta: {column: angle, unit: deg}}}
  three:
    file: run.csv
    time: t
    use: validate
    signals:
      theta.y:
        column: angle   # of the disc
        offset: {value: 3, fit: free}
"""


def test_an_offset_is_added_to_each_series(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("")
    old = made(SERIES, tmp_path / "d.yaml")
    new = add_sensor(old, "theta", "offset", math.pi / 180, (-math.pi / 18, math.pi / 18))
    assert "signals: {theta: {column: angle, offset: {value: 0.0174533, fit: [" in new.text
    assert "{column: angle, unit: deg, offset: {value: 1, fit: [-10, 10]}}}}\n" in new.text
    assert "        column: angle   # of the disc\n        offset: {value: 0.0174533, fit: [" in (
        new.text
    )
    for series in new.measured.values():
        offset = series.channels["theta"].offset
        assert si(offset) == pytest.approx(math.pi / 180, rel=1e-5)
        assert offset.fit == pytest.approx((-math.pi / 18, math.pi / 18))
    assert (
        "fit"
        not in add_sensor(old, "theta", "offset", 0.1)
        .text.partition("one:")[2]
        .partition("two:")[0]
    )
    assert (
        "offset: {value: 0, fit: free}"
        in add_sensor(old, "theta", "offset", 0, (-math.inf, math.inf)).text
    )
    assert ", fit: [0, inf]}" in add_sensor(old, "theta", "offset", 0.1, (0, math.inf)).text
    with pytest.raises(OptionError, match="unknown measured signal 'omega'; there are: theta"):
        add_sensor(old, "omega", "offset", 0.1)


def test_numbers_of_sensors_are_added_in_the_unit_of_the_column(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("")
    old = made(SERIES, tmp_path / "d.yaml")
    new = old
    for kind, value in {"gain": 1.02, "delay": 0.004, "quad": 0.5, "drift": 0.01}.items():
        new = add_sensor(new, "theta", kind, value, (0, 2 * value))
        for series in new.measured.values():
            added = getattr(series.channels["theta"], kind)
            assert si(added) == pytest.approx(value, rel=1e-5)
            assert added.fit == pytest.approx((0, 2 * value))
    assert "delay: {value: 0.004, fit: [0, 0.008]}" in new.text
    assert "drift: {value: 0.572958, fit: [0, 1.145" in new.text  # deg/s
    changed = set_sensors(new, {"quad.theta": 0.6, "drift.theta": 0.015})
    for series in changed.measured.values():
        assert si(series.channels["theta"].quad) == pytest.approx(0.6, rel=1e-5)
        assert si(series.channels["theta"].drift) == pytest.approx(0.015, rel=1e-5)
    with pytest.raises(OptionError, match="unknown number of a sensor 'quat'; there are: "):
        add_sensor(old, "theta", "quat", 1.0)


def test_write_leaves_other_files_alone(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    text = PENDULUM.replace("\n", "\r\n")
    diagram = read_text(text, file, library=LIBRARY)
    assert write(diagram, file) == file
    assert file.read_bytes() == text.encode()
    write(set_values(diagram, {"stiffness": 2e-3}), str(file))
    assert b"value: 0.002," in file.read_bytes()
    other = tmp_path / "b.yaml"
    other.write_text("mine")
    with pytest.raises(OptionError, match="there is a file of this name"):
        write(diagram, other)
    assert other.read_text() == "mine"
    write(diagram, other, overwrite=True)
    assert other.read_bytes() == text.encode()
    with pytest.raises(OptionError, match="cannot be written"):
        write(diagram, tmp_path / "nowhere" / "c.yaml")


def test_in_another_folder_measured_files_have_the_path_from_there(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("")
    (tmp_path / "sub").mkdir()
    diagram = made(SERIES, tmp_path / "d.yaml")
    moved = write(diagram, tmp_path / "sub" / "d.yaml")
    assert "file: ../run.csv" in moved.read_text()
    series = read(moved).measured["one"]
    assert series.file.samefile(tmp_path / "run.csv")
    assert write(diagram, tmp_path / "e.yaml").read_text() == diagram.text


def test_in_another_folder_an_included_diagram_must_be_found(tmp_path: Path) -> None:
    (tmp_path / "parts.yaml").write_text("title: Parts\n")
    (tmp_path / "sub").mkdir()
    diagram = made("include: parts.yaml\n" + PENDULUM, tmp_path / "d.yaml")
    with pytest.raises(DiagramError, match=r"parts\.yaml"):
        write(diagram, tmp_path / "sub" / "d.yaml")
    assert not (tmp_path / "sub" / "d.yaml").exists()


def test_equal_texts_do_not_differ() -> None:
    assert difference(made(PENDULUM), made(PENDULUM)) == ""
