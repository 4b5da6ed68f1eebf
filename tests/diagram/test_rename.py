"""A part gets another name at every place that reads it, and nowhere else."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from diagram.whole import WHOLE
from tracewire.compile import compile
from tracewire.diagram import Diagram, read, read_text, renamed
from tracewire.errors import OptionError
from tracewire.shipped import shipped
from tracewire.solve import simulate


@pytest.fixture(scope="module")
def whole() -> Diagram:
    return read_text(WHOLE, Path("a.yaml"))


def lines_of(before: str, after: str) -> list[str]:
    """The lines that are new, without those that stay."""
    pairs = zip(before.splitlines(), after.splitlines(), strict=True)
    return [new.strip() for old, new in pairs if old != new]


def test_a_signal(whole: Diagram) -> None:
    text = renamed(whole, "theta", "angle").text
    read_text(text, Path("a.yaml"))
    expected = re.sub(r"(?<![\w.])theta\b", "angle", WHOLE)
    expected = expected.replace(
        "column: angle", "column: theta"
    )  # the file's column keeps its name
    assert text == expected


def test_a_parameter_is_no_label_column_comment_or_key(whole: Diagram) -> None:
    assert lines_of(WHOLE, renamed(whole, "k", "stiff").text) == [
        "stiff: {value: 3.1e-3, unit: N m/rad, fit: [1e-3, 1e-2]}     # k of the spring",
        "half: stiff/2",
        "require: [J > 0, stiff*T > 0]",
        "column: {type: gain, of: theta, k: -stiff}",
        "hinge: {type: hinge, rate: omega, slip: 2*stiff}",
        'force: {type: expression, formula: "drive + load - min(stiff*theta, 1) + hinge.torque"}',
        "- {when: theta - stiff, crosses: up, set: {omega: -0.5*omega*stiff}}",
        "printed: {stiff: 3.0e-3, hinge.slip: stiff/10}",
        "parameters: {stiff: {value: 2, fit: [0, 3]}, hinge.width: 2*T}",
        "- disc: {at: [sin(theta), -cos(theta)], radius: stiff}",
        '- {that: "max(abs(theta))/stiff", is: stiff, within: 5 %, source: Table 1, name: swing,'
        " unit: rad}",
        '- {that: "at(theta, 2*T)/stiff", above: 0, run: {preset: printed, set: {stiff: 2},'
        " samples: 20}}",
    ]


def test_a_block_that_is_a_subsystem_keeps_its_type(whole: Diagram) -> None:
    assert lines_of(WHOLE, renamed(whole, "hinge", "bearing").text) == [
        'record: [theta, bearing.slide, "q[1]", bearing.torque]',
        "bearing: {type: hinge, rate: omega, slip: 2*k}",
        'force: {type: expression, formula: "drive + load - min(k*theta, 1) + bearing.torque"}',
        'of: [column, -force, bearing.torque, "q[0]"]',
        "printed: {k: 3.0e-3, bearing.slip: k/10}",
        "bearing.torque: k",
        "start: {theta: free, bearing.slide: free}",
        "parameters: {k: {value: 2, fit: [0, 3]}, bearing.width: 2*T}",
    ]


def test_a_parameter_of_a_subsystem(whole: Diagram) -> None:
    assert lines_of(WHOLE, renamed(whole, "hinge.slip", "level").text) == [
        "hinge: {type: hinge, rate: omega, level: 2*k}",
        "level: {value: 1.5e-4, unit: N m, fit: [0, 1e-3]}",
        "coefficient: level",
        "total: {type: expression, formula: -level*tanh(slide/width)*sign(rate)}",
        "printed: {k: 3.0e-3, hinge.level: k/10}",
    ]


def test_an_input_of_a_subsystem(whole: Diagram) -> None:
    assert lines_of(WHOLE, renamed(whole, "hinge.rate", "v").text) == [
        "hinge: {type: hinge, v: omega, slip: 2*k}",
        "inputs: [v]",
        "inputs: {v: v}",
        "slide: {type: integrator, of: v}",
        "total: {type: expression, formula: -slip*tanh(slide/width)*sign(v)}",
    ]


def test_an_output_and_a_block_of_a_subsystem(whole: Diagram) -> None:
    out = lines_of(WHOLE, renamed(whole, "hinge.torque", "moment").text)
    assert len(out) == 5
    assert "outputs: {moment: total}" in out
    assert lines_of(WHOLE, renamed(whole, "hinge.slide", "way").text) == [
        'record: [theta, hinge.way, "q[1]", hinge.torque]',
        "way: {type: integrator, of: rate}",
        "total: {type: expression, formula: -slip*tanh(way/width)*sign(rate)}",
        "start: {theta: free, hinge.way: free}",
    ]


def test_an_input_and_a_vector(whole: Diagram) -> None:
    drive = lines_of(WHOLE, renamed(whole, "drive", "push").text)
    assert [line.split(":")[0] for line in drive] == ["push", "force", "inputs", "clean"]
    vector = lines_of(WHOLE, renamed(whole, "q", "pair").text)
    assert vector[0] == 'record: [theta, hinge.slide, "pair[1]", hinge.torque]'
    assert len(vector) == 3


def test_a_subsystem_where_no_block_has_its_name(whole: Diagram) -> None:
    other = renamed(whole, "hinge", "bearing")
    assert lines_of(other.text, renamed(other, "hinge", "joint").text) == [
        "bearing: {type: joint, rate: omega, slip: 2*k}",
        "joint:",
    ]
    assert (
        renamed(other, "bearing.slip", "level").text == renamed(other, "hinge.slip", "level").text
    )


def parts(diagram: Diagram, path: str = "") -> list[str]:
    """Every name that can be given, by its path."""
    own = dict.fromkeys([*diagram.blocks, *diagram.inputs, *diagram.parameters, *diagram.outputs])
    found = [path + name for name in own]
    for name, inside in diagram.subsystems.items():
        if inside.file == diagram.file:
            found += [path + name, *parts(inside, f"{path}{name}.")]
    return found


@pytest.mark.parametrize("file", ["papers/a_torsion/pendulum.yaml", "demo/full.yaml", "whole"])
def test_there_and_back_gives_the_same_text(file: str, whole: Diagram) -> None:
    diagram = whole if file == "whole" else read(shipped("diagrams") / file)
    names = parts(diagram)
    assert len(names) > 15
    for path in names[:: 1 + len(names) // 50]:
        where, _, name = path.rpartition(".")
        new = f"{name}_zz"
        there = renamed(diagram, path, new)
        assert there.text != diagram.text
        assert renamed(there, f"{where}.{new}".lstrip("."), name).text == diagram.text


def test_a_run_has_the_same_numbers() -> None:
    diagram = read(shipped("diagrams") / "lessons" / "cart.yaml")
    before = simulate(compile(diagram))
    state = next(name for name in before.signals if name in diagram.blocks)
    after = simulate(compile(renamed(diagram, state, "zz_other")))
    assert list(after.signals) == [n if n != state else "zz_other" for n in before.signals]
    for one, other in zip(before.signals.values(), after.signals.values(), strict=True):
        np.testing.assert_array_equal(one, other)


def test_escapes_in_quotes_are_no_names() -> None:
    text = 'parameters: {u0063: 1, c: 2}\nblocks: {a: {type: constant, value: "u0063 + \\u0063"}}\n'
    assert 'value: "b + \\u0063"' in renamed(read_text(text), "u0063", "b").text


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("thta", "x", "unknown name 'thta'; there are: J, T, alpha,"),
        ("hinge.slop", "x", "unknown name 'hinge.slop'; there are: hinge.rate, hinge.slide"),
        ("hing.slip", "x", "unknown subsystem 'hing'; there are: hinge. Did you mean 'hinge'?"),
        ("theta", "omega", "a.yaml:1:1: there is a part 'omega' already. Choose another name."),
        ("theta", "k", "there is a part 'k' already"),
        ("theta", "theta", "there is a part 'theta' already"),
        ("hinge.slip", "rate", "there is a part 'rate' already"),
        ("hinge.slip", "unit", "'unit:' means something else on every block"),
        ("theta", "sin", "'sin' cannot be the name of a part. 'sin' is a word of formulas"),
        ("theta", "φ", "'φ' cannot be the name of a part. Use the letters a to z, digits and _"),
        ("theta", "hinge.x", "'hinge.x' cannot be the name of a part"),
    ],
)
def test_refusals(whole: Diagram, old: str, new: str, words: str) -> None:
    with pytest.raises(OptionError) as caught:
        renamed(whole, old, new)
    assert words in str(caught.value)


def test_a_type_that_is_taken(whole: Diagram) -> None:
    other = renamed(whole, "hinge", "bearing")
    with pytest.raises(OptionError, match="there is a block type 'gain' already"):
        renamed(other, "hinge", "gain")


def test_a_part_of_an_included_file_is_renamed_there(tmp_path: Path) -> None:
    (tmp_path / "parts.yaml").write_text("subsystems: {s: {blocks: {x: {type: time}}}}\n")
    diagram = read_text("include: parts.yaml\nblocks: {b: {type: s}}\n", tmp_path / "a.yaml")
    for path in ("s", "s.x", "b.x"):
        with pytest.raises(OptionError, match="the subsystem 's' is defined in another file"):
            renamed(diagram, path, "y")


ROWS = """\
parameters: {n: 3, k: 2}
record: [chain.all.phi, chain_2.omega]
blocks:
  wall: {type: constant, value: 0}
  chain:
    type: pendulum
    left: previous.phi
    right: next.phi
    k: k*index
    replicate: {count: n, first: {left: wall, start: k}, last: {right: wall}}
  other: {type: sum, of: [chain.all.phi, -chain_1.phi, chain.last.omega]}
