"""Changes as values: applied to the objects of a diagram they say what its patched text says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from diagram.alike import said
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.diagram import (
    AddBlock,
    AddOwn,
    AddSensorTerm,
    Change,
    Diagram,
    FreeStarts,
    PointsFile,
    SetValues,
    Value,
    apply,
    patch,
    read_text,
)
from tracewire.errors import DiagramError, OptionError, TracewireError
from tracewire.formula import Number

TEXT = """\
inputs: {u: {unit: N, default: 0}}
parameters: {m: 2, c: {value: 3, unit: mm, fit: [0, 9]}, d: {value: 2*m, unit: mm}}
blocks:
  x: {type: integrator, of: v}             # the way
  v: {type: integrator, of: force}
  force: {type: sum, of: [spring, -u, a.y]}   # the sum
  spring: {type: expression, formula: "-m*x - 0.1*abs(u)"}
  pull: {type: sine, amplitude: {value: 1, fit: [0, 1000]}, omega: 2}
  a: {type: leg, r: v, w: pull}
  b: {type: arm, r: v, variant: wet}
  pair: {type: mux, of: [v, v]}
  left: {type: foot, r: v, k2: {value: 2*m, unit: cm}}
  right: {type: foot, r: v, k2: 3}
  only_one: {type: integrator, of: pair, start: [{value: 0, unit: mm}, {value: 1, unit: mm}]}
  only: {type: sum, of: [b.y, -pull]}
subsystems:
  leg: {inputs: [r, w], outputs: {y: total}, parameters: {k: {value: 5, unit: mm}}, blocks:
    {total: {type: sum, of: [r, w]}}}
  foot:
    inputs: [r]
    outputs: {y: slow}
    parameters: {k: {value: 5, unit: mm, fit: [0, 9]}, k2: {value: 1, unit: mm}}
    blocks: {slow: {type: first_order, of: r, lag: {value: 1, unit: ms}}}
  arm:
    inputs: [r]
    outputs: {y: total}
    parameters: {k: 1}
    blocks: {total: {type: sum, of: [drag]}}
    variants:
      dry: {blocks: {drag: {type: gain, of: r, k: 1}}}
      wet: {blocks: {drag: {type: gain, of: r, k: k}, more: {type: sum, of: [r, r]}}}
events:
  - {when: u - x, set: {v: -0.5*v}}
measured:
  run_1:
    {file: run_1.csv, time: t, signals: {x: {column: x, unit: mm}, v: v}, start: {x: free}}
  run_2: {file: run_2.csv, time: t, signals: {x: x}, parameters: {m: 3}}
