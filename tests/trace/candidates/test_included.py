"""Places in subsystems of included files: each block gets a definition of its own."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest
from oracles.written import with_effects
from tracewire.compile import compile
from tracewire.diagram import Diagram, patch, read_text
from tracewire.solve import simulate
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.places import describe_untried, find_places
from tracewire.trace.candidates.signal_scales import SignalScale, SignalScales
from tracewire.trace.found import Missing
from tracewire.trace.missing.table import table_block
from tracewire.trace.options import TraceOptions
from tracewire.trace.screen.probes import add_probes

PARTS = """\
subsystems:
  cart:
    inputs: [u, w]
    outputs: {x: x}
    blocks:
      x: {type: integrator, of: v}
      v: {type: integrator, of: a}
      a: {type: gain, of: force, k: 2}
      force: {type: sum, of: [-x, u, w]}
  train:
    outputs: {x: front.x}
    blocks: {front: {type: cart, u: front.x, w: front.x}}
  several:
    outputs: [x]
    variants: {one: {}, two: {}}
    blocks: {x: {type: integrator, of: v}, v: {type: integrator, of: f}, f: {type: sum, of: [-x]}}
"""
OPTIONS = TraceOptions()
LEVELS = SignalScales({"u": SignalScale(1.0, 2.0), "x": SignalScale(2.0, 4.0)}, 10.0, 0.01)


def including(folder: Path, top: str) -> Diagram:
    """A diagram that includes these parts, with lines of its own."""
    (folder / "cart.yaml").write_text(PARTS, encoding="utf-8")
    text = "\n".join(["include: cart.yaml", dedent(top).strip(), ""])
    return read_text(text, folder / "top.yaml")


INCLUDING = """
inputs: {u: {default: 0}}
blocks:
  body: {type: cart, u: u, w: u}
  other: {type: cart, u: u, w: u}
