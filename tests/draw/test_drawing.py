"""What a picture shows: shapes, signs, feedback, subsystems, words on wires, mistakes, effects."""

from __future__ import annotations

import hashlib
import json
import xml.etree.ElementTree as ET
from base64 import b64encode
from itertools import pairwise
from pathlib import Path
from threading import Thread

import pytest
import tracewire as tw
from draw.geometry import faults
from draw.random_diagrams import LIBRARY, text_of
from tracewire.diagram import BlockUse, read, read_readable, read_text
from tracewire.draw import Drawing, draw
from tracewire.draw.curves import curve_of
from tracewire.draw.graph import Node
from tracewire.draw.layout import all_nodes, all_wires
from tracewire.draw.shapes import Drawn, shape_of, subsystem_look
from tracewire.elk import engine
from tracewire.errors import InstallationError, OptionError
from tracewire.npm import integrity

ROOT = Path(__file__).parents[2]
DIAGRAMS = ROOT / "diagrams"
PENDULUM = DIAGRAMS / "lessons" / "pendulum.yaml"
TORSION = DIAGRAMS / "papers" / "a_torsion" / "pendulum.yaml"
SVG = "{http://www.w3.org/2000/svg}"


def node(drawing: Drawing, id: str) -> Node:
    return next(node for node in all_nodes(drawing.graph) if node.id == id)


def groups(drawing: Drawing) -> dict[str, ET.Element]:
    """The group of each block, by its full name."""
    found = ET.fromstring(drawing.svg).iter(f"{SVG}g")
    return {group.attrib["data-block"]: group for group in found if "data-block" in group.attrib}


def texts(group: ET.Element) -> list[str]:
    return [text.text or "" for text in group.iter(f"{SVG}text")]


def test_every_block_has_a_group_with_its_name_and_a_tooltip() -> None:
    drawn = groups(draw(read(PENDULUM)))
    assert set(drawn) == {"theta", "omega", "height", "gravity", "friction", "acceleration"}
    assert texts(drawn["omega"]) == ["1", "s", "omega"]
    assert texts(drawn["gravity"]) == ["-w0_squared", "gravity"]
    tooltip = drawn["friction"].findtext(f"{SVG}title")
    assert tooltip is not None
    assert tooltip.splitlines() == [
        "friction: viscous", "Friction in proportion to the rate.", "c = c",
    ]  # fmt: skip


def test_the_same_diagram_gives_the_same_picture() -> None:
    first, again = (draw(read(TORSION), 1, units=True) for _ in range(2))
    assert first.svg == again.svg
    assert first.png == again.png
    assert first.mermaid == again.mermaid


def test_a_changed_number_moves_nothing() -> None:
    text = PENDULUM.read_text(encoding="utf-8")
    before = draw(read_text(text, PENDULUM)).layout
    assert draw(read_text(text.replace("0.05", "0.07"), PENDULUM)).layout == before


def test_the_way_forward_goes_right_and_feedback_goes_back_below() -> None:
    drawing = draw(read(PENDULUM))
    place = drawing.layout.nodes
    assert place["acceleration"].x < place["omega"].x < place["theta"].x
    assert {n.id for n in drawing.graph.nodes if n.flipped} == {"friction", "height", "gravity"}
    assert place["gravity"].x < place["height"].x < place["theta"].x
    assert min(place[id].y for id in ("friction", "gravity")) > place["acceleration"].y


def test_an_open_subsystem_in_a_feedback_leads_back() -> None:
    drawing = draw(read(TORSION), 1)
    place = drawing.layout.nodes
    plate = node(drawing, "M_T")
    assert plate.flipped and {inner.id for inner in plate.nodes if inner.flipped} == {
        "M_T.friction",
        "M_T.total",
    }
    assert place["M_T.total"].x < place["M_T.friction"].x < place["phi2_dot"].x
    (forward,) = (wire for wire in plate.wires if wire.target.startswith("M_T.total"))
    line = drawing.layout.wires[forward.id]
    assert line[-1][0] < line[0][0]
    closed = draw(read(TORSION))
    assert {n.id for n in drawing.graph.nodes if n.flipped} == {
        n.id for n in closed.graph.nodes if n.flipped
    }


