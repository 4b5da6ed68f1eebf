"""Logic blocks: tables of truth, and pulses at exactly located times."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from solve.logs import METHODS, TIGHT
from solve.models import run
from tracewire.solve import Run

END = 4.0


def logic(blocks: str, every: float = 0.25, record: str = "y") -> Run:
    """A run of blocks that may read three pulse trains of halves of 1, 2 and 4 s, shifted."""
    trains = "".join(
        f"  {name}: {{type: pulse, amplitude: 1, period: {2**n}, at: -0.1}}\n"
        for n, name in enumerate("abc")
    )
    return run(
        f"span: [0, {END}]\nevery: {every}\nblocks:\n  now: {{type: time}}\n{trains}{blocks}\n"
        f"record: [a, b, c, {record}]"
    )


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("and", lambda bits: all(bits)),
        ("or", lambda bits: any(bits)),
        ("xor", lambda bits: sum(bits) % 2 == 1),
    ],
)
def test_and_or_xor_have_their_tables_of_truth(name: str, truth: object) -> None:
    assert callable(truth)
    result = logic(f"  y: {{type: {name}, of: [a, b, c]}}")
    rows = list(zip(result["a"], result["b"], result["c"], strict=True))
    assert set(rows) == set(product((0.0, 1.0), repeat=3))
    assert result["y"].tolist() == [float(truth(row)) for row in rows]


def test_and_takes_the_elements_of_a_vector() -> None:
    result = logic("  v: {type: mux, of: [a, b]}\n  y: {type: and, of: [v, c]}")
    assert result["y"].tolist() == (result["a"] * result["b"] * result["c"]).tolist()


def test_not_turns_round() -> None:
    result = logic("  y: {type: not, of: b}")
    assert result["y"].tolist() == (1 - result["b"]).tolist()


def test_compare_jumps_where_signals_meet() -> None:
    result = logic(
        "  s: {type: sine, amplitude: 1, omega: 1}\n  y: {type: compare, of: s, level: 0.5}"
    )
    assert result["y"].tolist() == (np.sin(result.t) >= 0.5).astype(float).tolist()
    times = [e.time for e in result.events if e.block == "y"]
    assert times == pytest.approx([np.pi / 6, 5 * np.pi / 6], abs=1e-9)
    other = logic("  y: {type: compare, of: a, other: b}")
    assert other["y"].tolist() == (other["a"] >= other["b"]).astype(float).tolist()


def test_select_takes_the_signal_of_an_index() -> None:
    result = logic(
        "  i: {type: sum, of: [a, b]}\n  y: {type: select, index: i, of: [now, -now, c]}"
    )
    choices = np.stack([result.t, -result.t, result["c"]])
    index = (result["a"] + result["b"]).astype(int)
    assert result["y"] == pytest.approx(choices[index, np.arange(len(index))])


def test_min_and_max_take_several_signals() -> None:
    blocks = (
        "  y: {type: min, of: a, other: [b, -now]}\n  z: {type: max, of: a, other: [b, c, -now]}"
    )
    result = logic(blocks, record="y, z")
    rows = np.stack([result["a"], result["b"], -result.t])
    assert result["y"] == pytest.approx(rows.min(axis=0))
    assert result["z"] == pytest.approx(np.stack([*rows, result["c"]]).max(axis=0))


def test_edge_is_one_for_a_sample_behind_each_rise() -> None:
    result = logic("  y: {type: edge, of: a, period: 0.25}")
    bits = result["a"]
    rises = (bits > 0.5) & (np.r_[1.0, bits[:-1]] < 0.5)
    assert result["y"].tolist() == rises.astype(float).tolist()


def test_monostable_is_one_for_its_duration() -> None:
    result = logic(
        "  y: {type: monostable, of: b, duration: 0.3}\n  x: {type: integrator, of: y}",
        record="y, x",
    )
    # b rises at 1.9 and 3.9; it is on already at the start, which is no rise
    area = np.clip(result.t - 1.9, 0, 0.3) + np.clip(result.t - 3.9, 0, 0.3)
    assert result["x"] == pytest.approx(area, abs=1e-9)


def test_a_rise_during_a_pulse_of_a_monostable_makes_it_longer() -> None:
    result = logic(
        "  y: {type: monostable, of: a, duration: 1.2}\n  x: {type: integrator, of: y}",
        record="y, x",
    )
    assert result["x"] == pytest.approx(np.clip(result.t - 0.9, 0, None), abs=1e-9)


def test_timer_counts_from_each_rise() -> None:
    result = logic("  y: {type: timer, of: b}")
    t = result.t
    exact = np.select([t < 0.9, t < 1.9, t < 2.9, t < 3.9], [t, 0 * t, t - 1.9, 0 * t], t - 3.9)
    assert result["y"] == pytest.approx(exact, abs=1e-9)


def test_jk_flip_flop_sets_resets_and_turns() -> None:
    result = run("""
span: [0, 7.5]
every: 0.5
blocks:
  clock: {type: pulse, amplitude: 1, period: 1, at: 0.75}
  j: {type: table, points: [[0, 0], [0.9, 0], [1, 1], [1.9, 1], [2, 0], [3.9, 0], [4, 1]]}
  k: {type: table, points: [[0, 0], [2.9, 0], [3, 1]]}
  y: {type: jk_flip_flop, j: j, k: k, clock: clock}
record: [y]
""")
    # rises at 0.75 (keep), 1.75 (set), 2.75 (keep), 3.75 (reset), 4.75, 5.75, 6.75 (turn)
    expected = {0: 0, 1: 0, 2: 1, 3: 1, 4: 0, 5: 1, 6: 0, 7: 1}
    assert result["y"][::2].tolist() == [float(expected[k]) for k in range(8)]


@pytest.mark.parametrize("method", METHODS)
def test_debounce_follows_what_keeps_its_side_for_its_duration(method: str) -> None:
    """A contact that bounces twice at 1 s, closes at 1.25 s, and bounces open at 3 s."""
    times = [1, 1.05, 1.1, 1.2, 1.25, 3, 3.1]
    points = [float(t) for t in times for _ in (0, 1)]
    result = run(
        f"""
span: [0, 4]
every: 0.01
blocks:
  of: {{type: signal_builder, times: {points}, values: [0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1]}}
  y: {{type: debounce, of: of, duration: 0.3}}
  open: {{type: expression, formula: 1 - of}}
  late: {{type: debounce, of: open, duration: 0.3, start: 1}}
  once: {{type: debounce, of: of, duration: 0.08}}
record: [y, late, once]
""",
        method=method,
        **TIGHT,
    )
    t = result.t
    near = np.min(np.abs(t[:, None] - [1.55, 1.18, 1.33, 3.08, 3.18]), axis=1) < 1e-9
    y = (t >= 1.55) * 1.0
    once = ((t >= 1.18) & (t < 3.08) | (t >= 3.18)) * 1.0
    assert result["y"][~near].tolist() == y[~near].tolist()
    assert result["late"][~near].tolist() == (1 - y)[~near].tolist()
    assert result["once"][~near].tolist() == once[~near].tolist()
    settled = [e.time for e in result.events if e.block == "y" and "settled" in e.guard + e.kind]
    assert settled in ([], pytest.approx([1.55], abs=1e-9))
