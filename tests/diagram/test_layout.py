"""The canonical layout: what it changes, what it leaves alone, and that the meaning stays."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random

import pytest
from diagram.whole import WHOLE
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.diagram import lay_out
from tracewire.diagram.files import load_text
from tracewire.diagram.problems import Problems
from tracewire.diagram.strict import Entries, Items, Node, Scalar, compose
from tracewire.errors import DiagramError
from tracewire.shipped import shipped

SHIPPED = sorted(shipped("diagrams").rglob("*.yaml"))
UGLY = """\


# header
blocks:   # blocks
    # the angle
    theta:    {type:  integrator,of: omega ,start: {value: 80,   unit: 'deg'}, unit: "rad" }
    omega: { type: integrator, of: torque,
        unit: rad/s ,   # the rate
        # own line
        label: 'ω'
        }


    torque:
        type: "sum"
        of:
        - height   # one
        # two
        - '-friction'
        # end of list
    # end of blocks
    height: {type: gain, of: theta, k: -w0}
    friction: {type: viscous, rate: omega, c: 'c'}\t
# of the span
span: [ 0,
   20 ]
title:    |
      A title
        of lines

      and more

events:
-   when: theta - 1
    set: {omega: "max(omega, 0)"}
- {when: theta + 1, set: {omega: '0'}}
parameters: {w0: 63, c: {value: 0.05}, 'k' : "1"}
record:
 - theta
 - "omega"
# the end
"""
LAID_OUT = """\
# header
title: |
  A title
    of lines

  and more
# of the span
span: [0,
  20]
record:
  - theta
  - omega
parameters: {w0: 63, c: {value: 0.05}, k: "1"}
blocks:   # blocks
  # the angle
  theta: {type: integrator, of: omega, start: {value: 80, unit: deg}, unit: rad}
  omega: {type: integrator, of: torque,
    unit: rad/s,        # the rate
    # own line
    label: ω
  }

  torque:
    type: sum
    of:
      - height     # one
      # two
      - -friction
      # end of list
  # end of blocks
  height: {type: gain, of: theta, k: -w0}
  friction: {type: viscous, rate: omega, c: c}

events:
  - when: theta - 1
    set: {omega: "max(omega, 0)"}
  - {when: theta + 1, set: {omega: "0"}}
# the end
"""


def meaning(node: Node, top: bool = True) -> object:
    """What a node says, without its places; the order of the sections says nothing."""
    if isinstance(node, Scalar):
        return node.text, node.number
    if isinstance(node, Items):
        return [meaning(item, False) for item in node.items]
    assert isinstance(node, Entries)
    pairs = [(name, meaning(value, False)) for name, _, value in node]
    return dict(pairs) if top else pairs


def meaning_of(text: str) -> object:
    return meaning(compose(text, Path("a.yaml"), Problems()))


def test_what_it_does() -> None:
    assert lay_out(UGLY) == LAID_OUT
    assert lay_out(LAID_OUT) == LAID_OUT


def test_comments_stay() -> None:
    comments = re.findall("#.*", UGLY)
    assert sorted(re.findall("#.*", lay_out(UGLY))) == sorted(comments)


def test_every_shipped_diagram_is_laid_out() -> None:
    assert [file for file in SHIPPED if lay_out(load_text(file)) != load_text(file)] == []


def test_line_ends_and_byte_order_mark_stay() -> None:
    text = "\ufeff" + UGLY.replace("\n", "\r\n")
    assert lay_out(text) == "\ufeff" + LAID_OUT.replace("\n", "\r\n")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("a: 'it''s'\n", 'a: "it\'s"\n'),
        ("a: 'a \"b\"'\n", "a: 'a \"b\"'\n"),
        ("a: 'yes'\n", 'a: "yes"\n'),
        ("a: '010'\n", 'a: "010"\n'),
        ('a: "q[1]"\n', 'a: "q[1]"\n'),
        ('a: "-k*x"\n', "a: -k*x\n"),
        ('a: "2*k"\n', 'a: "2*k"\n'),
        ("a: 'x: y'\n", 'a: "x: y"\n'),
        ("a: {}\nb: [ ]", "a: {}\nb: []\n"),
        ("a: [b: 1, c]\n", "a: [b: 1, c]\n"),
        ("a: [1, 2 ,]\n", "a: [1, 2,]\n"),
        ("---\na:\n    - - 1\n      - 2\n", "---\na:\n  - - 1\n    - 2\n"),
        ("a:\n    one two\n      three\n", "a:\n  one two\n  three\n"),
        ("a: >-\n    one\n     two\n\n\nb: 1\n", "a: >-\n  one\n   two\n\nb: 1\n"),
        ("a: |+\n    one\n\n\nb: 1\n", "a: |+\n  one\n\n\nb: 1\n"),
        ("a:\n   b: |2\n        one\n", "a:\n  b: |2\n       one\n"),
        ("a: |  # why\n   one\n", "a: |  # why\n  one\n"),
    ],
)
def test_quotes_and_text_blocks(text: str, found: str) -> None:
    assert lay_out(text) == found
    assert meaning_of(found) == meaning_of(text)


@settings(max_examples=40)
@given(st.integers(1, 4), st.integers())
def test_any_blanks_give_the_same_layout_and_meaning(factor: int, seed: int) -> None:
    """Blanks behind signs and at line ends, empty lines, and wider levels are all undone."""
    lines = []
    random = Random(seed)
    for line in WHOLE.splitlines():
        body = line.lstrip(" ")
        blanks = random.randrange(4)
        if "#" not in body:
            body = re.sub(r"(?<=[,{\[])(?= ?[^\"]*$)", " " * blanks, body) + " " * blanks
        lines.append(" " * (factor * (len(line) - len(line.lstrip(" ")))) + body)
        lines += [""] * (random.random() < 0.1) * 2
    text = "\n".join(lines) + "\n"
    found = lay_out(text)
    told = [re.sub(" +#", " #", line) for line in found.splitlines() if line]
    assert told == re.sub(" +#", " #", WHOLE).splitlines()
    assert "\n\n\n" not in found
    assert lay_out(found) == found
    assert meaning_of(found) == meaning_of(text)


@settings(max_examples=60)
@given(
    st.recursive(
        st.sampled_from(["1", "a", "'b c'", '"2*k"', "-x", "on", "'#'"]),
        lambda inner: st.one_of(
            st.lists(inner, max_size=3).map(lambda found: "[" + " , ".join(found) + "]"),
            st.lists(inner, max_size=3).map(
                lambda found: "{" + ",\n  ".join(f"k{n}:  {x}" for n, x in enumerate(found)) + "}"
            ),
        ),
        max_leaves=8,
    )
)
def test_any_nesting_in_brackets_keeps_its_meaning(value: str) -> None:
    text = f"a:\n- b: {value}\n"
    found = lay_out(text)
    assert meaning_of(found) == meaning_of(text)
    assert lay_out(found) == found


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("? a\n: 1\n", "1:1: '?' cannot be laid out by program. Write 'name: value'."),
        ("%YAML 1.2\n---\na: 1\n", "1:1: '%' cannot be laid out by program"),
        ("a: 1\na: 2\n", "2:1: two definitions of 'a'"),
        ("a: [1\n", "this is not YAML"),
    ],
)
def test_what_cannot_be_laid_out_is_refused(text: str, words: str) -> None:
    with pytest.raises(DiagramError) as caught:
        lay_out(text)
    assert words in str(caught.value)
