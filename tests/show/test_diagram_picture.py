"""The picture with which the report of a trace opens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from show.traces import ADDED, FOUND, NULL, UNEXPLAINED, missing_of_two
from tracewire.diagram import read_text
from tracewire.draw import Drawing, draw
from tracewire.draw.graph import Node
from tracewire.draw.layout import all_nodes
from tracewire.show import draw_trace
from tracewire.show.diagram_picture import traced_figure
from tracewire.trace import Force, Found, FoundEffect, Missing


def node(drawing: Drawing, id: str) -> Node:
    return next(node for node in all_nodes(drawing.graph) if node.id == id)


def test_an_effect_is_green_and_what_the_data_need_is_below_its_sum() -> None:
    drawing = draw_trace(FOUND)
    assert node(drawing, "coulomb").mark == "effect"
    torque = node(drawing, "torque")
    assert torque.mark == ""
    plot = torque.plot
    assert plot is not None
    assert plot.words.startswith("needed: up to 0.2") and plot.words.endswith(" N m over omega")
    (law,) = plot.lines
    assert len(plot.dots) > 10 and 10 < len(law) <= 80
    # the force of dry friction: against the rate, and half of its height beside zero already
    assert all(x * y < 0 for x, y in plot.dots if abs(x) > 0.2)
    assert max(abs(y) for x, y in law) > 0.5


def test_blocks_stand_as_in_the_picture_of_the_diagram() -> None:
    before, after = draw(FOUND.original, measured=True), draw_trace(FOUND)
    for one in before.layout.nodes:
        for other in before.layout.nodes:
            if before.layout.nodes[one].x < before.layout.nodes[other].x:
                assert after.layout.nodes[one].x < after.layout.nodes[other].x


def test_the_caption_tells_the_marks_that_are_there() -> None:
    plain = "The blocks and wires of the diagram; blue names are measured"
    added = f"{plain}, green is what the trace added"
    plot = "and the plot below a sum is what the data need there"
    assert traced_figure(FOUND).caption == f"{added}, {plot}"
    lacking = "amber is where something is missing that no effect explains"
    both = replace(FOUND, missing=UNEXPLAINED.missing)
    assert traced_figure(both).caption == f"{added}, {lacking}, {plot}"
    sensor = replace(sensed(), effects=sensed().effects[-1:])
    assert traced_figure(sensor).caption == f"{plain}, and green is what the trace added"
    assert traced_figure(NULL).caption == plain


def test_a_number_of_hundreds_is_written_out() -> None:
    missing = UNEXPLAINED.missing
    assert missing is not None
    large = replace(missing, torque=missing.torque * 3255)
    plot = node(draw_trace(replace(UNEXPLAINED, missing=large)), "torque").plot
    assert plot is not None
    assert plot.words == "needed: up to 650 N m over theta"


def test_refused_effects_are_not_drawn() -> None:
    found = replace(FOUND, find_diagram=lambda effects: FOUND.diagram)
    refused = draw_trace(found, [])
    assert "coulomb" not in {node.id for node in all_nodes(refused.graph)}
    assert node(refused, "torque").plot is None


def test_a_place_that_nothing_explains_is_amber_with_what_is_missing() -> None:
    torque = node(draw_trace(UNEXPLAINED), "torque")
    assert torque.mark == "needed"
    assert torque.plot is not None
    assert torque.plot.words == "needed: up to 0.2 N m over theta"
    assert torque.plot.dots == ()
    (line,) = torque.plot.lines
    waves = np.sign([y for _, y in line])
    assert 6 <= np.sum(np.diff(waves) != 0) <= 9  # sin(12 q) over q from -1 to 1


def test_a_force_over_two_variables_is_drawn_at_some_values_of_the_second() -> None:
    plot = node(draw_trace(replace(UNEXPLAINED, missing=missing_of_two())), "torque").plot
    assert plot is not None
    assert 2 <= len(plot.lines) <= 3
    assert plot.words.endswith(" over theta, omega")


def test_what_depends_on_no_number_has_no_plot() -> None:
    nothing = np.zeros(0)
    past = Missing("torque", ("history",), 0.8, (), nothing, nothing)
    torque = node(draw_trace(replace(UNEXPLAINED, missing=past)), "torque")
    assert (torque.mark, torque.plot) == ("needed", None)


def test_a_null_is_the_plain_picture() -> None:
    assert draw_trace(NULL).svg == draw(NULL.original, measured=True).svg


def test_forces_that_cannot_be_computed_leave_the_picture() -> None:
    def fail() -> tuple[Force, ...]:
        raise ZeroDivisionError("no window is left")

    assert node(draw_trace(replace(FOUND, find_forces=fail)), "coulomb").mark == "effect"


MEASURED = """\
measured:
  run: {file: absent.csv, time: t, signals: {theta: {column: theta, sigma: 0.01}}}
"""


def sensed() -> Found:
    """A trace that found an offset of the sensor, too."""
    text = ADDED + MEASURED.replace("sigma", "offset: 0.02, sigma")
    offset = FoundEffect("sensor_offset", "sensor.theta", {"offset": 0.02}, coefficient="offset")
    return replace(
        FOUND,
        effects=(*FOUND.effects, offset),
        original=read_text(ADDED + MEASURED),
        diagram=read_text(text),
    )


def test_an_effect_of_a_sensor_is_green_behind_its_signal() -> None:
    drawing = draw_trace(sensed())
    assert node(drawing, "sensor of theta").mark == "effect"
    assert node(drawing, "sensor of theta").look.lines == ("offset",)
    assert node(drawing, "theta").measured


def test_an_effect_in_a_subsystem_opens_it() -> None:
    inside = """\
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: rail.force}
  rail: {type: rail, v: v}
subsystems:
  rail:
    inputs: [v]
    outputs: {force: total}
    blocks:
      damper: {type: viscous, rate: v, c: 1}
      total: {type: sum, of: [damper]}
"""
    added = inside.replace("[damper]}", "[damper, coulomb]}\n"
                           "      coulomb: {type: coulomb, rate: v, level: 1}")  # fmt: skip
    found = replace(
        FOUND, effects=(replace(FOUND.effects[0], block="rail.coulomb", place="rail.total"),),
        original=read_text(inside), diagram=read_text(added),
    )  # fmt: skip
    assert node(draw_trace(found), "rail.coulomb").mark == "effect"