def test_the_double_torsion_pendulum_looks_as_in_the_paper() -> None:
    """Fig 12: two lines from a sum to two integrators, friction and barriers in their feedback."""
    drawing = draw(read(TORSION))
    x = {id: place.x for id, place in drawing.layout.nodes.items()}
    assert x["f_e"] < x["slack"] < x["f_s"] < x["column"] < x["phi1_ddot"] < x["phi1_dot"]
    assert x["phi1_dot"] < x["phi1"]
    assert x["contact"] < x["disk"] < x["phi2_ddot"] < x["phi2_dot"] < x["phi2"]
    back = {node.id for node in drawing.graph.nodes if node.flipped}
    assert back == {"M_L", "M_T", "pin", "springs", "printed"}
    signs = sorted(port.text for port in node(drawing, "column").ports if port.side == "west")
    assert signs == ["+", "+", "−", "−", "−"]


def test_a_subsystem_opens_and_shows_what_is_inside() -> None:
    closed, opened = (draw(read(TORSION), depth) for depth in (0, 1))
    assert "M_T.friction" not in groups(closed)
    assert {"M_T", "M_T.friction", "M_T.total"} <= set(groups(opened))
    assert "plate" in texts(groups(opened)["M_T"])
    inside = node(opened, "M_T")
    assert ("M_T<rate", "M_T.friction<rate") in [(w.source, w.target) for w in inside.wires]
    assert ("M_T.total>", "M_T>torque") in [(w.source, w.target) for w in inside.wires]
    assert len(list(all_wires(opened.graph))) > len(closed.graph.wires)


THROUGH = """\
blocks:
  x: {type: integrator, of: part.turned}
  part: {type: part, a: x}
  y: {type: gain, of: part.same, k: 1}
subsystems:
  part:
    inputs: [a]
    outputs: {turned: -b, same: a}
    blocks: {b: {type: sin, of: a}}
"""


def test_an_input_that_goes_through_a_frame_stays_inside_of_it() -> None:
    drawing = draw(read_text(THROUGH), 1)
    frame = drawing.layout.nodes["part"]
    inner = node(drawing, "part").wires
    assert {wire.source for wire in inner} >= {"part<a", "part.b>"}
    for wire in inner:
        for x, y in drawing.layout.wires[wire.id]:
            assert frame.x <= x <= frame.x + frame.width
            assert frame.y <= y <= frame.y + frame.height
    assert faults(drawing) == []


IN_FORMULAS = """\
subsystems:
  pair:
    inputs: [q]
    outputs: {p: deep.p, r: outflow}
    subsystems:
      tank:
        inputs: [q]
        outputs: {p: p}
        blocks: {p: {type: integrator, of: q}}
    blocks:
      deep: {type: tank, q: q}
      outflow: {type: expression, formula: 2*deep.p}
parameters: {ps: 3}
blocks:
  T: {type: pair, q: dp}
  dp: {type: expression, formula: "(ps - T.p if T.r > 0 else 0) - body.v - low.y + T.r"}
  low: {type: gain, of: dp, k: 2}
  body: {type: hard_stop, force: dp, high: 1, mass: 1}
  row: {type: expression, formula: [T.p, 2*T.r]}
"""


def test_outputs_of_subsystems_in_a_formula_have_wires() -> None:
    drawing = draw(read_text(IN_FORMULAS), 1)
    wires = {(wire.source, wire.target.partition("<")[0]) for wire in all_wires(drawing.graph)}
    assert {pair for pair in wires if pair[1] == "dp"} == {
        ("T>p", "dp"), ("T>r", "dp"), ("body>v", "dp"), ("low>", "dp"),
    }  # fmt: skip
    assert ("T.deep>p", "T.outflow") in wires
    assert {("T>p", "row"), ("T>r", "row")} <= wires


def test_an_output_that_turns_a_sign_shows_that_where_it_is_open() -> None:
    closed, opened = (texts(groups(draw(read_text(THROUGH), depth))["part"]) for depth in (0, 1))
    assert "turned" in closed and "−turned" not in closed
    assert "−turned" in opened and "same" in opened


