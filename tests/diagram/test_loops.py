from __future__ import annotations

import pytest
from diagram.small_library import made, refused


def test_a_loop_is_told_in_the_order_of_its_wires() -> None:
    text = """
blocks:
  a: {type: gain, of: d, k: 1}
  x: {type: integrator, of: a}
  d: {type: sum, of: [c, x]}
  b: {type: gain, of: a, k: 1}
  c: {type: expression, formula: 2*b}
"""
    assert "3:3: block 'a': algebraic loop: a -> b -> c -> d -> a." in refused(text)


def test_a_block_that_reads_itself_is_a_loop() -> None:
    assert "algebraic loop: a -> a." in refused("blocks: {a: {type: gain, of: a, k: 1}}")


def test_a_state_breaks_a_loop() -> None:
    made("blocks: {a: {type: gain, of: x, k: 1}, x: {type: integrator, of: a}}")


def test_only_the_output_that_reads_the_input_makes_a_loop() -> None:
    text = "blocks: {o: {type: oscillator, push: g}, g: {type: gain, of: o.%s, k: 1}}"
    made(text % "x")
    assert "algebraic loop: o -> g -> o." in refused(text % "force")


PORTS = """
blocks:
  s: {type: two, u: a, v: b}
  a: {type: gain, of: s.%s, k: 1}
  b: {type: gain, of: s.%s, k: 1}
subsystems:
  two:
    inputs: [u, v]
    outputs: {y: k, z: i, w: m}
    blocks:
      k: {type: gain, of: v, k: 2}
      i: {type: integrator, of: u}
      m: {type: gain, of: u, k: 2}
"""


@pytest.mark.parametrize(
    ("a", "b", "loop"),
    [
        ("y", "z", ""),  # a reads v through the subsystem, b reads a state: no way around
        ("z", "z", ""),
        ("y", "w", "a -> s.m -> b -> s.k -> a."),
        ("w", "z", "a -> s.m -> a."),
        ("z", "y", "b -> s.k -> b."),
    ],
)
def test_a_subsystem_is_followed_port_by_port(a: str, b: str, loop: str) -> None:
    told = refused(PORTS % (a, b))
    if not loop:
        assert told == ""
    names = loop.rstrip(".").split(" -> ")[:-1]
    turned = [" -> ".join([*names[i:], *names[: i + 1]]) for i in range(len(names))]
    assert not names or any(f"algebraic loop: {turn}." in told for turn in turned)


def test_loops_are_followed_through_two_levels_and_a_plain_passage() -> None:
    text = """
blocks: {a: {type: gain, of: o, k: 1}, o: {type: outer, u: p}, p: {type: through, u: a}}
subsystems:
  through: {inputs: [u], outputs: {y: u}, blocks: {}}
  outer: {inputs: [u], outputs: {y: i}, blocks: {i: {type: inner, u: u}}}
  inner: {inputs: [u], outputs: {y: g}, blocks: {g: {type: gain, of: u, k: 1}}}
"""
    assert "algebraic loop: a -> p.y -> o.i.g -> a." in refused(text)


def test_a_loop_inside_a_subsystem_is_told_once() -> None:
    text = """
blocks: {a: {type: s}, b: {type: s}}
subsystems: {s: {blocks: {g: {type: gain, of: h, k: 1}, h: {type: gain, of: g, k: 1}}}}
"""
    told = refused(text).splitlines()
    assert len(told) == 1
    assert "block 's.g': algebraic loop: g -> h -> g." in told[0]


def test_two_separate_loops_are_both_told() -> None:
    text = "blocks: {a: {type: gain, of: a, k: 1}, b: {type: gain, of: b, k: 1}}"
    assert len(refused(text).splitlines()) == 2


def test_loops_are_found_beside_other_mistakes() -> None:
    text = "blocks: {a: {type: sum, of: [a, zz]}, b: {type: gian}, c: {type: gain, of: b, k: 1}}"
    told = refused(text)
    assert "algebraic loop: a -> a" in told
    assert "unknown signal 'zz'" in told
    assert len(told.splitlines()) == 3


def test_a_very_long_loop_is_shown_in_part() -> None:
    lines = [f"  b{i}: {{type: gain, of: b{(i + 1) % 3000}, k: 1}}" for i in range(3000)]
    told = refused("\n".join(["blocks:", *lines]))
    assert told.count("->") == 99
    assert "b0 -> b2999 -> b2998" in told
    assert "-> ... -> b0." in told


def test_a_subsystem_that_contains_itself() -> None:
    own = "subsystem 's' contains itself: s -> s."
    assert own in refused("blocks: {}\nsubsystems: {s: {blocks: {a: {type: s}}}}")
    nested = "blocks: {}\nsubsystems: {s: {blocks: {a: {type: r}}, subsystems: {r: {blocks: {b: "
    assert "'s' contains itself: s -> r -> s." in refused(nested + "{type: s}}}}}}")


def test_subsystems_in_a_long_row_are_refused() -> None:
    lines = [f"  s{i}: {{blocks: {{a: {{type: s{i + 1}}}}}}}" for i in range(40)]
    text = "\n".join(["blocks: {a: {type: s0}}", "subsystems:", *lines, "  s40: {blocks: {}}"])
    assert "subsystems stand inside each other more than 30 levels deep" in refused(text)


def test_a_diagram_that_unfolds_to_very_many_blocks_is_refused() -> None:
    lines = [
        f"  s{i}: {{blocks: {{a: {{type: s{i + 1}}}, b: {{type: s{i + 1}}}}}}}" for i in range(25)
    ]
    text = "\n".join(["blocks: {a: {type: s0}}", "subsystems:", *lines, "  s25: {blocks: {}}"])
    assert f"the diagram has {2**26 - 1} blocks with those of its subsystems" in refused(text)