subsystems:
  pendulum:
    inputs: [left, right]
    outputs: [phi, omega]
    parameters: {k: 1, start: 0}
    blocks:
      phi: {type: integrator, of: omega, start: start}
      omega: {type: integrator, of: alpha}
      alpha: {type: expression, formula: k*(left - 2*phi + right)}
"""


def test_a_row_and_its_blocks_follow() -> None:
    diagram = read_text(ROWS)
    assert renamed(diagram, "chain", "link").text == ROWS.replace("chain", "link")
    expected = re.sub(r"\bphi\b", "angle", ROWS)
    for path in ("pendulum.phi", "chain.phi", "chain_2.phi"):
        assert renamed(diagram, path, "angle").text == expected
    assert renamed(diagram, "n", "length").text == re.sub(r"\bn\b", "length", ROWS)
    top, inside = ROWS.split("subsystems:")
    new = re.sub(r"\bk\b", "stiff", top).replace("    stiff: stiff*index", "    k: stiff*index")
    assert renamed(diagram, "k", "stiff").text == f"{new}subsystems:{inside}"
    new = re.sub(r"\bstart\b", "begin", inside).replace("begin: begin}", "start: begin}")
    top = top.replace("start: k", "begin: k")
    assert renamed(diagram, "chain.start", "begin").text == f"{top}subsystems:{new}"


BODIES = """\
parameters: {law: 1}
presets: {b: {law: 2, drag.c: 3, drag.dry_body.level: 1}}
blocks:
  v: {type: integrator, of: drag.force}
  drag: {type: friction, rate: v, variant: law, c: 4}
