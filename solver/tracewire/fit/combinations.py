"""In words: which combinations of parameters the data determine, and what to fix."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracewire.fit.identify import FlatDirection, ParameterColumns
from tracewire.fit.limits import UNCERTAINTY


@dataclass(frozen=True)
class Direction:
    """A combination of parameters that the data do not determine.

    `weights` are the relative changes of the parameters `names` along it, `ratio` the relative
    standard deviation along it, and `words` says it in a sentence.
    """

    names: tuple[str, ...]
    weights: tuple[float, ...]
    ratio: float
    words: str


def describe_directions(
    flats: Sequence[FlatDirection], missing: set[int], columns: ParameterColumns
) -> tuple[tuple[Direction, ...], tuple[str, ...]]:
    """The directions, and a sentence for each group of parameters that share some."""
    flats = _approximate(flats, missing, columns)
    directions = []
    for flat in flats:
        members = _taking_part(flat)
        unit = flat.changes / np.linalg.norm(flat.changes)
        names = tuple(columns.names[j] for j in members)
        words = f"changing {_changes(flat, columns)} leaves the residual as it is"
        directions.append(Direction(names, tuple(unit[members].tolist()), flat.ratio, words))
    return tuple(directions), tuple(_sentence(g, missing, columns) for g in _groups(flats, missing))


def followers(flats: Sequence[FlatDirection], missing: set[int]) -> set[int]:
    """Parameters that are determined once the missing ones are, and move with these until then."""
    return {j for flat in flats if not flat.exact for j in _taking_part(flat)} - missing


def _approximate(
    flats: Sequence[FlatDirection], missing: set[int], columns: ParameterColumns
) -> list[FlatDirection]:
    """The same directions; those that conserve no plain product or sum do not count as exact."""
    found = []
    for group in _groups(flats, missing):
        members = _members(group, missing)
        rest = [j for j in members if j not in {flat.fixed for flat in group}]
        exact = all(flat.exact for flat in group)
        exact = exact and _conserved_quantity(group, rest, members, columns) is not None
        found += [replace(flat, exact=exact) for flat in group]
    return sorted(found, key=lambda flat: -flat.ratio)


def _groups(flats: Sequence[FlatDirection], missing: set[int]) -> list[list[FlatDirection]]:
    """Directions that share parameters."""
    groups: list[list[FlatDirection]] = []
    for flat in flats:
        mine = set(_members([flat], missing))
        joined = [g for g in groups if mine & set(_members(g, missing))]
        groups = [g for g in groups if g not in joined]
        groups.append([f for g in joined for f in g] + [flat])
    return groups


def _members(flats: Sequence[FlatDirection], missing: set[int]) -> list[int]:
    """The parameters of a group: all of an exact direction, the open ones of another."""
    found = set()
    for flat in flats:
        found |= {j for j in _taking_part(flat) if flat.exact or j in missing}
    return sorted(found)


def _taking_part(flat: FlatDirection) -> list[int]:
    """The parameters of a direction: those that cancel in an exact one, or change much."""
    shares = np.abs(flat.changes) / np.abs(flat.changes).max()
    takes = flat.effects > UNCERTAINTY.trace if flat.exact else shares > UNCERTAINTY.part
    takes[flat.fixed] = True
    return [int(j) for j in np.flatnonzero(takes)]


def _sentence(flats: Sequence[FlatDirection], missing: set[int], columns: ParameterColumns) -> str:
    members = _members(flats, missing)
    held = sorted(flat.fixed for flat in flats)
    rest = [j for j in members if j not in held]
    names = [columns.names[j] for j in members]
    exact = all(flat.exact for flat in flats)
    if not rest:
        return _alone(flats[0], columns)
    count = _count(len(held))
    if len(members) == 2:
        advice = f"fix {names[1]} or {names[0]}"
    elif len(held) == 1 or (len(rest) == 1 and exact):
        advice = f"fix {count} of {_listed(names)}"
    else:
        advice = f"fix {count} of them, for example {_listed([columns.names[j] for j in held])}"
    whole = _conserved_quantity(flats, rest, members, columns) if exact else None
    verb = "is" if len(rest) == 1 else "are"
    if whole is not None:
        return f"only {_listed(whole)} {verb} determined: {advice}"
    products = _exponents(flats, rest, members, columns)
    near = _listed([_product(e if exact else _rounded(e)) for e in products])
    after = [columns.names[j] for j in sorted(followers(flats, missing))]
    if after:
        pronoun = "it has no error" if len(after) == 1 else "they have no errors"
        advice += (
            f"; {_listed(after)} move{'s' * (len(after) == 1)} with these: {pronoun} until then"
        )
    combinations = f"{_count(len(rest))} combination{'s' * (len(rest) != 1)}"
    return (
        f"{_listed(names)}: the data determine {combinations} of these {_count(len(members))}, "
        f"near these values {'' if exact else 'almost '}only {near}; "
        f"changing {_changes(flats[0], columns)} leaves the residual as it is; {advice}"
    )


def _alone(flat: FlatDirection, columns: ParameterColumns) -> str:
    many = np.flatnonzero(flat.effects > UNCERTAINTY.part).tolist()
    others = [columns.names[j] for j in many if j != flat.fixed]
    name, together = columns.names[flat.fixed], " together" if len(others) > 1 else ""
    what = f"cannot be told from {_listed(others)}{together}" if others else "is not determined"
    changed = f"changing {_changes(flat, columns)} leaves the residual as it is"
    return f"{name} {what}: {changed}; fix {name}"


def _conserved_quantity(
    flats: Sequence[FlatDirection],
    rest: Sequence[int],
    members: Sequence[int],
    columns: ParameterColumns,
) -> list[str] | None:
    """The combinations of an exactly flat group, as products or as sums of the parameters."""
    sums = _exponents(flats, rest, members, columns, linear=True)
    products = _exponents(flats, rest, members, columns)
    by_product = np.all(columns.values[list(members)]) and _are_plain(products, len(members))
    by_sum = _are_plain(sums, len(members))
    if by_product and by_sum and _sum_is_flatter(flats[0], columns):
        by_product = False
    if by_product:
        return [_product(_plain(e)) for e in products]
    return [_sum(_plain(e)) for e in sums] if by_sum else None


def _exponents(
    flats: Sequence[FlatDirection],
    rest: Sequence[int],
    members: Sequence[int],
    columns: ParameterColumns,
    linear: bool = False,
) -> list[dict[str, float]]:
    """For each parameter that is not held, the combination with held ones that is conserved.

    Exponents of a product; `linear`: coefficients of a sum.
    """
    units = (
        np.ones(len(columns.values)) if linear else np.where(columns.values, columns.values, 1.0)
    )
    changes = np.array([flat.changes * columns.sizes / units for flat in flats])
    held = [flat.fixed for flat in flats]
    solved = -np.linalg.solve(changes[:, held], changes[:, rest])
    found = []
    for column, j in enumerate(rest):
        combination = {j: 1.0, **dict(zip(held, solved[:, column].tolist(), strict=True))}
        found.append({columns.names[k]: combination[k] for k in members if k in combination})
    return found


def _sum_is_flatter(flat: FlatDirection, columns: ParameterColumns) -> bool:
    """Whether the criterion changes on a long way along the product and not on one along the sum.

    At equal values, or where k/J is 4 as k - 4 J is 0, derivatives cannot tell these apart.
    """
    if columns.value is None:
        return False
    steps = flat.changes * columns.sizes
    relative = np.divide(steps, columns.values, out=np.zeros_like(steps), where=columns.values != 0)
    scale = 0.25 / np.abs(relative).max()
    here = columns.value(columns.values)
    along_sum = abs(columns.value(columns.values + scale * steps) - here)
    along_product = abs(columns.value(columns.values * np.exp(scale * relative)) - here)
    return bool(along_product > 1e-3 * here and along_sum < 0.1 * along_product)


def _are_plain(combinations: Sequence[dict[str, float]], members: int) -> bool:
    """Whether all numbers are halves or whole, up to 4, and each member counts in one."""
    numbers = [(name, x) for combination in combinations for name, x in combination.items()]
    counting = {name for name, x in numbers if round(2 * x)}
    plain = all(abs(2 * x - round(2 * x)) < 0.01 and abs(x) < 4.3 for _, x in numbers)
    return plain and len(counting) == members


def _rounded(exponents: dict[str, float]) -> dict[str, float]:
    """Exponents to whole and half numbers where they are within 0.05 of these."""
    near = {n: round(2 * e) / 2 for n, e in exponents.items()}
    return {n: near[n] if abs(e - near[n]) < 0.05 else e for n, e in exponents.items()}


def _plain(numbers: dict[str, float]) -> dict[str, float]:
    """Whole numbers instead of halves, the first of them above zero."""
    halves = [round(2 * x) for x in numbers.values()]
    divisor = math.gcd(*halves)
    first = next(x for x in halves if x)
    signed = divisor if first > 0 else -divisor
    return {name: x / signed for name, x in zip(numbers, halves, strict=True)}


def _product(exponents: dict[str, float]) -> str:
    def power(name: str, exponent: float) -> str:
        number = f"{exponent:.2g}"
        return name if number == "1" else f"{name}^{number}"

    above = [power(n, e) for n, e in exponents.items() if e > 0.005]
    below = [power(n, -e) for n, e in exponents.items() if e < -0.005]
    under = "*".join(below) if len(below) < 2 else f"({'*'.join(below)})"
    return "*".join(above) + (f"/{under}" if below else "")


def _sum(coefficients: dict[str, float]) -> str:
    text = ""
    for name, coefficient in coefficients.items():
        size = f"{abs(coefficient):.2g}"
        term = name if size == "1" else f"{size}*{name}"
        if size == "0":
            continue
        if not text:
            text = f"-{term}" if coefficient < 0 else term
        else:
            text += f" {'-' if coefficient < 0 else '+'} {term}"
    return text


def _changes(flat: FlatDirection, columns: ParameterColumns) -> str:
    """A change in words, the largest by 10 %, with what the others must change by."""
    units = np.where(columns.values, columns.values, columns.sizes)
    relative = flat.changes * columns.sizes / units
    relative *= 10.0 / np.abs(relative).max() * (1.0 if relative[flat.fixed] > 0 else -1.0)
    kept = np.flatnonzero((np.abs(relative) > 0.5) | (flat.effects > UNCERTAINTY.part)).tolist()
    parts = []
    for j in sorted(kept, key=lambda j: (j != flat.fixed, j)):
        if columns.values[j] == 0:
            parts.append(f"{columns.names[j]} by {0.01 * relative[j] * units[j]:+.3g}")
        else:
            parts.append(f"{columns.names[j]} by {relative[j]:+.3g} %")
    return _listed(parts)


def _count(number: int) -> str:
    return (
        ("no", "one", "two", "three", "four", "five", "six")[number] if number < 7 else str(number)
    )


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
