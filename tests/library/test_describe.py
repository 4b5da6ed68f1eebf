"""What is told about blocks: a table of all, one in full, and the same for programs."""

from __future__ import annotations

import pytest
from library.values import library
from tracewire.errors import BlockError
from tracewire.library import (
    Block,
    Input,
    Library,
    Output,
    Parameter,
    State,
    describe,
    describe_json,
    palette,
)

LAG = Block(
    "lag",
    "A lag of first order.",
    inputs=(
        Input("of", "m", "what is followed"),
        Input("more", many=True),
        Input("u", default="t"),
    ),
    parameters=(
        Parameter("T", "s", "time constant", low=0.0),
        Parameter("start", default=0.5, low=-1.0, high=1.0),
        Parameter("top", default="2*T", high=9.0),
        Parameter("points", kind="points"),
    ),
    states=(State("x", "(of - x)/T", "start", "m"),),
    outputs=(Output("y", "x", "m", "follows"), Output("z", "of + sum(more) + u", doc="all")),
    source="A book, Eq 1.",
)
OWN = Library({"lag": LAG}, {"lag": "filters"})


def test_the_palette_has_a_row_for_each_block_in_the_order_of_families() -> None:
    head, *rows = palette(library()).splitlines()
    assert head.split() == ["family", "block", "what", "it", "is"]
    assert [row.split()[1] for row in rows] == [
        name for _, name in sorted((family, name) for name, family in library().families.items())
    ]
    assert len({row.find(library()[row.split()[1]].doc) for row in rows}) == 1


def test_a_block_is_described_in_full() -> None:
    assert describe(OWN, "lag").splitlines() == [
        "lag: A lag of first order.",
        "",
        "inputs",
        "  of    [m]  a wire                                 what is followed",
        "  more       one wire or several, each with a sign",
        "  u          a wire; not connected: t",
        "",
        "parameters",
        "  T       [s]  must be given, at least 0         time constant",
        "  start        default 0.5, -1 to 1",
        "  top          default 2*T, at most 9",
        "  points       must be given, a table of points",
        "",
        "states",
        "  x  [m]  rate = (of - x)/T  start = start",
        "",
        "outputs",
        "  y  [m]  no feedthrough                  follows",
        "  z       depends at once on of, more, u  all",
        "",
        "formulas",
        "  y = x",
        "  z = of + sum(more) + u",
        "",
        "Source: A book, Eq 1.",
        f"Declared in {LAG.place}.",
    ]


def test_an_effect_says_what_a_trace_may_do_with_it() -> None:
    viscous = "An effect that a trace tries: coefficient c, positive only; rate reads the rate of"
    assert viscous in describe(library(), "viscous")
    assert "tries: coefficient level, of either sign." in describe(library(), "bias")
    assert "An effect" not in describe(library(), "gain")
    assert (
        "of reads the coordinate of the place;"
        " shape gap first 0.1, 0.25, 0.5 times the largest |q| of the place."
    ) in describe(library(), "backlash")
    assert (
        "tries at the drive: coefficient tau, positive only, first 2, 6, 20, 60, 200 times the"
        " sample interval;"
    ) in describe(library(), "drive_lag")
    assert (
        "shape period first 0.333, 0.25, ..., 0.0167 (58 values) times the duration of the longest"
        " series; shape phase first 0, 1.57."
    ) in describe(library(), "harmonic")


def test_an_expression_depends_on_what_its_formula_reads() -> None:
    assert "depends at once on what 'formula' reads" in describe(library(), "expression")


def test_a_program_is_told_the_same() -> None:
    told = describe_json(OWN, "lag")
    assert told["family"] == "filters"
    assert told["effect"] is None
    assert told["source"] == "A book, Eq 1."
    assert told["outputs"] == [
        {
            "name": "y",
            "formula": "x",
            "unit": "m",
            "doc": "follows",
            "unit_of": "",
            "factor": "",
            "feedthrough": [],
        },
        {
            "name": "z",
            "formula": "of + sum(more) + u",
            "unit": "",
            "doc": "all",
            "unit_of": "",
            "factor": "",
            "feedthrough": ["of", "more", "u"],
        },
    ]
    effect = describe_json(library(), "viscous")["effect"]
    assert effect == {
        "coefficient": "c",
        "inputs": {"rate": "v"},
        "sign": 1,
        "shapes": {},
        "place": "sum",
        "at": None,
        "alias": [],
        "lacking": [],
        "both_signs": [],
        "near_rest": [],
    }
    effect = describe_json(library(), "backlash")["effect"]
    assert isinstance(effect, dict)
    assert effect["shapes"]["gap"] == {
        "at": (0.1, 0.25, 0.5), "of": "Q", "low": 0.0, "least": 0.01, "most": 1.0, "wave": False,
        "line": False, "modulates": "", "fixed": False,
    }  # fmt: skip
    effect = describe_json(library(), "drive_lag")["effect"]
    assert isinstance(effect, dict)
    assert (effect["place"], effect["at"]["of"]) == ("drive", "dt")


@pytest.mark.parametrize("tell", [describe, describe_json])
def test_a_block_that_does_not_exist_is_answered_with_the_nearest(tell: object) -> None:
    assert callable(tell)
    with pytest.raises(BlockError, match=r"unknown block 'viscos'; .*Did you mean 'viscous'\?"):
        tell(library(), "viscos")
