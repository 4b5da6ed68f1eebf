"""`extends` in a subsystem: one of an included file with changes, which leave that file alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagram.alike import said
from tracewire.compile import compile
from tracewire.diagram import (
    AddBlock,
    Diagram,
    Value,
    apply,
    difference,
    lay_out,
    patch,
    read_text,
    write_out,
)
from tracewire.diagram.edit_values import set_values
from tracewire.diagram.owned import patch_own
from tracewire.errors import DiagramError, OptionError
from tracewire.formula import Number

PARTS = """\
subsystems:
  cart:
    inputs: {u: {unit: N, default: 0}}
    outputs: [x, v]
    parameters: {k: {value: 8, unit: N/m, fit: [1, 20]}, m: {value: 2, unit: kg}}
    blocks:
      x: {type: integrator, of: v, start: 0.1, unit: m}
      v: {type: integrator, of: a, unit: m/s}
      a: {type: gain, of: force, k: 1/m, unit: m/s^2}
      spring: {type: gain, of: x, k: -k, unit: N}
      force: {type: sum, of: [spring, u], unit: N}
"""
TOP = """\
include: parts.yaml
subsystems:
  rough_cart:
    extends: cart
    parameters: {k: 9}
    blocks:
      force: {of: [spring, u, drag]}
      drag: {type: viscous, rate: v, c: {value: 0.4, unit: N s/m}}
  free_cart:
    extends: cart
    remove: [spring]
    blocks: {force: {of: [u]}}
blocks:
  smooth: {type: cart}
  rough: {type: rough_cart}
  free: {type: free_cart}