subsystems:
  friction:
    inputs: [rate]
    outputs: {force: total}
    parameters: {c: 2, level: 1}
    blocks: {total: {type: sum, of: [law]}}
    variants:
      wet: {blocks: {law: {type: viscous, rate: rate, c: c}}}
      dry:
        parameters: {level: 7}
        remove: [total]
        blocks:
          law: {type: dry_friction, rate: rate, slip: level, stick: c}
          total: {type: sum, of: [law]}
"""


def test_all_bodies_of_a_subsystem_follow() -> None:
    diagram = read_text(BODIES)
    assert renamed(diagram, "friction.c", "d").text == (
        BODIES.replace("c: 4", "d: 4")
        .replace("drag.c", "drag.d")
        .replace("{c: 2", "{d: 2")
        .replace("c: c}", "c: d}")
        .replace("stick: c", "stick: d")
    )
    assert renamed(diagram, "drag.total", "sum_1").text == BODIES.replace("total", "sum_1")
    assert renamed(diagram, "friction.level", "z").text == re.sub(r"\blevel\b", "z", BODIES)
    own, law = BODIES.split("subsystems:")
    assert renamed(diagram, "law", "w").text == f"{own.replace('law', 'w')}subsystems:{law}"
    inner = law.replace("law", "w")
    assert renamed(diagram, "friction.law", "w").text == f"{own}subsystems:{inner}"
    assert renamed(diagram, "friction", "f").text == BODIES.replace("friction", "f").replace(
        "dry_f,", "dry_friction,"
    )


@pytest.mark.parametrize("text", [ROWS, BODIES], ids=["rows", "variants"])
def test_there_and_back_of_what_is_composed(text: str) -> None:
    diagram = read_text(text)
    names = [n for n in parts(diagram) if not re.search(r"chain_\d", n)]
    for path in [*names, *(["chain"] if "chain" in text else [])]:
        where, _, name = path.rpartition(".")
        there = renamed(diagram, path, f"{name}_zz")
        assert there.text != text
        assert renamed(there, f"{where}.{name}_zz".lstrip("."), name).text == text


def test_a_diagram_that_extends_another_one(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(
        "parameters: {k: 1, c: 1}\nblocks:\n  x: {type: integrator, of: f, start: 1}\n"
        "  f: {type: sum, of: [spring]}\n  spring: {type: gain, of: x, k: -k}\n"
    )
    text = (
        "extends: base.yaml\nparameters: {d: 3}\nblocks:\n  f: {of: [spring, drag]}\n"
        "  drag: {type: gain, of: x, k: -d}\n  spring: {type: gain, of: x, k: -2*k}\n"
    )
    diagram = read_text(text, tmp_path / "top.yaml")
    assert renamed(diagram, "drag", "w").text == text.replace("drag", "w")
    assert renamed(diagram, "d", "w").text == text.replace("d: 3", "w: 3").replace("-d}", "-w}")
    for name, line in (("x", 3), ("k", 1), ("f", 4), ("spring", 5)):
        with pytest.raises(OptionError) as caught:
            renamed(diagram, name, "w")
        words = f"base.yaml:{line}:"
        assert words in str(caught.value)
        assert "stands in a diagram that this one extends. Rename it there" in str(caught.value)
    own = text.replace("  spring", "  loose") + "remove: [spring]\n"
    changed = read_text(own.replace("[spring, drag]", "[loose]"), tmp_path / "top.yaml")
    assert "  tight: {type" in renamed(changed, "loose", "tight").text


SECTION = """\
span: [0, 1]
blocks:
  x: {type: integrator, of: down, start: 1}
  down: {type: gain, of: x, k: -1}
  slip: {type: gain, of: x, k: 2}
