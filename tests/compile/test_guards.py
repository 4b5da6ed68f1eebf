from __future__ import annotations

import pytest
from solve.models import made, one


def guards(formula: str) -> list[tuple[str, str, bool]]:
    """(kind, text, timed) of every mode of a formula."""
    model = made(one(formula))
    return [(mode.kind, mode.text, mode.timed is not None) for mode in model.modes]


@pytest.mark.parametrize(
    "formula",
    [
        "sign(x) + abs(x) + (1 if x >= 0 else 2)",
        "sign(-x) + abs(x)",
        "(1 if x > 0 else 2) + (3 if x <= 0 else 4) + (5 if 0 < x else 6)",
        "max(x, 3) + min(3, x) + sign(x - 3)",
        "sign(3 - x) + sign(x - 3)",
        "dry(x, 1, 2) + sign(x)",
        "-sign(--x)",
    ],
)
def test_guards_are_shared_up_to_sign(formula: str) -> None:
    assert len(guards(formula)) == 1


@pytest.mark.parametrize("formula", ["sign(x) + sign(x - 1)", "floor(x) + sign(x)"])
def test_different_guards_are_different_modes(formula: str) -> None:
    assert len(guards(formula)) == 2


@pytest.mark.parametrize(
    ("formula", "timed"),
    [
        ("sign(t - 3)", True),
        ("floor(2*t + 0.5)", True),
        ("mod(t, 0.5)", True),
        ("1 if t >= rate2 else 0", False),
        ("sign(sin(t))", False),
        ("sign(t - x)", False),
    ],
)
def test_known_times_are_recognised(formula: str, timed: bool) -> None:
    model = made(one(formula, 0.0, "  rate2: {type: sine, amplitude: 1, omega: 1}"))
    assert {mode.timed is not None for mode in model.modes} == {timed}


def test_a_relation_of_parameters_is_no_guard() -> None:
    text = one("(1 if k >= 2 else 3) + abs(k) + sign(k)*floor(k)")
    model = made(text.replace("blocks:", "parameters: {k: 2.5}\nblocks:"))
    assert list(model.modes) == []


def test_a_reset_compares_parameters_without_a_guard() -> None:
    text = one("1") + "events:\n  - {when: x - 0.5, set: {x: 0 if k >= 0 else 1}}"
    model = made(text.replace("blocks:", "parameters: {k: 1}\nblocks:"))
    assert [mode.text for mode in model.modes] == ["x - 0.5"]


@pytest.mark.parametrize(
    ("when", "crosses", "seen"),
    [("x - 1", "up", "up"), ("1 - x", "down", "up"), ("-(x - 1)", "up", "down")],
)
def test_a_shared_guard_turns_the_direction_of_a_reset(when: str, crosses: str, seen: str) -> None:
    more = "  s: {type: expression, formula: sign(x - 1)}\n"
    text = one("s", 0.0, more) + f"events:\n  - {{when: {when}, crosses: {crosses}, set: {{x: 0}}}}"
    model = made(text)
    assert len(model.modes) == 1
    assert model.lowered.resets[0].direction == seen
