"""Names of other tools: each finds the block that it is here, or says what to use instead."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from library.values import library
from solve.models import run
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


COMMON = {
    "INTEGRAL_m": "integrator",
    "GAINBLK_f": "gain",
    "SUMMATION": "sum",
    "BIGSOM_f": "sum",
    "CONST_m": "constant",
    "PRODUCT": "product",
    "GENSIN_f": "sine",
    "GENSQR_f": "square",
    "STEP_FUNCTION": "step",
    "RAMP": "ramp",
    "SATURATION": "saturation",
    "DEADBAND": "dead_zone",
    "HYSTHERESIS": "relay",
    "BACKLASH": "play_operator",
    "SWITCH2_m": "switch",
    "MUX": "mux",
    "DEMUX": "demux",
    "CLR": "transfer_function",
    "DLR": "discrete_transfer_function",
    "CLSS": "state_space",
    "TIME_DELAY": "delay",
    "DOLLAR": "unit_delay",
    "SAMPHOLD_m": "sample_and_hold",
    "QUANT_f": "quantizer",
    "RELATIONALOP": "compare",
    "EXPRESSION": "expression",
    "SINBLK_f": "sin",
    "ABS_VALUE": "abs",
    "LOOKUP_f": "table",
    "CSCOPE": "",
    "CLOCK_c": "",
}
"""What a diagram of a driven and controlled mechanism is made of in Xcos, and the block that does
the same. The choice is ours: Xcos counts no use. Each is in Xcos's own file of palettes,
scilab/modules/xcos/etc/palettes.xml of Scilab 2023.1, or in its help."""


def test_28_of_31_common_blocks_of_xcos_are_blocks_that_are_found_by_their_names() -> None:
    found = {name: block for name, block in COMMON.items() if block}
    assert (len(COMMON), len(found) >= 28) == (31, True)
    for name, block in found.items():
        assert block in library()
        assert f"'{block}'" in describe(library(), name) or plain(name) == plain(block)
    assert all(find_instead(name) for name in COMMON if name not in found)


PALETTE = {
    "ANDBLK": "events",
    "BIGSOM_f": "sum",
    "CMSCOPE": "record",
    "CONST_m": "constant",
    "CONVERT": "quantizer",
    "CSCOPXY": "portrait",
    "DEMUX": "demux",
    "DOLLAR_f": "unit_delay",
    "INTEGRAL_f": "integrator",
    "IN_f": "inputs",
    "LOGICAL_OP": "and",
    "MUX": "mux",
    "NRMSOM_f": "mux",
    "OUT_f": "outputs",
    "PRODUCT": "product",
    "RELATIONALOP": "compare",
    "SATURATION": "saturation",
    "SWITCH2_m": "switch",
    "TEXT_f": "label",
}
"""Xcos's own palette of commonly used blocks, and the block, section or command that does the same.

Source: 'Commonly Used Blocks' in scilab/modules/xcos/etc/palettes.xml, Scilab 2023.1. In Xcos the
sections inputs, outputs, record and events, and a label, are blocks."""
IN_ONE = """
span: [0, 4]
inputs: {u: {default: 1}}                       # IN_f
record: [x, both, late, part.y, n]   # CMSCOPE
blocks:
  one: {type: constant, value: 1, label: "a text"}
  x: {type: integrator, of: net}
  net: {type: sum, of: [u, -one, times]}
  times: {type: product, of: [one, u]}
  both: {type: mux, of: [x, one]}
  first: {type: demux, of: both, index: 0}
  late: {type: unit_delay, of: first, period: 1}
  limited: {type: saturation, of: x, low: 0, high: 2.5}
  above: {type: compare, of: limited, other: one}
  below: {type: not, of: above}
  told: {type: and, of: [above, u]}
  chosen: {type: switch, control: told, above: x, below: one, threshold: 0.5}
  rounded: {type: quantizer, of: x, interval: 1}
  part: {type: part, u: chosen}
  n: {type: integrator, of: none}
  none: {type: constant, value: 0}
subsystems:
  part: {inputs: [u], outputs: {y: twice}, blocks: {twice: {type: gain, of: u, k: 2}}}
events: [{when: told > 0.5, set: {n: n + 1}}]   # ANDBLK
"""


@pytest.mark.parametrize("name", PALETTE)
def test_each_block_of_the_palette_of_common_ones_of_xcos_is_told_in_our_words(name: str) -> None:
    ours = PALETTE[name]
    found = find_synonym(name, [*library()])
    assert found[0] == ours if found else re.search(rf"\b{ours}\b", find_instead(name))


def test_what_the_palette_of_common_blocks_does_is_done() -> None:
    assert len(PALETTE) == 19
    result = run(IN_ONE, times=[0.5, 1.5, 2.5, 3.5])
    assert result["x"] == pytest.approx([0.5, 1.5, 2.5, 3.5], abs=1e-9)
    assert result["both[0]"] == pytest.approx(result["x"])
    assert result["late"] == pytest.approx([0, 0, 1, 2], abs=1e-9)
    assert result["part.y"] == pytest.approx([2, 3, 5, 7], abs=1e-9)
    assert result["n"] == pytest.approx([0, 1, 1, 1])


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
