from __future__ import annotations

from pathlib import Path

import pytest
from diagram.small_library import refused
from tracewire.diagram import read, read_text
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Items, Scalar, compose
from tracewire.errors import DiagramError

BLOCKS = "blocks: {}\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("title: a\ntitle: b\n" + BLOCKS, "2:1: two definitions of 'title': it stands in line 1"),
        ("title:\n" + BLOCKS, "1:1: 'title' has no value. Write a value behind the colon"),
        ("record: [a, ]\ninclude:\n  -\n" + BLOCKS, "3:4: an entry of this list is empty"),
        (
            "title: !!python/name:os.system x\n" + BLOCKS,
            "1:8: the tag 'tag:yaml.org,2002:python/na",
        ),
        ("title: &name x\n" + BLOCKS, "1:8: the anchor or alias 'name' is not allowed"),
        ("title: *name\n" + BLOCKS, "1:8: the anchor or alias 'name' is not allowed"),
        ("<<: {title: x}\n" + BLOCKS, "1:1: merge keys (<<) are not allowed"),
        ("1: x\n" + BLOCKS, "1:1: a key must be a name, not the number 1"),
        ("[a, b]: x\n" + BLOCKS, "1:1: a key must be a name, not a list or mapping"),
        ("'': x\n" + BLOCKS, "1:1: a key is empty"),
        (f"{'k' * 101}: x\n" + BLOCKS, "is longer than 100 characters"),
        (BLOCKS + "---\nblocks: {}", "2:1: a second document begins here"),
        ("", "<text>: the file is empty. A diagram has at least 'blocks:'."),
        ("# only a comment\n", "the file is empty"),
        ("---\n", "the file is empty"),
        ("title: [a\nblocks: {}", "2:7: this is not YAML: while parsing a flow sequence"),
        ("blocks: {a: {of: [b, - c]}}", "A minus stands at its name, without a blank: [a, -b]."),
        ("title: 'a", "this is not YAML: while scanning a quoted scalar"),
        ("blocks:\n\ta: {}", "2:1: a tab stands where YAML needs blanks"),
        ("title: a: b", "1:9: this is not YAML: mapping values are not allowed"),
        ("title: a\x00b", "1:9: the character U+0000 is no character of a text file"),
        ("title: a\udc00b", "1:9: the character U+DC00 is no character of a text file"),
        ("\n title: a\x85b", "2:10: the character U+0085 ends a line in YAML, but not in an edi"),
        ("title: a\rb", "1:9: the character U+000D ends a line"),
        ("just text", "1:1: a diagram must be a mapping. Write it like 'blocks:"),
    ],
)
def test_what_is_no_strict_yaml_is_refused(text: str, message: str) -> None:
    assert message in refused(text)


def test_tabs_are_named_as_the_cause() -> None:
    assert "Indent with blanks, never with tabs." in refused("blocks:\n\ta: {}")


@pytest.mark.parametrize("opening", ["[", "{a: ", "- "])
def test_deep_nesting_is_refused(opening: str) -> None:
    deep = "title: " if opening != "- " else "title:\n  "
    assert f"nested deeper than {LIMITS.most_nesting} levels" in refused(deep + opening * 5000)


def test_scalars_know_where_they_stand() -> None:
    text = "\ufeffa: {é: [1e-3, 'it''s'], z: yes}\r\nb:\r\n  - x y   # comment\r\n"
    root = compose(text, Path("f"), Problems())
    assert isinstance(root, Entries)
    inner = root.values["a"]
    assert isinstance(inner, Entries) and inner.flow
    items = inner.values["é"]
    assert isinstance(items, Items)
    number, quoted = items.items
    assert isinstance(number, Scalar) and isinstance(quoted, Scalar)
    assert (number.number, quoted.number, quoted.text) == (1e-3, None, "it's")
    assert text[number.start : number.end] == "1e-3"
    assert text[quoted.start : quoted.end] == "'it''s'"
    assert text[inner.start : inner.end] == "{é: [1e-3, 'it''s'], z: yes}"
    block = root.values["b"]
    assert isinstance(block, Items) and not block.flow
    last = block.items[0]
    assert text[last.start : last.end] == "x y"
    assert (last.place.line, last.place.column) == (3, 5)


