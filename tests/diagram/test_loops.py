"""What contains itself, and what is too deep; algebraic loops are solved, in the room compile."""

from __future__ import annotations

from diagram.small_library import made, refused


def test_an_algebraic_loop_is_no_mistake_of_a_diagram() -> None:
    made("blocks: {a: {type: gain, of: b, k: 2}, b: {type: gain, of: a, k: 2}}")


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