def test_a_long_title_of_a_subsystem_has_two_lines_where_it_is_closed() -> None:
    tank = read(DIAGRAMS / "gallery" / "tank.yaml")
    closed, opened = (node(draw(tank, depth), "tank").look for depth in (0, 1))
    assert closed.lines == ("Tank that runs out", "through a hole")
    assert opened.lines == ("Tank that runs out through a hole",)
    assert closed.width < opened.width
    assert node(draw(read(TORSION)), "M_T").look.lines == ("plate",)
    one_word = "x" * 60
    assert subsystem_look(one_word, 1, (0, 0)).lines[0].endswith("…")


@pytest.mark.parametrize(
    ("names", "units", "wanted"),
    [(True, False, "omega"), (False, True, "[rad/s]"), (True, True, "omega [rad/s]")],
)
def test_names_and_units_stand_on_wires_on_demand(names: bool, units: bool, wanted: str) -> None:
    plain, worded = draw(read(PENDULUM)), draw(read(PENDULUM), names=names, units=units)
    assert plain.layout.labels == {}
    assert worded.layout.labels["omega>"][0] == wanted
    assert f">{wanted}</text>" in worded.svg


def test_measured_signals_are_marked_on_demand() -> None:
    assert "measured" in groups(draw(read(PENDULUM), measured=True))["theta"].attrib["class"]
    assert 'class="block measured"' not in draw(read(PENDULUM)).svg


def test_an_effect_is_drawn_in_colour() -> None:
    drawing = draw(read(PENDULUM), effects=["friction"])
    assert groups(drawing)["friction"].attrib["class"] == "block effect"
    coloured = [g for g in ET.fromstring(drawing.svg).iter(f"{SVG}g")
                if g.attrib.get("class") == "wire effect"]  # fmt: skip
    assert {g.attrib["data-signal"] for g in coloured} == {"omega", "friction"}


def test_text_of_a_diagram_is_never_markup() -> None:
    evil = "<script>alert(1)</script>\"'&]]>\u0007"
    diagram = read(PENDULUM)
    block = diagram.blocks["friction"]
    name = f'x" onload="alert(1)" y="{evil}'
    renamed = BlockUse(name, block.type, block.inputs, block.settings)
    changed = tw.Diagram(
        diagram.name, diagram.file, diagram.text, diagram.library, title=evil,
        blocks={**diagram.blocks, name: renamed},
    )  # fmt: skip
    drawing = draw(changed, names=True)
    root = ET.fromstring(drawing.svg)
    assert not list(root.iter(f"{SVG}script"))
    assert not [e for e in root.iter() if any(key.startswith("on") for key in e.attrib)]
    assert root.findtext(f"{SVG}title") == evil.replace("\u0007", "�")
    assert not set("<>\"'&") & set(drawing.mermaid.splitlines()[1])
    assert "<script" not in drawing.mermaid


@pytest.mark.parametrize("seed", range(6))
def test_svg_is_well_formed_and_png_is_twice_as_large(seed: int) -> None:
    drawing = draw(read_text(text_of(seed)), 1)
    root = ET.fromstring(drawing.svg)
    assert drawing.png.startswith(b"\x89PNG\r\n\x1a\n")
    wide = int.from_bytes(drawing.png[16:20], "big")
    assert wide == pytest.approx(2 * float(root.attrib["width"]), abs=2)


def test_mistakes_are_red_at_their_place(tmp_path: Path) -> None:
    file = tmp_path / "wrong.yaml"
    file.write_text(
        "blocks:\n  x: {type: integrator, of: rate}\n  a: {type: gain, of: z, k: 1}\n"
        "  rate: {type: sum, of: [a, -b]}\n  b: {type: viscuos, rate: x}\n",
        encoding="utf-8",
    )
    diagram, problems = read_readable(file)
    drawing = draw(diagram, problems=problems)
    marks = {node.id: node.mark for node in drawing.graph.nodes}
    assert marks == {"x": "", "a": "wrong", "rate": "", "b": "wrong", "?z": "wrong"}
    assert "z?" in texts(groups(drawing)["?z"])
    assert drawing.svg.count('class="small mistake"') == 2
    assert "✗ wrong.yaml:3:23: block 'a': unknown signal 'z'" in drawing.svg