@pytest.mark.parametrize("text", ["1", "-1.5", "+.5e3", "2.", "1e-3", "1E+9"])
def test_numbers(text: str) -> None:
    assert Scalar(text, None, 0, 0).number == float(text)


@pytest.mark.parametrize("text", ["1_000", "0x1f", "1:30", ".inf", "nan", "1e999", "12 kg", "."])
def test_no_numbers(text: str) -> None:
    assert Scalar(text, None, 0, 0).number is None


def test_a_file_that_is_not_there_names_its_neighbours(tmp_path: Path) -> None:
    (tmp_path / "pendulum.yaml").write_text(BLOCKS)
    (tmp_path / "pendulum.csv").write_text("")
    with pytest.raises(DiagramError) as caught:
        read(tmp_path / "pendulm.yaml")
    message = str(caught.value)
    assert "unknown file 'pendulm.yaml'" in message
    assert "there are: pendulum.yaml. Did you mean 'pendulum.yaml'?" in message


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("", None, "is a folder; there are: other.yaml. Name a file in it."),
        ("nowhere/a.yaml", None, "and no folder"),
        ("large.yaml", b"# " + b"x" * 1_000_000, "is larger than 1 MB"),
        ("bytes.yaml", b"title: a\nblocks: \xff", "2:9: the byte 0xff is not UTF-8 text"),
        ("empty.yaml", b"", "the file is empty"),
        ("a\0b.yaml", None, "no file can have this name"),
        ("x" * 300, None, "cannot be read: File name too long"),
    ],
)
def test_files_that_cannot_be_read(
    tmp_path: Path, name: str, content: bytes | None, message: str
) -> None:
    (tmp_path / "other.yaml").write_text(BLOCKS)
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(DiagramError) as caught:
        read(tmp_path / name)
    assert message in str(caught.value)


def test_a_pipe_is_not_read(tmp_path: Path) -> None:
    import os

    if not hasattr(os, "mkfifo"):
        pytest.skip("no pipes here")
    os.mkfifo(tmp_path / "pipe.yaml")
    with pytest.raises(DiagramError, match="is not a regular file"):
        read(tmp_path / "pipe.yaml")


@pytest.mark.parametrize(
    "text",
    [
        f"start: [{'1,' * 200_000}]",
        f"matrix: [{('[' + '1,' * 500 + '],') * 500}]",
        f"matrix: [{('[[' + '1,' * 500 + ']],') * 500}]",
    ],
    ids=["vector", "matrix", "nested"],
)
def test_a_list_that_no_run_could_take_is_refused_at_its_start(text: str) -> None:
    with pytest.raises(DiagramError, match="this list has more than 10000 values") as caught:
        compose(text, Path("a.yaml"), Problems())
    assert str(caught.value).startswith("a.yaml:1:")


def test_a_long_list_of_mappings_is_read() -> None:
    text = "events:\n" + "  - {a: 1, b: 2, c: 3}\n" * 5000
    assert compose(text, Path("a.yaml"), Problems())


def test_what_follows_from_a_number_that_is_not_finite_is_not_told() -> None:
    text = """
parameters: {k: {value: .nan, fit: [30, 120]}, j: {value: 3, fit: [30, .inf]}}
blocks: {x: {type: constant, value: k}}
"""
    with pytest.raises(DiagramError) as caught:
        read_text(text)
    told = [problem.what for problem in caught.value.problems]
    assert told == [
        "'value' is .nan, and a value is a finite number",
        "an entry of this list is .inf, and a value is a finite number",
    ]
