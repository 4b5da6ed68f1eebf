"""Places at which a trace tries nothing are said in words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tracewire.compile import compile
from tracewire.diagram import read, read_text
from tracewire.residual import Measured
from tracewire.trace.candidates.places import describe_untried, find_places
from tracewire.trace.options import TraceOptions
from tracewire.trace.trace import set_up_search


def test_a_row_of_sums_is_no_place_and_that_is_said() -> None:
    text = """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: f_1}
          f: {type: sum, of: [x, -v], replicate: 2}
        """
    model = compile(read_text(text), backend="quick")
    assert find_places(model) == []
    assert describe_untried(model, []) == [
        "nothing is tried at the sums 'f': they are a row of blocks"
    ]


def test_what_cannot_be_tried_at_a_place_is_said() -> None:
    model = compile(
        read_text(
            """
            inputs: {u: {default: 0}}
            blocks:
              h: {type: integrator, of: flow}
              flow: {type: sum, of: [u, -h]}
              x: {type: sum, of: [u], place: {q: u}}
            """
        )
    )
    flow, position = describe_untried(model, find_places(model))
    assert "'x' has no rate: " in flow + position
    assert (
        "are not tried there; name it, as in `place: {v: SIGNAL}`, where there is one"
        in position + flow
    )
    assert "'flow' has no coordinate: " in position + flow


def test_subsystems_that_get_no_effect_are_said(tmp_path: Path) -> None:
    body = """
    outputs: [x]
    blocks:
      x: {type: integrator, of: v}
      v: {type: integrator, of: force}
      force: {type: sum, of: [-x]}
"""
    (tmp_path / "parts.yaml").write_text(f"subsystems:\n  shipped:{body}", encoding="utf-8")
    file = tmp_path / "top.yaml"
    twice = body.replace("    outputs", "    variants: {a: {}, b: {}}\n    outputs")
    file.write_text(
        "include: parts.yaml\nparameters: {law: 1}\nsubsystems:\n"
        f"  own:{body}  pair:{body}  link:{body}  law_of:{twice}"
        """blocks:
  own: {type: own}
  left: {type: pair}
  right: {type: pair}
  chain: {type: link, replicate: 3}
  part: {type: shipped}
  chosen: {type: law_of, variant: law}
""",
        encoding="utf-8",
    )
    model = compile(read(file))
    assert describe_untried(model, find_places(model)) == [
        "nothing is tried at sums inside 'left', 'right': several blocks are made from 'pair'",
        "nothing is tried at sums inside 'chain': it is a row of blocks",
        "nothing is tried at sums inside 'chosen': a parameter chooses its body",
    ]


def test_a_place_with_both_is_not_talked_about() -> None:
    text = """
        blocks:
          x: {type: integrator, of: v}
          v: {type: integrator, of: force}
          force: {type: sum, of: [-x]}
        """
    model = compile(read_text(text))
    assert describe_untried(model, find_places(model)) == []


def test_a_sum_that_has_a_rate_and_no_coordinate_is_a_place_as_others() -> None:
    """A trace of a tank or a heater tries effects there, and must not say that it does not."""
    text = "blocks: {v: {type: integrator, of: a, start: 1}, a: {type: sum, of: [-v]}}"
    t = np.linspace(0, 5, 101)
    swing = Measured("run", "train", t, {"v": np.exp(-t)}, start={"v": None})
    model = compile(read_text(text))
    search = set_up_search(model, [swing], 1e-6, lambda words: None, TraceOptions())
    assert [place.name for place in search.places] == ["a"]
    assert not [words for words in search.words if "nothing is tried" in words]