@pytest.mark.parametrize("name", ["unknown_block", "unknown_parameter", "unconnected_input"])
def test_a_broken_diagram_is_drawn_as_far_as_it_can_be_read(name: str) -> None:
    diagram, problems = read_readable(ROOT / "tests" / "diagram" / "broken" / f"{name}.yaml")
    assert problems
    assert "mistake" in draw(diagram, 3, problems=problems).svg


@pytest.mark.parametrize("name", ["alias_bomb", "empty", "not_yaml"])
def test_what_cannot_be_read_is_told(name: str) -> None:
    with pytest.raises(tw.TracewireError):
        read_readable(ROOT / "tests" / "diagram" / "broken" / f"{name}.yaml")


def test_events_are_marked_and_noted() -> None:
    diagram = read(DIAGRAMS / "papers" / "a_torsion" / "s5_restitution.yaml")
    drawing = draw(diagram)
    marked = {node.id for node in drawing.graph.nodes if node.has_event}
    assert marked == {"phi1_dot", "phi2_dot"}
    assert drawing.graph.notes[0].startswith("when phi1 - phi1_s rises through 0: phi1_dot := ")


def test_the_curve_of_a_block_is_its_own_formula() -> None:
    (line,) = curve_of(LIBRARY["coulomb"], {"level": 2.0, "width": 0.0})
    assert line[0] == (-1.0, 1.0)
    assert line[-1] == (1.0, -1.0)
    assert (0.0, 1.0) in line  # upright, where it jumps
    assert (0.0, -1.0) in line
    (line,) = curve_of(LIBRARY["barrier"], {"k": 3.0, "gap": 0.01})
    flat = [x for x, y in line if y == 0.0]
    assert len(flat) > 3
    assert 0 < max(flat) < 1
    (line,) = curve_of(LIBRARY["saturation"], {"low": -100.0, "high": 100.0})
    assert max(abs(b[1] - a[1]) for a, b in pairwise(line)) < 0.2  # a ramp, and no jump
    assert line[0][1] == -1.0 and [y for _, y in line].count(1.0) > 4
    (line,) = curve_of(LIBRARY["stiffness"], {"k": 5.0})
    assert all(y == pytest.approx(-x) for x, y in line)


def test_a_table_is_drawn_by_its_points() -> None:
    text = "blocks:\n  y: {type: table, points: [[-2, 0], [0, 0], [2, -4], [4, 8]]}\n"
    look = node(draw(read_text(text)), "y").look
    assert look.curve == (((-0.5, 0.0), (0.0, 0.0), (0.5, -0.5), (1.0, 1.0)),)
    flat = "blocks:\n  y: {type: table, points: [[0, 0], [1, 0]]}\n"
    assert node(draw(read_text(flat)), "y").look.lines == ("table",)


@pytest.mark.parametrize("name", ["hysteresis", "relay", "demux", "collision", "sine"])
def test_a_block_with_memory_or_without_a_number_has_no_curve(name: str) -> None:
    assert curve_of(LIBRARY[name], {}) == ()


@pytest.mark.parametrize("name", sorted(LIBRARY))
def test_every_block_of_the_library_has_a_shape(name: str) -> None:
    look = shape_of(Drawn(name, {}, {}, 1, LIBRARY[name]))
    assert min(look.width, look.height) > 0
    assert look.lines or look.curve or look.outline in ("circle", "bar")


def test_a_notebook_shows_a_diagram() -> None:
    diagram = read(PENDULUM)
    assert diagram._repr_svg_() == draw(diagram).svg == draw(diagram)._repr_svg_()


def test_mermaid_has_every_block_and_wire() -> None:
    drawing = draw(read(TORSION), 1)
    lines = [line.strip() for line in drawing.mermaid.splitlines()]
    assert lines[0] == "flowchart LR"
    assert sum("-->" in line for line in lines) == len(list(all_wires(drawing.graph)))
    assert sum(line.startswith("subgraph") for line in lines) == lines.count("end") == 4
    assert any(line.endswith('<br>phi1_dot"]') for line in lines)