expect:
  - {that: end(x), above: 0, run: {guard: x - 0.5, modulo: {x: 1}}}
  - {that: "time(x - 0.5)", below: 1}
"""


def test_statements_follow() -> None:
    text = renamed(read_text(SECTION), "x", "z").text
    assert text == re.sub(r"\bx\b", "z", SECTION)


@pytest.mark.parametrize(
    ("statement", "old", "words"),
    [
        ("{that: count(slip), is: 0, within: 1}", "slip", "'slip' is a word of a statement"),
        (
            "{that: reference(end(x)), above: 0, reference: {diagram: a.yaml}}",
            "x",
            "a statement reads 'x' beside another diagram",
        ),
    ],
)
def test_what_means_something_else_in_a_statement_is_refused(
    tmp_path: Path, statement: str, old: str, words: str
) -> None:
    (tmp_path / "a.yaml").write_text(SECTION)
    diagram = read_text(f"{SECTION}  - {statement}\n", tmp_path / "b.yaml")
    with pytest.raises(OptionError, match=re.escape(words)):
        renamed(diagram, old, "w")


def test_a_parameter_of_an_included_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text("parameters: {k: 2}\n")
    text = "include: m.yaml\nblocks: {y: {type: constant, value: k}}\n"
    diagram = read_text(text, tmp_path / "a.yaml")
    with pytest.raises(OptionError, match="'k' stands in a file that is included"):
        renamed(diagram, "k", "stiff")