"""
OF = ("x", "v", "u", "pull", "a.y", "t", "r", "total", "nowhere")
SUMS = ("force", "only", "leg.total", "arm.total", "arm.more", "spring", "leg.no", "none.total")


@pytest.fixture(scope="module")
def diagram(tmp_path_factory: pytest.TempPathFactory) -> Diagram:
    folder = tmp_path_factory.mktemp("changes")
    for name in ("run_1", "run_2"):
        (folder / f"{name}.csv").write_text("t, x, v [mm/s]\n0, 1, 2\n1, 2, 3\n")
    return read_text(TEXT, folder / "two.yaml")


@pytest.fixture(scope="module")
def made(diagram: Diagram) -> Callable[[], Diagram]:
    """The diagram, behind a name that is short where a test fails."""
    return lambda: diagram


numbers = st.floats(-1e6, 1e6).map(lambda x: float(f"{x:.6g}"))
bounds = st.none() | st.tuples(st.floats(-1e9, -1e6), st.sampled_from([2e6, float("inf")]))
values = st.builds(
    lambda number, fit: Value(Number(number), fit=fit, named=fit is not None), numbers, bounds
)


def blocks(name: str) -> st.SearchStrategy[AddBlock]:
    """A new block of this name, somewhere; often where it cannot be."""
    line = st.sampled_from([("gain", "of", "k"), ("viscous", "rate", "c"), ("leg", "r", "k")])

    def block(kind: tuple[str, str, str], of: str, value: Value, to: str, drive: bool) -> AddBlock:
        inputs = {kind[1]: of} | ({"w": of} if kind[0] == "leg" else {})
        return AddBlock(name, kind[0], inputs, {kind[2]: value}, to, drive)

    drives = st.sampled_from(["u", "pull", "x", "nowhere"])
    return st.builds(block, line, st.sampled_from(OF), values, drives, st.just(True)) | st.builds(
        block, line, st.sampled_from(OF), values, st.sampled_from(SUMS), st.just(False)
    )


terms = st.builds(
    AddSensorTerm,
    st.sampled_from(["x", "v", "force"]),
    st.sampled_from(["offset", "gain", "delay", "quad", "drift"]),
    st.floats(1e-3, 1e3),
    st.none() | st.just((0.0, 1e4)),
)
own = st.builds(
    lambda series, value, fit: AddOwn({series: {"c": value}}, {"c": (0.0, 1e7)} if fit else {}),
    st.sampled_from(["run_1", "run_2", "run_3"]),
    st.floats(1e-3, 1e6),
    st.booleans(),
)


others = st.builds(
    lambda chosen: SetValues(chosen),
    st.dictionaries(
        st.sampled_from(
            (
                *("m", "c", "d", "a.k", "b.k", "pull.amplitude", "left.k", "right.k", "left.k2"),
                *("left.slow.lag", "only_one.start[1]", "no", "offset.x", "gain.v", "c@run_1"),
                "m@run_2",
            )
        ),
        st.floats(-1e-3, 1e6),
        max_size=3,
    ),
)


def done(way: object, diagram: Diagram, changes: Sequence[Change]) -> object:
    """What a diagram says after changes; the kind of the error where they cannot be made."""
    try:
        return said(way(diagram, changes))  # type: ignore[operator]
    except TracewireError as error:
        return type(error)


@settings(deadline=None, max_examples=40)
@given(blocks("one"), blocks("two"), terms, own, others)
def test_objects_and_text_say_the_same(
    made: Callable[[], Diagram],
    one: AddBlock,
    two: AddBlock,
    term: AddSensorTerm,
    values: AddOwn,
    other: SetValues,
) -> None:
    diagram = made()
    changes: Sequence[Change]
    free = FreeStarts(("v",))
    for changes in ([one], [term], [values], [other], [free], [term, values, other]):
        assert done(apply, diagram, changes) == done(patch, diagram, changes)
    both = [one, two, term, values, other, free]
    assert done(apply, diagram, both) == done(patch, diagram, both)


def test_the_text_stays_as_it_is(diagram: Diagram) -> None:
    changes = [AddBlock("one", "gain", {"of": "x"}, {"k": Value(Number(2.0))}, "force")]
    new = apply(diagram, changes)
    assert new.text == diagram.text
    assert [wire.signal for wire in new.blocks["force"].inputs["of"]][-1] == "one"
    assert list(new.blocks)[2:4] == ["force", "one"]
    assert "{type: gain, of: x, k: 2}\n" in patch(diagram, changes).text


def test_a_block_goes_into_each_body_that_has_the_sum(diagram: Diagram) -> None:
    changes = [AddBlock("one", "gain", {"of": "r"}, {"k": Value(Number(2.0))}, "arm.total")]
    new = apply(diagram, changes)
    wet = new.blocks["b"].subsystem
    assert wet is not None
    assert "one" in wet.blocks
    assert "one" in new.subsystems["arm"].blocks, "the other variant"


def test_a_table_of_a_file_has_its_points_and_a_comment_where_there_is_a_line(
    tmp_path: Path,
) -> None:
    (tmp_path / "law.csv").write_text("way, force\n0, 0\n1, 2\n")
    points = PointsFile("law.csv", "way", "force")
    change = AddBlock("law", "table", {"of": "x"}, {"points": points}, "s", comment="measured")
    lines = "inputs: [u]\nblocks:\n  x: {type: integrator, of: s}\n  s: {type: sum, of: [u]}\n"
    line = "inputs: [u]\nblocks: {x: {type: integrator, of: s}, s: {type: sum, of: [u]}}\n"
    for text, comment in ((lines, "}}   # measured\n"), (line, "}}}\n")):
        old = read_text(text, tmp_path / "d.yaml")
        new = patch(old, [change])
        assert "points: {file: law.csv, x: way, y: force}" in new.text
        assert new.text.endswith(comment)
        assert said(apply(old, [change])) == said(new)
    for way in (apply, patch):
        with pytest.raises(DiagramError, match="column 'no'"):
            way(old, [replace(change, settings={"points": PointsFile("law.csv", "no", "force")})])


ONE, LEG = Value(Number(1.0)), "leg.total"
REFUSED = {
    "unknown block type 'gian'": AddBlock("one", "gian", {"of": "x"}, {}, "force"),
    "two definitions of 'x'": AddBlock("x", "gain", {"of": "v"}, {"k": ONE}, "force"),
    "unknown signal 'nowhere'": AddBlock(
        "one", "gain", {"of": "nowhere"}, {"k": ONE}, "force"
    ),
    "input 'of' is not connected": AddBlock("one", "gain", {}, {"k": ONE}, "force"),
    "parameter 'k' is not given": AddBlock("one", "gain", {"of": "x"}, {}, "force"),
    "unknown input or parameter of 'gain' 'c'": AddBlock(
        "one", "gain", {"of": "x"}, {"k": ONE, "c": ONE}, "force"
    ),
    "subsystem 'leg' contains itself": AddBlock("one", "leg", {"r": "r", "w": "w"}, {}, LEG),
    "must be at least 0": AddBlock(
        "one", "coulomb", {"rate": "v"},
        {"level": ONE, "width": Value(Number(-1.0))}, "force",
    ),
}  # fmt: skip


@pytest.mark.parametrize("told", REFUSED)
def test_what_reading_would_refuse_is_refused(told: str, diagram: Diagram) -> None:
    with pytest.raises(DiagramError) as refused:
        apply(diagram, [REFUSED[told]])
    assert told in str(refused.value)
    assert Path(refused.value.problems[0].place.file) == diagram.file
    with pytest.raises(DiagramError):
        patch(diagram, [REFUSED[told]])


def test_a_block_of_a_row_has_no_line_of_its_own() -> None:
    text = "inputs: [u]\nblocks: {f: {type: sum, of: [u], replicate: 2}}"
    block = AddBlock("one", "constant", {}, {"value": Value(Number(2.0))}, "f_1")
    with pytest.raises(OptionError, match="one of the row 'f'"):
        apply(read_text(text), [block])


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("n", r"'n' says how many blocks there are, and another number makes others"),
        ("drag.wet_body.k", r"'drag.wet_body.k' belongs to a body of 'arm', of which a parameter"),
    ],
)
def test_what_only_the_text_can_change_is_refused_in_the_objects(path: str, told: str) -> None:
    text = """
inputs: [u]
parameters: {n: 2, kind: 1}
blocks:
  row: {type: gain, of: u, k: 1, replicate: n}
  drag: {type: arm, r: u, variant: kind}
subsystems:
  arm:
    inputs: [r]
    outputs: {y: total}
    variants:
      dry: {parameters: {k: 1}, blocks: {total: {type: gain, of: r, k: k}}}
      wet: {parameters: {k: 2}, blocks: {total: {type: gain, of: r, k: k}}}
"""
    diagram = read_text(text)
    with pytest.raises(OptionError, match=told):
        apply(diagram, [SetValues({path: 3.0})])
    assert patch(diagram, [SetValues({path: 3.0})]).text != text


def test_what_a_block_remembers_begins_free_where_a_start_is_free(diagram: Diagram) -> None:
    new = patch(diagram, [FreeStarts(("v",))])
    assert "start: {x: free, v: free}}\n" in new.text
    assert new.measured["run_1"].start == {"x": None, "v": None}
    assert not new.measured["run_2"].start