def test_files_are_written_by_their_ending(tmp_path: Path) -> None:
    drawing = draw(read(PENDULUM))
    for ending, begin in ((".svg", b"<svg "), (".png", b"\x89PNG"), (".mmd", b"flowchart")):
        assert drawing.write(tmp_path / f"a{ending}").read_bytes().startswith(begin)


def test_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"unknown file ending '.gif'.*End it in \.svg"):
        draw(read(PENDULUM)).write(tmp_path / "a.gif")


def test_a_depth_below_zero_is_refused() -> None:
    with pytest.raises(OptionError, match="the depth of a picture cannot be -1"):
        draw(read(PENDULUM), -1)


def test_a_chain_of_many_blocks_is_drawn() -> None:
    chain = "".join(f"  b{n + 1}: {{type: gain, of: b{n}, k: 1}}\n" for n in range(150))
    drawing = draw(read_text("blocks:\n  b0: {type: time}\n" + chain))
    x = [drawing.layout.nodes[f"b{n}"].x for n in range(151)]
    assert x == sorted(x)


def test_the_layout_engine_is_the_one_of_the_lock_file() -> None:
    lock = json.loads((engine.SCRIPT.parent / "elk.lock.json").read_text(encoding="utf-8"))
    assert integrity(engine.SCRIPT.read_bytes()) == lock["script"]
    digest = b64encode(hashlib.sha512(b"").digest()).decode()
    assert integrity(b"") == f"sha512-{digest}"


def test_each_function_that_is_made_quicker_is_in_the_layout_engine() -> None:
    """A new version has other names; without these functions pictures take longer."""
    script = engine.SCRIPT.read_text(encoding="utf-8")
    assert [script.count(slow) for slow in engine.QUICKER] == [1] * len(engine.QUICKER)


def test_quicker_functions_change_no_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    quick = draw(read(PENDULUM)).layout
    monkeypatch.setattr(engine, "QUICKER", {})
    engine._context.cache_clear()
    try:
        assert draw(read(PENDULUM)).layout == quick
    finally:
        engine._context.cache_clear()


def test_the_engine_starts_while_other_work_goes_on() -> None:
    engine._context.cache_clear()
    engine.start()
    assert draw(read(PENDULUM)).svg
    assert engine._context.cache_info().misses == 1


def test_a_start_that_fails_is_told_by_the_picture(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(engine, "SCRIPT", tmp_path / "elk.bundled.js")
    engine._context.cache_clear()
    try:
        engine.start()
        with pytest.raises(InstallationError, match="the layout engine cannot be read"):
            draw(read(PENDULUM))
    finally:
        engine._context.cache_clear()


def test_an_interrupted_picture_leaves_its_engine_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """The thread of a picture that nobody awaits may go on for a while."""
    before = engine._context()

    def interrupted(self: Thread) -> None:
        Thread.join(self)
        raise KeyboardInterrupt

    monkeypatch.setattr(engine, "Thread", type("Interrupted", (Thread,), {"join": interrupted}))
    with pytest.raises(KeyboardInterrupt):
        draw(read(PENDULUM))
    monkeypatch.undo()
    assert draw(read(PENDULUM)).svg
    assert engine._context() is not before


def test_a_missing_layout_engine_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(engine, "SCRIPT", tmp_path / "elk.bundled.js")
    engine._context.cache_clear()
    try:
        with pytest.raises(InstallationError, match="the layout engine cannot be read"):
            draw(read(PENDULUM))
    finally:
        engine._context.cache_clear()


def test_the_wires_among_which_a_block_selects_have_numbers() -> None:
    drawing = draw(read(DIAGRAMS / "gallery" / "barrier.yaml"))
    ports = [port.text for port in node(drawing, "shown").ports if port.side == "west"]
    assert ports == ["index", "0", "1"]
    assert [port.text for port in node(drawing, "refused").ports if port.side == "west"] == ["", ""]
