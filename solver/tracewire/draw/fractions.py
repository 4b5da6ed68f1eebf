"""Transfer functions as text: a polynomial over a polynomial, as control books write them."""

from __future__ import annotations

from collections.abc import Sequence

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def raised(letter: str, power: int) -> str:
    """A power of a letter: `s`, `s²`, `z⁻¹`; empty where it is 1."""
    if power == 0:
        return ""
    return letter if power == 1 else letter + str(power).translate(RAISED)


def items_of(text: str) -> list[str]:
    """The formulas of a list as it is written: `[m, max(c, d), k]`; of any other text itself."""
    if not text.startswith("["):
        return [text]
    items, depth = [""], 0
    for letter in text[1:-1]:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            items.append("")
        else:
            items[-1] += letter
    return [item.strip() for item in items]


def polynomial(coefficients: Sequence[str], letter: str) -> str:
    """The polynomial with these coefficients, the highest power first: `s² + 6 s + 4`."""
    text = ""
    for power, coefficient in zip(range(len(coefficients) - 1, -1, -1), coefficients, strict=True):
        if coefficient == "0":
            continue
        minus = coefficient.startswith("-")
        plain = coefficient.removeprefix("-")
        term = times(plain, raised(letter, power))
        if text:
            text += f" − {term}" if minus else f" + {term}"
        else:
            text = f"−{term}" if minus else term
    return text or "0"


def times(factor: str, term: str) -> str:
    """A product, without a factor of 1."""
    if not term:
        return factor
    if factor == "1":
        return term
    simple = factor.replace("_", "").replace(".", "").isalnum()
    return f"{factor} {term}" if simple else f"({factor}) {term}"