"""
PLAIN = "include: parts.yaml\nblocks:\n  body: {type: cart}   # the one\n  other: {type: cart}\n"


def made(folder: Path, text: str) -> Diagram:
    (folder / "parts.yaml").write_text(PARTS, encoding="utf-8")
    return read_text(text, folder / "top.yaml")


def test_a_subsystem_is_that_of_a_file_with_changes(tmp_path: Path) -> None:
    diagram = made(tmp_path, TOP)
    flat = compile(diagram, backend="quick").flat
    values = {name: parameter.formula for name, parameter in flat.parameters.items()}
    assert (values["smooth.k"], values["rough.k"]) == (Number(8), Number(9))
    assert flat.parameters["rough.k"].fit == (1, 20)
    assert "rough.drag" in flat.signals
    assert "free.spring" not in flat.signals
    alone = read_text(write_out(diagram), tmp_path / "alone.yaml")
    (tmp_path / "parts.yaml").unlink()
    assert said(alone.blocks) == said(diagram.blocks)
    assert alone.sources == ()


def test_a_file_that_is_included_may_change_what_it_includes(tmp_path: Path) -> None:
    more = "include: parts.yaml\nsubsystems: {heavy: {extends: cart, parameters: {m: 9}}}\n"
    (tmp_path / "more.yaml").write_text(more, encoding="utf-8")
    text = "include: more.yaml\nsubsystems: {heavier: {extends: heavy, parameters: {k: 1}}}\n"
    diagram = made(tmp_path, text + "blocks: {a: {type: heavier}}\n")
    parameters = compile(diagram, backend="quick").flat.parameters
    assert (parameters["a.m"].formula, parameters["a.k"].formula) == (Number(9), Number(1))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (
            ("extends: cart\n    parameters", "extends: card\n    parameters"),
            "4:14: unknown subsystem of an included file 'card'; there are: cart. ",
        ),
        (
            ("extends: cart\n    parameters", "extends: free_cart\n    parameters"),
            "4:14: unknown subsystem of an included file 'free_cart'",
        ),
        (
            ("extends: cart\n    parameters", "extends: [cart]\n    parameters"),
            "4:14: 'extends' in a subsystem names one of an included file. Write extends: cart.",
        ),
        (
            ("extends: cart\n    remove", "title: Free\n    remove"),
            "11:5: 'remove' takes parts of another subsystem away, and this one extends none.",
        ),
        (("remove: [spring]", "remove: [sprung]"), "11:14: unknown part to remove 'sprung'"),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, change: tuple[str, str], told: str) -> None:
    with pytest.raises(DiagramError) as refused:
        made(tmp_path, TOP.replace(*change))
    assert f"top.yaml:{told}" in str(refused.value)


def test_values_are_written_into_the_changes(tmp_path: Path) -> None:
    diagram = made(tmp_path, TOP)
    new = set_values(diagram, {"rough.k": 11.0, "free.m": 3.0, "rough.drag.c": 0.5})
    lines = [line for line in difference(diagram, new).splitlines() if line.startswith("+ ")]
    assert lines == [
        "+    parameters: {k: {value: 11, unit: N/m, fit: [1, 20]}}",
        "+      drag: {type: viscous, rate: v, c: {value: 0.5, unit: N s/m}}",
        "+    parameters: {m: {value: 3, unit: kg}}",
    ]
    with pytest.raises(OptionError, match=r"Edit that file, or write one that extends it"):
        set_values(diagram, {"smooth.k": 11.0})
    assert lay_out(diagram.text) != ""


DRAG = AddBlock("drag", "viscous", {"rate": "v"}, {"c": Value(Number(0.5))}, "cart.force")


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN.replace("\n", "\r\n"),
        PLAIN.rstrip("\n"),
        PLAIN + "subsystems:\n  own_cart: {extends: cart}\n",
        PLAIN + "subsystems:\n    late:\n      extends: cart\n",
        PLAIN + "subsystems: {late: {extends: cart}}\n",
        "{include: parts.yaml, blocks: {body: {type: cart}, other: {type: cart}}}",
    ],
    ids=["lines", "windows", "no end", "taken", "lines there", "braces there", "braces"],
)
def test_a_block_gets_a_definition_of_its_own(tmp_path: Path, text: str) -> None:
    diagram = made(tmp_path, text)
    for changes in (
        [AddBlock(**{**vars(DRAG), "own": "body"})],
        [
            AddBlock(**{**vars(DRAG), "own": "body"}),
            AddBlock(**{**vars(DRAG), "own": "body", "name": "more"}),
            AddBlock(**{**vars(DRAG), "own": "other"}),
        ],
    ):
        new = patch(diagram, changes)
        assert said(new) == said(apply(diagram, changes))
        assert new.blocks["body"].type in ("own_cart", "own_cart_2")
        signals = compile(new, backend="quick").flat.signals
        assert ("body.drag" in signals, "other.drag" in signals) == (True, len(changes) > 1)
        assert not any(line != line.rstrip() for line in new.text.splitlines())
    assert (tmp_path / "parts.yaml").read_text(encoding="utf-8") == PARTS
    assert "the one" in new.text or "the one" not in text


def test_what_has_no_line_of_its_own_is_refused(tmp_path: Path) -> None:
    diagram = made(tmp_path, PLAIN)
    (tmp_path / "base.yaml").write_text(PLAIN, encoding="utf-8")
    other = read_text("extends: base.yaml\ntitle: Other\n", tmp_path / "top.yaml")
    with pytest.raises(OptionError, match=r"'body' stands in another file\. Edit that file"):
        patch_own(other, "body", "cart.force")
    for way in (patch, apply):
        with pytest.raises(OptionError, match="unknown block that is a subsystem 'bodi'"):
            way(diagram, [AddBlock(**{**vars(DRAG), "own": "bodi"})])
        with pytest.raises(OptionError, match="unknown block 'none'"):
            way(diagram, [AddBlock(**{**vars(DRAG), "own": "none.body"})])


def test_files_are_found_from_the_folder_of_the_file_that_names_them(tmp_path: Path) -> None:
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "drag.csv").write_text("v,f\n0,0\n1,-1\n", encoding="utf-8")
    table = "      drag: {type: table, of: v, points: {file: drag.csv, x: v, y: f}}\n"
    parts = PARTS.replace("of: [spring, u]", "of: [spring, u, drag]") + table
    (folder / "parts.yaml").write_text(parts, encoding="utf-8")
    text = PLAIN.replace("parts.yaml", "parts/parts.yaml")
    diagram = read_text(text, tmp_path / "top.yaml")
    changes = [AddBlock(**{**vars(DRAG), "name": "more", "own": "body"})]
    new = patch(diagram, changes)
    assert "force: {of: [spring, u, drag, more]}" in new.text
    assert said(new) == said(apply(diagram, changes))


def test_files_that_each_extend_the_last_one_twice_are_refused_before_they_fill_the_memory(
    tmp_path: Path,
) -> None:
    """Each file doubles what it has: a hundred of them would have no end."""
    (tmp_path / "f0.yaml").write_text(
        "subsystems:\n"
        "  s0: {inputs: [u], outputs: {y: g}, blocks: {g: {type: gain, of: u, k: 1}}}\n",
        encoding="utf-8",
    )
    for n in range(1, 15):
        (tmp_path / f"f{n}.yaml").write_text(
            f"include: f{n - 1}.yaml\n"
            f"subsystems:\n"
            f"  s{n}:\n"
            f"    inputs: [u]\n"
            f"    outputs: {{y: g}}\n"
            f"    subsystems: {{a{n}: {{extends: s{n - 1}}}, b{n}: {{extends: s{n - 1}}}}}\n"
            f"    blocks: {{g: {{type: gain, of: u, k: 1}}}}\n",
            encoding="utf-8",
        )
    with pytest.raises(DiagramError) as refused:
        read_text("include: f14.yaml\nblocks: {u: {type: time}}\n", tmp_path / "top.yaml")
    first = str(refused.value.problems[0])
    assert "which this one extends, has more than 20000 parts. Write the blocks that are" in first
