"""The schema accepts every diagram that the reader accepts, and refuses what a schema can."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from diagram.whole import WHOLE
from tracewire.diagram import (
    is_modeline,
    read,
    read_text,
    schema_of,
    schema_text,
    with_modeline,
    write,
)
from tracewire.diagram.files import load_text
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Items, Node, Scalar, compose
from tracewire.errors import OptionError, TracewireError
from tracewire.library import Library, load_library
from tracewire.shipped import shipped

jsonschema = pytest.importorskip("jsonschema")
LIBRARY = load_library()
SCHEMA = schema_of(LIBRARY)
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)
BROKEN = Path(__file__).parent / "broken"
SHIPPED = sorted(shipped("diagrams").rglob("*.yaml"))


def content(node: Node) -> Any:
    """What a YAML reader of an editor makes of a node."""
    if isinstance(node, Scalar):
        return node.text if node.number is None else node.number
    if isinstance(node, Items):
        return [content(item) for item in node.items]
    return {name: content(value) for name, _, value in node}


def content_of(text: str) -> Any:
    return content(compose(text, Path("a.yaml"), Problems()))


def is_refused_by_reader(data: Any) -> bool:
    try:
        read_text(json.dumps(data), Path("a.yaml"), library=LIBRARY)
    except TracewireError:
        return True
    return False


def test_it_is_a_schema_of_draft_7() -> None:
    assert SCHEMA["$schema"] == "http://json-schema.org/draft-07/schema#"
    jsonschema.Draft7Validator.check_schema(SCHEMA)


def test_it_accepts_every_shipped_diagram() -> None:
    assert len(SHIPPED) > 70
    refused = [file for file in SHIPPED if not VALIDATOR.is_valid(content_of(load_text(file)))]
    assert refused == []


def test_every_shipped_diagram_names_the_schema_that_is_shipped() -> None:
    schema = shipped("diagrams") / "schema.json"
    for file in [*SHIPPED, *shipped("blocks").glob("*.yaml")]:
        first = load_text(file).split("\n", 1)[0]
        assert is_modeline(first), file
        assert (file.parent / first.partition("$schema=")[2]).samefile(schema), file


def test_the_shipped_schema_is_that_of_the_library() -> None:
    text = load_text(shipped("diagrams") / "schema.json")
    assert text == schema_text(SCHEMA), "write it: tracewire schema --output diagrams/schema.json"
    assert json.loads(text) == SCHEMA


def test_it_accepts_every_section() -> None:
    whole = content_of(WHOLE)
    VALIDATOR.validate(whole)
    assert set(whole) | {"include", "libraries", "extends", "remove"} == set(
        SCHEMA["definitions"]["diagram"]["properties"]
    )


@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("unknown_block.yaml", "'integrater' is not one of"),
        ("unknown_parameter.yaml", "'gian' was unexpected"),
        ("unconnected_input.yaml", "'of' is a required property"),
    ],
)
def test_it_refuses_what_a_schema_can_see(file: str, words: str) -> None:
    errors = VALIDATOR.iter_errors(content_of(load_text(BROKEN / file)))
    assert words in str(jsonschema.exceptions.best_match(errors).message)


def spots(data: Any) -> Iterator[tuple[Any, Any]]:
    """(list or mapping, key) of everything in the data."""
    for key in list(data) if isinstance(data, dict) else range(len(data)):
        yield data, key
        if isinstance(data[key], dict | list):
            yield from spots(data[key])


def changes() -> Iterator[tuple[str, Any]]:
    """The whole diagram with one thing changed, for each thing and each of a few changes."""
    whole = content_of(WHOLE)
    count = sum(1 for _ in spots(whole))
    for n in range(count):
        for kind in ("gone", "unknown", "list", "mapping", "word", "negative"):
            data = copy.deepcopy(whole)
            inside, key = list(spots(data))[n]
            if kind == "gone":
                del inside[key]
            elif kind == "unknown":
                if not isinstance(inside, dict):
                    continue
                inside["unknown_key"] = inside[key]
            else:
                inside[key] = {"list": [[1]], "mapping": {"a": 1}, "word": "(", "negative": -1}[
                    kind
                ]
            yield f"{kind}: {key} {n}", data


def test_it_refuses_nothing_that_the_reader_accepts() -> None:
    """Each thing in a diagram with all sections is taken away or made another one."""
    whole = content_of(WHOLE)
    assert not is_refused_by_reader(whole)
    types = {use["type"] for use in whole["blocks"].values()} & set(LIBRARY)
    few = Library({name: LIBRARY[name] for name in sorted(types)}, {})  # all take a minute
    validator = jsonschema.Draft7Validator(schema_of(few))
    refused = 0
    for what, data in changes():
        if not validator.is_valid(data):
            refused += 1
            assert is_refused_by_reader(data), what
    assert refused > 500


def test_it_knows_types_ports_parameters_and_bounds() -> None:
    used = next(
        one["then"]
        for one in SCHEMA["definitions"]["block"]["allOf"]
        if one["if"]["properties"]["type"]["const"] == "viscous"
    )
    assert used["then"]["required"] == ["rate", "c"]
    assert used["properties"]["rate"]["description"].endswith("a wire")
    assert used["properties"]["c"]["allOf"][1]["minimum"] == 0


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("crosses: up", "crosses: upwards"),
        ("sign: either", "sign: both"),
        ("hold: linear", "hold: next"),
        ("color: blue", "color: bleu"),
        ("use: {train: [0, 1]", "use: {train: 1"),
        ("of: omega, start", "of: 3, start"),
        ("span: [0, 2*T]", "span: [0]"),
        ("sigma: 1e-3", "sigma: 0"),
        ("  drive: {unit", "  2drive: {unit"),
        ("  J: {value", "  sin: {value"),
        ("- rod:", "- rodd:"),
        ("detrend: theta", "detrendd: theta"),
        ("every: T, offset", "offset"),
    ],
)
def test_it_refuses_words_and_kinds(old: str, new: str) -> None:
    assert old in WHOLE
    data = content_of(WHOLE.replace(old, new))
    assert not VALIDATOR.is_valid(data)
    assert is_refused_by_reader(data)


def test_a_type_is_unknown_only_where_there_are_no_subsystems() -> None:
    own = {"blocks": {"a": {"type": "mine"}}}
    assert not VALIDATOR.is_valid(own)
    assert VALIDATOR.is_valid(own | {"include": "parts.yaml"})
    assert VALIDATOR.is_valid({"blocks": {"a": {"type": "mylab.magnet"}}})


def test_a_library_of_ones_own_is_known() -> None:
    few = Library({"gain": LIBRARY["gain"]}, {})
    validator = jsonschema.Draft7Validator(schema_of(few))
    assert validator.is_valid({"blocks": {"a": {"type": "gain", "of": "a", "k": 1}}})
    assert not validator.is_valid({"blocks": {"a": {"type": "clock"}}})


def test_the_modeline_names_the_schema_relative_to_the_file(tmp_path: Path) -> None:
    file, schema = tmp_path / "a" / "b.yaml", tmp_path / ".tracewire" / "schema.json"
    text = "blocks: {}\r\n"
    line = "# yaml-language-server: $schema=../.tracewire/schema.json\r\n"
    assert with_modeline(text, file, schema) == line + text
    assert with_modeline(line + text, file, schema) == line + text
    other = with_modeline("\ufeff# title\nblocks: {}\n", file, tmp_path / "a" / "s.json")
    assert other == "\ufeff# yaml-language-server: $schema=s.json\n# title\nblocks: {}\n"
    with pytest.raises(OptionError, match=r"only up to its blank. Write the schema into"):
        with_modeline(text, file, tmp_path / "my schemas" / "s.json")


def test_a_statement_expects_one_thing() -> None:
    def is_valid(statement: dict[str, Any]) -> bool:
        return bool(VALIDATOR.is_valid({"blocks": {}, "expect": [{"that": "t", **statement}]}))

    assert is_valid({"above": 1})
    assert not is_valid({"above": 1, "between": [1, 2]})
    assert not is_valid({})


def test_a_diagram_that_is_written_elsewhere_names_the_same_schema(tmp_path: Path) -> None:
    (tmp_path / "schema.json").write_text("{}", encoding="utf-8")
    (tmp_path / "inside").mkdir()
    text = "{}title: A clock\nblocks: {{t_now: {{type: time}}}}\n"
    old, new = tmp_path / "old.yaml", tmp_path / "inside" / "new.yaml"
    for there, moved in (
        ("schema.json", "../schema.json"),
        ("absent.json", "absent.json"),
        ("https://example.org/schema.json", "https://example.org/schema.json"),
    ):
        line = "# yaml-language-server: $schema={}\n"
        old.write_text(text.format(line.format(there)), encoding="utf-8")
        write(read(old), new, overwrite=True)
        assert load_text(new) == text.format(line.format(moved))
        write(read(old), tmp_path / "beside.yaml", overwrite=True)
        assert load_text(tmp_path / "beside.yaml") == load_text(old)
    write(read_text(text.format(""), old), new, overwrite=True)
    assert load_text(new) == text.format("")
