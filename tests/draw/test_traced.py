"""What a picture says of a trace: sensors, what data need at a place, and blocks that stay."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from itertools import combinations
from pathlib import Path

import pytest
from draw.geometry import faults
from draw.random_diagrams import text_of
from tracewire.diagram import Diagram, read, read_text
from tracewire.diagram.edit import add_addend
from tracewire.diagram.edit_sensors import add_sensor
from tracewire.draw import Drawing, Needed, draw
from tracewire.draw.graph import Node, Plot

DIAGRAMS = Path(__file__).parents[2] / "diagrams"
PENDULUM = DIAGRAMS / "lessons" / "pendulum.yaml"
SENSOR = "sensor of theta"
STEP = Needed(
    dots=((-2.0, 0.2), (1.0, -0.25)),
    lines=(((-2.0, 0.2), (0.0, 0.2), (0.0, -0.2), (1.0, -0.2)),),
    words="needed: up to 0.25 over omega",
)

INSIDE = """
blocks:
  rig: {type: body}
  twice: {type: gain, of: rig.v, k: 2}
subsystems:
  body:
    outputs: {v: omega}
    blocks:
      theta: {type: integrator, of: omega, start: 1, unit: rad}
      omega: {type: integrator, of: pull, unit: rad/s}
      pull: {type: gain, of: theta, k: {value: -4, unit: 1/s^2}}
measured:
  run:
    file: run.csv
    time: t
    signals: {rig.theta: {column: a, offset: 0.2}, rig.v: {column: v, offset: 0.1}}
