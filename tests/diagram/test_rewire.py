"""A block put between a drive and its readers: the text changes where it must, and only there."""

from __future__ import annotations

import pytest
from tracewire.diagram import difference, read_text
from tracewire.diagram.rewire import add_to_drive, rewired
from tracewire.errors import DiagramError, OptionError

GAIN = "{type: drive_gain, of: u, gain: 0.1}"
MANY = """\
inputs: {u: {unit: N, default: 0}}
blocks:
  x: {type: integrator, of: v}   # u stays here: a comment
  v: {type: integrator, of: force}
  force: {type: sum, of: [spring, "-u", e]}   # the sum
  spring: {type: expression, formula: "-4*x - 0.1*v*abs(u)"}
  e:
    type: expression
    formula: >
      min(u, 1) +
      2*u
  both: {type: dot, of: pair, other: pair}
  pair: {type: solve, matrix: [[1, u], [0, 1]], right: [u, x]}
  inside: {type: half, u: u}
subsystems:
  half: {inputs: [u], outputs: {y: y}, blocks: {y: {type: gain, of: u, k: 0.5}}}
events:
  - {when: u - x, set: {v: -u*v}}
"""


def test_the_only_sum_that_reads_a_drive_gets_the_block_with_its_sign() -> None:
    text = """\
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: slack}
  u: {type: sine, amplitude: 1, omega: 2}   # the drive
  slack: {type: sum, of: [-u, x]}
"""
    old = read_text(text)
    new = add_to_drive(old, "u", "drive_gain", GAIN)
    assert difference(old, new).splitlines()[3:] == [
        "   u: {type: sine, amplitude: 1, omega: 2}   # the drive",
        "-  slack: {type: sum, of: [-u, x]}",
        "+  slack: {type: sum, of: [-u, x, -drive_gain]}",
        "+  drive_gain: {type: drive_gain, of: u, gain: 0.1}",
    ]
    again = add_to_drive(new, "u", "drive_lag", "{type: drive_lag, of: u, tau: 1}")
    assert "of: [-u, x, -drive_gain, -drive_lag]" in again.text


def test_several_readers_read_the_sum_of_the_drive_and_the_block() -> None:
    old = read_text(MANY)
    new = add_to_drive(old, "u", "drive_gain", GAIN)
    removed = [line for line in difference(old, new).splitlines()[2:] if line.startswith("-")]
    added = [line for line in difference(old, new).splitlines()[2:] if line.startswith("+")]
    assert [line[1:].replace("u_seen", "u") for line in added if "of: [u, " not in line] == [
        *(line[1:] for line in removed[:1]),
        "  drive_gain: {type: drive_gain, of: u, gain: 0.1}",
        *(line[1:] for line in removed[1:]),
    ]
    assert "  u_seen: {type: sum, of: [u, drive_gain]}\n" in new.text
    assert "  inside: {type: half, u: u_seen}\n" in new.text
    assert "[[1, u_seen], [0, 1]], right: [u_seen, x]" in new.text
    assert "# u stays here: a comment" in new.text
    expected = rewired(old, "u", "u_seen")
    for name, use in expected.blocks.items():
        assert new.blocks[name].settings.keys() == use.settings.keys()


def test_a_second_block_joins_the_first() -> None:
    once = add_to_drive(read_text(MANY), "u", "drive_gain", GAIN)
    twice = add_to_drive(once, "u", "drive_lag", "{type: drive_lag, of: u, tau: 1}")
    assert "  u_seen: {type: sum, of: [u, drive_gain, drive_lag]}\n" in twice.text
    assert twice.text.count("u_seen:") == 1


def test_a_drive_that_nothing_reads_is_refused() -> None:
    text = "inputs: {u: {default: 0}}\nblocks: {x: {type: constant, value: 1}}\n"
    with pytest.raises(OptionError, match="drive that something reads 'u'"):
        add_to_drive(read_text(text), "u", "drive_gain", GAIN)


def test_a_name_that_is_taken_is_refused() -> None:
    with pytest.raises(DiagramError, match="spring"):
        add_to_drive(read_text(MANY), "u", "spring", GAIN)
