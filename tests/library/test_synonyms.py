"""Names of other tools: each finds the block that it is here, or says what to use instead."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from library.values import library
from tracewire.diagram import read_text
from tracewire.errors import BlockError, DiagramError
from tracewire.library import describe, describe_json, find_instead, find_synonym
from tracewire.library.synonyms import INSTEAD, NAMES, plain

TEACHERS = {
    "transfer_function": "transfer_function",
    "pid": "pid",
    "derivative": "derivative",
    "state_space": "state_space",
    "noise": "noise",
    "quantizer": "quantizer",
    "lookup_table": "table",
    "delay": "delay",
    "unit_delay": "unit_delay",
    "and": "and",
    "pulse": "pulse",
    "chirp": "chirp",
    "sawtooth": "sawtooth",
}
"""The names that teachers reach for first."""


COMMON = [
    "INTEGRAL_m",
    "GAINBLK_f",
    "SUMMATION",
    "BIGSOM_f",
    "CONST_m",
    "PRODUCT",
    "GENSIN_f",
    "GENSQR_f",
    "STEP_FUNCTION",
    "RAMP",
    "SATURATION",
    "DEADBAND",
    "HYSTHERESIS",
    "BACKLASH",
    "SWITCH2_m",
    "MUX",
    "DEMUX",
    "CLR",
    "DLR",
    "CLSS",
    "TIME_DELAY",
    "DOLLAR",
    "SAMPHOLD_m",
    "QUANT_f",
    "RELATIONALOP",
    "EXPRESSION",
    "SINBLK_f",
    "ABS_VALUE",
    "LOOKUP_f",
    "CSCOPE",
    "CLOCK_c",
]
"""What a diagram of a driven and controlled mechanism is made of in Xcos."""


def test_28_of_31_common_blocks_of_xcos_are_known_by_their_names() -> None:
    known = [name for name in COMMON if find_synonym(name, [*library()])]
    assert (len(COMMON), len(known) >= 28) == (31, True)
    assert all(find_instead(name) for name in COMMON if name not in known)


PALETTE = [
    "ANDBLK",
    "BIGSOM_f",
    "CMSCOPE",
    "CONST_m",
    "CONVERT",
    "CSCOPXY",
    "DEMUX",
    "DOLLAR_f",
    "INTEGRAL_f",
    "IN_f",
    "LOGICAL_OP",
    "MUX",
    "NRMSOM_f",
    "OUT_f",
    "PRODUCT",
    "RELATIONALOP",
    "SATURATION",
    "SWITCH2_m",
    "TEXT_f",
]
"""Xcos's own palette of commonly used blocks: help of Scilab 2023.1, Commonlyusedblocks_pal."""


def test_each_block_of_the_palette_of_common_ones_of_xcos_is_known_or_explained() -> None:
    assert len(PALETTE) == 19
    known = [*library()]
    assert not [
        name for name in PALETTE if not find_synonym(name, known) and not find_instead(name)
    ]


def test_there_are_at_least_160_blocks() -> None:
    assert len([*library()]) >= 160


@pytest.mark.parametrize("name", TEACHERS)
def test_the_names_that_teachers_reach_for_first_are_known(name: str) -> None:
    assert f"\n{TEACHERS[name]}: " in "\n" + describe(library(), name)


def test_every_synonym_is_of_a_block_and_of_one_alone() -> None:
    assert NAMES.keys() <= set(library())
    several = {
        block: {plain(n) for names in tools.values() for n in names.split(", ")}
        for block, tools in NAMES.items()
    }
    claimed: dict[str, str] = {}
    for block, names in several.items():
        for name in names:
            assert claimed.setdefault(name, block) == block, name
            assert name == plain(block) or name not in map(plain, library()), name
    words = {plain(n) for names in INSTEAD for n in names.split(", ")}
    assert not words & claimed.keys()
    assert not words & set(map(plain, library()))


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("INTEGRAL_m", "Xcos's INTEGRAL_m is 'integrator' here.\n\nintegrator: The integral"),
        ("transfer fcn", "Simulink's Transfer Fcn is 'transfer_function' here.\n\ntransfer_fun"),
        ("LimPID", "Modelica's LimPID is 'pid' here.\n\npid: "),
        ("Pulse", "Modelica's Pulse is 'pulse' here.\n\npulse: "),
        ("Transport Delay", "Simulink's Transport Delay is 'delay' here.\n\ndelay: "),
        ("ZERO-ORDER HOLD", "Modelica's ZeroOrderHold is 'zero_order_hold' here.\n\nzero_"),
        ("Dead_Zone", "Simulink's Dead Zone is 'dead_zone' here."),
        ("bouncing body", "'bouncing body' is 'bouncing_body' here.\n\nbouncing_body: "),
    ],
)
def test_a_block_is_described_by_a_name_of_another_tool(name: str, told: str) -> None:
    assert describe(library(), name).startswith(told)


def test_a_name_that_means_something_else_elsewhere_is_explained() -> None:
    told = describe(library(), "BACKLASH")
    assert "The Backlash of Simulink and Xcos is 'play_operator' here" in told


def test_a_description_names_the_block_in_other_tools() -> None:
    assert "Also known as Simulink" not in describe(library(), "integrator")
    assert "INTEGRAL_m, INTEGRAL_f (Xcos)" in describe(library(), "integrator")
    assert "Transfer Fcn, Zero-Pole (Simulink)" in describe_json(library(), "tf")["also_known_as"]  # type: ignore[operator]


def test_what_is_no_block_is_told_what_to_use() -> None:
    with pytest.raises(BlockError) as caught:
        describe(library(), "preisach")
    assert str(caught.value) == f"'preisach' is no block. {find_instead('preisach')}"
    assert "include: tracewire:hysteresis.yaml" in find_instead("Preisach")
    assert find_instead("nonsense") == ""
    assert find_synonym("nonsense", [*library()]) is None


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("INTEGRAL_m", "Xcos's INTEGRAL_m is 'integrator' here."),
        ("preisach", "Write include: tracewire:hysteresis.yaml, which has it as a subsystem."),
        ("Logical Operator", "Use 'and', 'or', 'xor' or 'not'."),
    ],
)
def test_an_unknown_type_of_a_diagram_says_what_it_is_here(name: str, told: str) -> None:
    text = f"blocks:\n  y: {{type: {name}, of: u}}\n  u: {{type: time}}\n"
    with pytest.raises(DiagramError) as caught:
        read_text(text)
    what = f"<text>:2:13: block 'y': unknown block type '{name}'. {told}"
    assert str(caught.value).startswith(what)


def test_a_subsystem_may_have_the_name_of_a_block_of_another_tool() -> None:
    text = """
blocks:
  u: {type: time}
  y: {type: PID, of: u}
subsystems:
  PID: {inputs: [of], outputs: {y: double}, blocks: {double: {type: gain, of: of, k: 2}}}
"""
    assert read_text(text).blocks["y"].subsystem is not None


def test_the_page_of_names_is_made_of_the_table_and_the_declarations() -> None:
    page = Path(__file__).parents[2] / "blocks" / "README.md"
    made = subprocess.run(
        [sys.executable, "-m", "tracewire.library"], capture_output=True, check=True
    ).stdout.decode()
    assert page.read_text(encoding="utf-8").splitlines() == made.splitlines()
    assert re.search(r"\| \[integrator\]\(linear.py\) \|.*\| INTEGRAL_m, INTEGRAL_f \|", made)