"""


def test_a_sum_of_an_included_file_is_a_place_of_each_block(tmp_path: Path) -> None:
    diagram = including(tmp_path, INCLUDING)
    model = compile(diagram, backend="quick")
    body, other, _ = find_places(model)
    assert (body.name, body.definition, body.own) == ("body.force", "cart.force", "body")
    assert (other.name, other.definition, other.own) == ("other.force", "cart.force", "other")
    assert describe_untried(model, [body, other]) == []
    found = find_candidates(model, [body, other], LEVELS, OPTIONS.candidate)
    known = {(c.effect, c.place.name): c for c in found}
    viscous = known["viscous", "body.force"]
    assert (viscous.block, viscous.coefficient) == ("body.viscous_force", "body.viscous_force.c")
    new = with_effects(diagram, [(viscous, {"c": 0.25})])
    assert new.text == (
        "include: cart.yaml\n"
        "inputs: {u: {default: 0}}\n"
        "blocks:\n"
        "  body: {type: own_cart, u: u, w: u}\n"
        "  other: {type: cart, u: u, w: u}\n"
        "subsystems:\n"
        "  own_cart:\n"
        "    extends: cart\n"
        "    blocks:\n"
        "      force: {of: [-x, u, w, viscous_force]}\n"
        "      viscous_force: {type: viscous, rate: v, c: {value: 0.25, fit: [0, 10]}}\n"
    )
    flat = compile(new, backend="quick").flat
    assert "body.viscous_force.c" in flat.parameters
    assert not any(name.startswith("other.viscous") for name in flat.parameters)
    assert "viscous" not in (tmp_path / "cart.yaml").read_text(encoding="utf-8")
    again = find_places(compile(new, backend="quick"))
    assert [(p.definition, p.own) for p in again[:2]] == [
        ("own_cart.force", ""),
        ("cart.force", "other"),
    ]


def test_an_effect_in_an_included_subsystem_goes_into_the_definition_around_it(
    tmp_path: Path,
) -> None:
    diagram = including(
        tmp_path,
        """
        inputs: {u: {default: 0}}
        subsystems:
          cage:
            inputs: [u]
            outputs: {x: c.x}
            blocks: {c: {type: cart, u: u, w: u}}
        blocks: {body: {type: cage, u: u}}
        """,
    )
    model = compile(diagram, backend="quick")
    place = find_places(model)[0]
    assert (place.name, place.own) == ("body.c.force", "body.c")
    known = {c.effect: c for c in find_candidates(model, [place], LEVELS, OPTIONS.candidate)}
    new = with_effects(diagram, [(known["viscous"], {"c": 0.25})])
    assert "blocks: {c: {type: own_cart, u: u, w: u}}" in new.text
    assert "body.c.viscous.c" in compile(new, backend="quick").flat.parameters
    probe, ((name,),) = add_probes(diagram, [place], 1)
    push = {"probe_input_0": ([0, 1], [1, 1])}
    run = simulate(compile(probe), span=(0, 1), parameters={name: 1.0}, inputs=push)
    # x'' = 2 (-x + 1), from rest
    assert run["body.c.x"][-1] == pytest.approx(1.0 - np.cos(np.sqrt(2.0)), abs=1e-6)


def test_a_table_of_what_is_missing_goes_into_an_included_subsystem(tmp_path: Path) -> None:
    diagram = including(tmp_path, INCLUDING)
    place = find_places(compile(diagram, backend="quick"))[0]
    (tmp_path / "missing.csv").write_text("v, torque\n0, 0\n1, 2\n", encoding="utf-8")
    nothing = np.zeros(2)
    missing = Missing(place.name, ("v",), 1.0, (np.array([0.0, 1.0]),), nothing, nothing)
    new = patch(diagram, [table_block(diagram, place, missing, "missing.csv")])
    assert "      force: {of: [-x, u, w, missing]}\n      missing: {type: table, of: v" in new.text


def test_what_cannot_be_extended_is_said(tmp_path: Path) -> None:
    diagram = including(
        tmp_path,
        """
        blocks:
          train: {type: train}
          chosen: {type: several, variant: two}
          row: {type: train, replicate: 2}
        """,
    )
    model = compile(diagram, backend="quick")
    assert describe_untried(model, find_places(model)) == [
        "nothing is tried at sums inside 'train.front': it stands inside a subsystem of cart.yaml",
        "nothing is tried at sums inside 'chosen': its definition stands in cart.yaml, and has "
        "variants",
        "nothing is tried at sums inside 'row': it is a row of blocks",
    ]


def test_a_line_in_a_diagram_that_is_extended_is_said(tmp_path: Path) -> None:
    base = including(tmp_path, INCLUDING)
    (tmp_path / "base.yaml").write_text(base.text, encoding="utf-8")
    diagram = read_text("extends: base.yaml\nparameters: {c: 1}\n", tmp_path / "top.yaml")
    model = compile(diagram, backend="quick")
    assert describe_untried(model, find_places(model)) == [
        "nothing is tried at sums inside 'body', 'other': its line stands in base.yaml"
    ]


def test_a_file_that_is_not_included_by_the_diagram_itself_is_said(tmp_path: Path) -> None:
    deep = "include: cart.yaml\nsubsystems:\n  outer:\n    outputs: {x: c.x}\n    blocks:\n"
    deep += "      c: {type: cart, u: c.x, w: s}\n      s: {type: sum, of: [c.x]}\n"
    (tmp_path / "deep.yaml").write_text(deep, encoding="utf-8")
    (tmp_path / "cart.yaml").write_text(PARTS, encoding="utf-8")
    text = "include: deep.yaml\nblocks: {body: {type: outer}}\n"
    diagram = read_text(text, tmp_path / "top.yaml")
    model = compile(diagram, backend="quick")
    first, *_ = describe_untried(model, find_places(model))
    assert first == (
        "nothing is tried at sums inside 'body': the diagram does not include the file that "
        "defines 'cart'"
    )
