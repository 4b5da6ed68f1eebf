"""The pages in docs: tests that a promise names exist, and every section of a diagram is there."""

from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path

import pytest
import tracewire as tw
import tracewire.show
from tracewire.cli.analyse import analyse
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.diagram.grammar import EFFECT, EVENT, INSIDE, SERIES, SETTING, STATEMENT, TOP
from tracewire.formula import QUANTITIES

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))
PROMISES = (DOCS / "promises.md").read_text(encoding="utf-8")
DIAGRAMS = (DOCS / "diagrams.md").read_text(encoding="utf-8")
ITEM = re.compile(r"^- \[(.+?)\]\(\.\./(.+?)\):((?:[^\n]|\n  )+)", re.MULTILINE)


def kept() -> list[tuple[str, str]]:
    """(file, test) of every test that the page names."""
    return [
        (file, name)
        for shown, file, names in ITEM.findall(PROMISES)
        for name in re.findall(r"`(test_\w+)`", names)
        if shown == file
    ]


def test_every_promise_names_its_tests() -> None:
    parts = PROMISES.split("\n## ")[1:]
    assert len(parts) >= 6
    assert [part.splitlines()[0] for part in parts if not ITEM.search(part)] == []
    assert len(kept()) == PROMISES.count("`test_")


@pytest.mark.parametrize(("file", "name"), kept())
def test_a_test_that_is_named_exists(file: str, name: str) -> None:
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_of_the_pages_lead_to_files(page: Path) -> None:
    links = [link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text("utf-8"))]
    local = [link for link in links if link and "://" not in link]
    assert local
    assert [link for link in local if not (page.parent / link).exists()] == []


def test_every_section_and_key_is_on_the_page() -> None:
    keys = {*TOP, *INSIDE, *SERIES, *EFFECT, *EVENT}
    assert {key for key in keys if f"`{key}`" not in DIAGRAMS} == set()


def test_every_quantity_and_key_of_a_statement_is_on_the_page() -> None:
    page = (DOCS / "quantities.md").read_text(encoding="utf-8")
    assert [name for name in QUANTITIES if f"| `{name}(" not in page] == []
    keys = {*STATEMENT, *SETTING, "full", "diagram"}
    assert {key for key in keys if f"`{key}`" not in page} == set()


def test_each_kind_of_analysis_is_on_the_page_with_its_function() -> None:
    page = (DOCS / "analyse.md").read_text(encoding="utf-8")
    table = re.findall(r"^\| `(\w+)` \| `([\w.]+)` \| a (\w+) \|$", page, re.MULTILINE)
    kinds = [
        command.callback.__name__ for command in analyse.registered_commands if command.callback
    ]
    assert [kind for kind, _, _ in table] == kinds
    for _, function, of in table:
        name = function.removeprefix("tw.").removeprefix("tracewire.show.")
        found = getattr(tw if function.startswith("tw.") else tracewire.show, name)
        assert next(iter(inspect.signature(found).parameters)) == of


def rows() -> list[tuple[str, str]]:
    """(section, example) of the first table."""
    table = DIAGRAMS.split("\n## ")[0]
    return re.findall(r"^\| `(\w+)` \|.*\| `(.+)` \|$", table, re.MULTILINE)


def example(part: str) -> str:
    """The first block of YAML on the page with this part."""
    return next(
        text for text in re.findall(r"```yaml\n(.*?)```", DIAGRAMS, re.DOTALL) if part in text
    )


@pytest.mark.parametrize(("part", "file"), [("extends: servo.yaml", "servo_without_friction.yaml")])
def test_an_example_is_a_diagram_of_the_gallery(part: str, file: str) -> None:
    whole = (ROOT / "diagrams" / "gallery" / file).read_text(encoding="utf-8")
    lines = [line.split("  #")[0].rstrip() for line in whole.splitlines()]
    assert example(part).splitlines() == [line for line in lines if not line.startswith("#")]


def test_the_example_of_variants_is_in_the_gallery() -> None:
    whole = (ROOT / "diagrams/gallery/cart_with_variants.yaml").read_text(encoding="utf-8")
    assert example("variants:") in whole


def test_the_example_of_a_subsystem_that_extends_another_one_is_one(tmp_path: Path) -> None:
    part = """
subsystems:
  cart:
    inputs: [u]
    outputs: [x]
    blocks:
      x: {type: integrator, of: v, unit: m}
      v: {type: integrator, of: force, unit: m/s}
      spring: {type: gain, of: x, k: -2}
      force: {type: sum, of: [spring, u]}
"""
    (tmp_path / "parts.yaml").write_text(part, encoding="utf-8")
    text = example("extends: cart") + "inputs: [u]\nblocks: {one: {type: rough_cart, u: u}}\n"
    assert len(compile(read_text(text, tmp_path / "a.yaml")).flat.states) == 2


def test_a_diagram_built_in_python_is_written_as_the_page_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code = re.findall(r"```python\n(.*?)```", DIAGRAMS, re.DOTALL)[0]
    exec(code, {})
    assert Path("built_cart.yaml").read_text(encoding="utf-8") == example("# Built in Python.")


def test_the_examples_are_a_diagram(tmp_path: Path) -> None:
    """All examples at once, with what they name beside them."""
    examples = dict(rows())
    for elsewhere in ("include", "extends", "remove", "measured", "blocks"):
        del examples[elsewhere]
    assert len(examples) == 13
    text = "\n".join(examples.values()).replace("{k:", "{m: 1, c: 1, limit: 1, k:")
    blocks = re.findall(r"blocks: \{(.+)\}", dict(rows())["blocks"])[0]
    text += f"\nblocks:\n  {blocks}\n  v: {{type: integrator, of: force}}\n"
    text += "  force: {type: expression, formula: F - k*x - c*v}\n"
    table = example("type: table")
    (tmp_path / "lift.csv").write_text("speed,force\n0,0\n1,2\n", encoding="utf-8")
    assert compile(read_text(text + table, tmp_path / "a.yaml")).flat.states