"""


def nodes(drawing: Drawing) -> dict[str, Node]:
    return {node.id: node for node in drawing.graph.nodes}


def late() -> Diagram:
    """The pendulum with a sensor that is late and has an offset."""
    late = add_sensor(read(PENDULUM), "theta", "delay", 0.008)
    return add_sensor(late, "theta", "offset", 0.05)


def test_a_sensor_with_terms_is_a_block_behind_its_signal() -> None:
    drawing = draw(late(), measured=True)
    sensor = nodes(drawing)[SENSOR]
    assert sensor.look.lines == ("offset", "delay")
    assert sensor.details[0] == "the sensor of theta"
    assert "swing: offset = 0.05, delay = 0.008 s" in sensor.details
    assert [w.source for w in drawing.graph.wires if w.target == f"{SENSOR}<"] == ["theta>"]
    place = drawing.layout.nodes
    assert place[SENSOR].x > place["theta"].x
    assert sensor.mark == ""
    assert faults(drawing) == []


def test_wires_that_were_there_cover_what_they_share_with_an_effect() -> None:
    added = add_addend(read(PENDULUM), "acceleration", "extra", "{type: gain, of: omega, k: 1}")
    kinds = re.findall(r'<g class="wire( effect)?"', draw(added, effects=["extra"]).svg)
    assert kinds == [" effect", " effect", *[""] * (len(kinds) - 2)]


def test_a_sensor_without_terms_and_a_plain_picture_have_no_block() -> None:
    assert SENSOR not in nodes(draw(read(PENDULUM), measured=True))
    assert SENSOR not in nodes(draw(late()))


def test_a_term_that_a_trace_added_is_green_at_its_sensor() -> None:
    drawing = draw(late(), measured=True, sensors=["theta"])
    assert nodes(drawing)[SENSOR].mark == "effect"
    assert f'class="block effect" data-block="{SENSOR}" data-type="sensor"' in drawing.svg
    assert drawing.svg.count('class="wire effect"') == 1


def test_a_term_at_a_sensor_inside_of_a_subsystem_is_green_where_one_sees_it() -> None:
    """Closed, the subsystem is green; open, the sensor stands behind its signal inside."""
    closed = nodes(draw(read_text(INSIDE), measured=True, sensors=["rig.theta"]))
    assert closed["rig"].mark == "effect" and closed["twice"].mark == ""
    assert "sensor of rig.theta" not in closed
    drawing = draw(read_text(INSIDE), 1, measured=True, sensors=["rig.theta"])
    frame = nodes(drawing)["rig"]
    inside = {node.id: node for node in frame.nodes}
    assert frame.mark == ""
    assert inside["sensor of rig.theta"].mark == "effect"
    assert inside["rig.theta"].measured and not inside["rig.omega"].measured
    assert nodes(drawing)["sensor of rig.v"].mark == ""
    wire = next(w for w in frame.wires if w.target == "sensor of rig.theta<")
    assert wire.source == "rig.theta>"
    assert faults(drawing) == []


def test_what_is_needed_is_drawn_below_its_sum() -> None:
    drawing = draw(read(PENDULUM), needed={"acceleration": STEP})
    name, block = drawing.layout.names["acceleration"], drawing.layout.nodes["acceleration"]
    assert name.y > block.y and name.height > 60
    assert nodes(drawing)["acceleration"].mark == ""
    root = ET.fromstring(drawing.svg)
    dots = [e for e in root.iter() if e.attrib.get("class") == "need"]
    for dot in dots:
        assert name.x < float(dot.attrib["cx"]) < name.x + name.width
        assert name.y < float(dot.attrib["cy"]) < name.y + name.height
    assert len(dots) == 2
    assert float(dots[0].attrib["cy"]) < float(dots[1].attrib["cy"])  # y upwards
    assert len([e for e in root.iter() if e.attrib.get("class") == "law effect"]) == 1
    assert "needed: up to 0.25 over omega</text>" in drawing.svg
    assert faults(drawing) == []


def test_a_place_where_nothing_explains_what_is_needed_is_amber() -> None:
    lacking = Needed(lines=STEP.lines, words="needed", explained=False)
    drawing = draw(read(PENDULUM), needed={"acceleration": lacking})
    assert nodes(drawing)["acceleration"].mark == "needed"
    assert 'class="law"' in drawing.svg
    assert "classDef needed" in drawing.mermaid
    bare = draw(read(PENDULUM), needed={"acceleration": Needed(explained=False)})
    assert nodes(bare)["acceleration"].mark == "needed"
    assert nodes(bare)["acceleration"].plot is None


@pytest.mark.parametrize(
    ("needed", "plot"),
    [
        (Needed(((-1, 3), (4, -6))), Plot(((-0.25, 0.5), (1, -1)), (), "", 0)),
        (Needed(((2, 1), (4, 2))), Plot(((-1, 0.5), (1, 1)), (), "", None)),
        (Needed(((0, 0), (4, 0))), Plot(((-1, 0), (1, 0)), (), "", -1)),
        (Needed(((2, 5),)), Plot(((0, 1),), (), "", None)),
    ],
)
def test_zero_is_in_the_middle_of_a_plot_where_it_can_be(needed: Needed, plot: Plot) -> None:
    assert needed.plot() == plot


@pytest.mark.parametrize("seed", range(8))
def test_plots_and_sensors_cover_nothing(seed: int) -> None:
    diagram = read_text(text_of(seed))
    needed = dict.fromkeys(list(diagram.blocks)[::3], STEP)
    assert faults(draw(diagram, seed % 2, needed=needed)) == []


def kept_order(before: Drawing, after: Drawing) -> tuple[float, float]:
    """The shares of pairs of blocks that stand left of each other, and above, as before."""

    def middle(drawing: Drawing, id: str) -> tuple[float, float]:
        place = drawing.layout.nodes[id]
        return place.x + place.width / 2, place.y + place.height / 2

    kept, count = [0, 0], [0, 0]
    for one, other in combinations(nodes(before), 2):
        for axis in (0, 1):
            apart = middle(before, one)[axis] - middle(before, other)[axis]
            now = middle(after, one)[axis] - middle(after, other)[axis]
            if abs(apart) > 20:
                count[axis] += 1
                kept[axis] += apart * now > 0 or abs(now) < 20
    return kept[0] / count[0], kept[1] / count[1]


@pytest.mark.parametrize(
    ("file", "where", "of"),
    [
        ("lessons/cart.yaml", "force", "x"),
        ("lessons/pendulum.yaml", "acceleration", "theta"),
        ("papers/a_torsion/pendulum.yaml", "column", "phi1_dot"),
        ("papers/b_triple/pendulum.yaml", "moments", "rates"),
        ("papers/c_review/c26_wave_energy.yaml", "torque", "phi"),
        ("gallery/servo.yaml", "across", "current"),
    ],
)
def test_a_new_block_moves_little(file: str, where: str, of: str) -> None:
    diagram = read(DIAGRAMS / file)
    changed = add_addend(diagram, where, "extra", f"{{type: gain, of: {of}, k: 1}}")
    before = draw(diagram)
    after = draw(changed, like=before)
    across, down = kept_order(before, after)
    assert across == 1
    assert down >= 0.75
    assert faults(after) == []
    assert draw(changed, like=before).svg == after.svg


def test_friction_that_is_added_turns_no_feedback_upwards() -> None:
    diagram = read(PENDULUM)
    added = "{type: coulomb, rate: omega, level: 1}"
    changed = add_addend(diagram, "acceleration", "coulomb", added)
    before = draw(diagram, measured=True)
    after = draw(changed, measured=True, effects=["coulomb"], like=before)
    assert kept_order(before, after)[1] >= 0.9
    place = after.layout.nodes
    assert min(place[name].y for name in ("friction", "coulomb")) > place["acceleration"].y
    assert faults(after) == []


def test_a_picture_like_itself_is_the_same() -> None:
    before = draw(read(PENDULUM))
    assert draw(read(PENDULUM), like=before).layout == before.layout


def test_open_subsystems_keep_their_order_too() -> None:
    torsion = read(DIAGRAMS / "papers" / "a_torsion" / "pendulum.yaml")
    before = draw(torsion, 1)
    again = draw(torsion, 1, like=before)
    assert faults(again) == []
    inner = [id for id in before.layout.nodes if re.match(r"M_L\.", id)]
    assert sorted(inner, key=lambda id: before.layout.nodes[id].y) == sorted(
        inner, key=lambda id: again.layout.nodes[id].y
    )


def test_the_unit_of_a_sensor_follows_from_that_of_its_signal() -> None:
    text = PENDULUM.read_text(encoding="utf-8").replace(
        "theta: {column: theta,", "theta: {column: theta, unit: deg, quad: 2,"
    )
    details = nodes(draw(read_text(text, PENDULUM), measured=True))[SENSOR].details
    assert details[1].startswith("swing: quad = ") and details[1].endswith(" 1/rad")
