"""What an answer on a record with a floor is worth, and the promises of these groups."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.markup import escape

from benchmarks.table import Promise, Result
from benchmarks.tracing.cases import Case
from benchmarks.tracing.score import Row, errors_of, interval, label, met, quantile

FIRST, TIED = 80.0, 90.0  # % of the cases
FALSE = 100 * 2 / 60  # % of the nulls
WORSE = 1.01  # times the error of the declared diagram


def judge_floor(case: Case, row: Row, coefficients: Mapping[str, str]) -> Row:
    """Which parts of an answer are right; `coefficients` are the library's, by effect."""
    answer, truth = row["answer"], row["truth"]
    verdict = answer["verdict"]
    effects = answer.get("effects", []) if verdict == "effect" else []
    judged: Row = {"verdict": verdict, "named": [label(e) for e in effects]}
    judged["worse"] = worse(row)
    if case.group == "floor-null":
        judged["right"] = verdict in ("null", "unexplained")
        judged["false_effect"] = verdict == "effect"
        return judged
    right = {label(h) for h in truth} | set(case.alike)
    first = effects[0] if effects else None
    ties = {t.split(" (")[0] for t in first.get("ties", ())} if first else set()
    names = set(judged["named"])
    judged["first"] = first is not None and label(first) in right
    judged["tied"] = judged["first"] or bool(right & ties)
    judged["place"] = first is not None and first["place"] in {h["place"] for h in truth}
    judged["all"] = all(met(h, names, case) for h in truth)
    judged["superfluous"] = len(effects) > sum(met(h, names, case) for h in truth)
    judged["effect"] = verdict == "effect"
    listed = answer.get("effects") or []
    judged["listed_first"] = bool(listed) and label(listed[0]) in right
    judged["errors"] = errors_of(truth, effects, coefficients)
    return judged


def worse(row: Row) -> bool:
    """Whether what was found does worse than what was declared on the unseen record, in a free run
    or in short windows; a run that fails is worse."""
    for key in ("free", "short"):
        errors = row.get(key, {})
        if "error" in errors:
            return True
        if errors and not errors["after"] <= WORSE * errors["before"]:
            return True
    return False


def floor_tables(rows: Sequence[Row]) -> list[Result]:
    """Counts with intervals and the promises."""
    cases = [r for r in rows if r["group"] == "floor" and r["units"] == "si"]
    nulls = [r for r in rows if r["group"] == "floor-null" and r["units"] == "si"]
    if not cases and not nulls:  # all in other units
        cases = [r for r in rows if r["group"] == "floor"]
        nulls = [r for r in rows if r["group"] == "floor-null"]
    counted: list[list[str]] = []
    promises: list[Promise] = []

    def count(
        some: Sequence[Row], key: str, text: str, bound: float = math.nan, most: bool = False
    ) -> None:
        if not some:
            return
        k = sum(bool(r["judged"].get(key)) for r in some)
        counted.append([text, f"{k} of {len(some)}", interval(k, len(some))])
        if math.isfinite(bound):
            promises.append(Promise(text, 100 * k / len(some), bound, "%", most))

    pairs = [r for r in cases if len(r["truth"]) == 2]
    singles = [r for r in cases if len(r["truth"]) == 1]
    count(cases, "first", "floor: right name first", FIRST)
    count(cases, "tied", "floor: right name first, or tied", TIED)
    count(cases, "place", "floor: right place first")
    count(cases, "effect", "floor: verdict effect")
    count(cases, "listed_first", "floor: right name first, whatever the verdict")
    count(cases, "superfluous", "floor: something superfluous")
    count(singles, "all", "floor, one effect: named")
    count(pairs, "first", "floor, two effects: right name first")
    count(pairs, "all", "floor, two effects: both named")
    count(nulls, "right", "floor-null: null or unexplained")
    count(nulls, "false_effect", "floor-null: false effect", FALSE, most=True)
    count([*cases, *nulls], "worse", "floor: worse on unseen data", 0.0, most=True)
    same = _same_in_other_units(rows)
    if same:
        text = "floor: same answer in other units"
        counted.append([text, f"{sum(same)} of {len(same)}", interval(sum(same), len(same))])
        promises.append(Promise(text, 100 * sum(same) / len(same), 100.0, "%"))
    walls = [r["wall"] for r in (*cases, *nulls)]
    if not walls:
        return []
    middle, tail = quantile(walls, 0.5), quantile(walls, 0.9)
    remarks = [f"wall seconds: {middle:.3g} (median), {tail:.3g} (90 %)"]
    remarks += _by_scenario(cases)
    missed = [r for r in rows if _missed(r)]
    remarks += [f"{len(missed)} not right:"] if missed else []
    remarks += [escape(f"  {r['case']}: {_said(r)}") for r in missed]
    columns = ("", "count", "95 % interval")
    return [Result("Tracing with a floor", columns, counted, promises, remarks)]


def _same_in_other_units(rows: Sequence[Row]) -> list[bool]:
    """For each case that ran in both: whether verdict and names agree."""
    answers: dict[tuple[str, int], dict[str, Any]] = {}
    for r in rows:
        if "units" in r:
            told = (r["judged"]["verdict"], tuple(r["judged"]["named"]))
            answers.setdefault((r["case"], r.get("draw", 0)), {})[r["units"]] = told
    return [a["si"] == a["other"] for a in answers.values() if len(a) == 2]


def _by_scenario(cases: Sequence[Row]) -> list[str]:
    """How many are right first, by kind of drive, noise and mark, and by the number of series."""
    found = []
    for key in ("drive", "noise", "mark", "alone"):
        kinds: dict[str, list[bool]] = {}
        for r in cases:
            kinds.setdefault(str(r["scenario"][key]), []).append(r["judged"]["first"])
        parts = (f"{kind} {sum(hits)}/{len(hits)}" for kind, hits in sorted(kinds.items()))
        found.append(f"right first by {key}: {', '.join(parts)}")
    return found if cases else []


def _missed(row: Row) -> bool:
    judged = row["judged"]
    return judged["worse"] or not judged.get("first" if row["group"] == "floor" else "right")


def _said(row: Row) -> str:
    judged, answer = row["judged"], row["answer"]
    text: str = judged["verdict"] + " " + " + ".join(judged["named"])
    if "error" in answer:
        text += answer["error"].strip().splitlines()[-1][:200]
    if judged.get("tied") and not judged["first"]:
        text += " (truth in the ties)"
    if judged["worse"]:
        text += " (worse on unseen data)"
    return text + (" [other units]" if row["units"] == "other" else "")
