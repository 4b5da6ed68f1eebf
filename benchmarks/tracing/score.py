"""What an answer is worth: each case by itself, then all of them in tables with intervals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from rich.markup import escape
from scipy.stats import binomtest

from benchmarks.table import Promise, Result
from benchmarks.tracing.cases import Case

Row = dict[str, Any]


def label(effect: Mapping[str, Any]) -> str:
    """`name @ place`."""
    return f"{effect['name']} @ {effect['place']}"


def judge(case: Case, row: Row, coefficients: Mapping[str, str]) -> Row:
    """Which parts of an answer are right; `coefficients` are the library's, by effect."""
    answer, truth = row["answer"], row["truth"]
    verdict = answer["verdict"]
    effects = answer.get("effects", []) if verdict == "effect" else []
    judged: Row = {"verdict": verdict, "named": [label(e) for e in effects]}
    right = {label(h) for h in truth}
    if case.group in ("single", "extra"):
        first = effects[0] if effects else None
        name = label(first) if first else ""
        ties = {t.split(" (")[0] for t in first.get("ties", ())} if first else set()
        judged["exact"] = name in right
        judged["structural"] = name in right or name in case.alike
        judged["tie"] = judged["structural"] or bool(right & ties)
        judged["place"] = judged["structural"] or (
            first is not None and first["place"] == truth[0]["place"]
        )
        judged["alone"] = judged["structural"] and len(effects) == 1
    if case.group == "double":
        names = {label(e) for e in effects}
        allowed = right | set(case.alike)
        judged["exact"] = names == right
        judged["structural"] = names <= allowed and len(effects) == len(names) == len(right)
        judged["both"] = all(met(h, names, case) for h in truth)
    if case.group == "outside":
        missing = answer.get("missing") or {}
        variables = missing.get("variables", answer.get("depends_on") or ())
        judged["variables"] = list(variables)
        judged["unexplained"] = verdict == "unexplained"
        judged["place"] = missing.get("place") == truth[0]["place"]
        judged["depends_on"] = any(_same(variables, options) for options in case.variables)
        judged["right"] = all(judged[k] for k in ("unexplained", "place", "depends_on"))
    if case.group == "null":
        judged["right"] = verdict == "null"
        judged["false_alarm"] = verdict in ("effect", "unexplained")
    if case.group == "bad":
        judged["right"] = verdict in ("message", "unexplained", "null")
    judged["errors"] = errors_of(truth, effects, coefficients)
    return judged


def met(hidden: Row, names: set[str], case: Case) -> bool:
    """Whether a hidden effect is named; a block that is alike stands for the one at its place."""
    alike = {a for a in case.alike if a.endswith(f"@ {hidden['place']}")}
    return label(hidden) in names or bool(alike & names)


def _same(variables: Sequence[str], options: Sequence[str]) -> bool:
    return {v.split()[0].split("_")[0] for v in variables} == {o.split()[0] for o in options}


def errors_of(
    truth: Sequence[Row], effects: Sequence[Row], coefficients: Mapping[str, str]
) -> list[float]:
    """Relative errors of the coefficients of the effects that are named exactly."""
    found = []
    for hidden in truth:
        for effect in effects:
            params = effect.get("params") or {}
            if label(effect) != label(hidden) or not params:
                continue
            key = coefficients.get(effect["name"], "")
            value = next((v for k, v in params.items() if k.split(".")[-1] == key), None)
            if value is None:
                value = next(iter(params.values()))
            if effect["name"] == "sensor_gain":
                value -= 1.0
            size = abs(value) if hidden["name"] in ("harmonic", "parametric") else value
            found.append(abs(size / hidden["coefficient"] - 1.0))
    return found


def _share(rows: Sequence[Row], key: str) -> tuple[int, int]:
    return sum(bool(r["judged"].get(key)) for r in rows), len(rows)


def interval(k: int, n: int) -> str:
    """Clopper and Pearson's exact 95 % interval."""
    if not n:
        return "-"
    ci = binomtest(k, n).proportion_ci(method="exact")
    return f"{100 * ci.low:.0f} ... {100 * ci.high:.0f} %"


def _reported(row: Row) -> tuple[float, float]:
    """The report's own rmse after/before, and after in units of sigma where one channel is."""
    answer = row["answer"]
    before, after, sigma = (answer.get(k) for k in ("rmse_before", "rmse_after", "sigma"))
    if before is None or after is None or not sigma:
        return math.nan, math.nan
    if not isinstance(before, dict):
        scale = next(iter(sigma.values())) if len(sigma) == 1 else math.nan
        return after / before if before else math.nan, after / scale
    names = [n for n in after if n in sigma]
    ratios = [after[n] / before[n] for n in names]
    return float(np.mean(ratios)), float(np.mean([after[n] / sigma[n] for n in names]))


def quantile(values: Sequence[float], part: float) -> float:
    """Of the finite values; NaN where there are none."""
    finite = [v for v in values if math.isfinite(v)]
    return float(np.quantile(finite, part)) if finite else math.nan


def tables(rows: Sequence[Row]) -> list[Result]:
    """Counts with intervals, sizes, seconds, and the promises they are held to."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row["group"], []).append(row)
    counted: list[list[str]] = []
    promises: list[Promise] = []

    def count(group: str, key: str, text: str, least: float = 0.0, most: float = math.nan) -> None:
        k, n = _share(groups.get(group, ()), key)
        if not n:
            return
        counted.append([text, f"{k} of {n}", interval(k, n)])
        if least:
            promises.append(Promise(text, 100 * k / n, 100 * least, "%"))
        if math.isfinite(most):
            promises.append(Promise(text, 100 * k / n, 100 * most, "%", most=True))

    count("null", "false_alarm", "null: false alarm", most=3 / 150)
    count("null", "right", "null: says null")
    count("single", "exact", "single: named first, exactly")
    count("single", "structural", "single: named first, or an identical block", least=36 / 40)
    count("single", "tie", "single: truth in the tie set", least=39 / 40)
    count("single", "place", "single: place", least=38 / 40)
    count("single", "alone", "single: nothing superfluous")
    count("extra", "structural", "extra single: named first, or an identical block")
    count("extra", "tie", "extra single: truth in the tie set")
    count("double", "both", "double: both named")
    count("double", "structural", "double: both named, nothing superfluous", least=8 / 12)
    count("outside", "unexplained", "outside: unexplained")
    count("outside", "place", "outside: place")
    count("outside", "depends_on", "outside: variables")
    count("outside", "right", "outside: all three", least=7 / 8)
    count("bad", "right", "bad input: no discovery", least=1.0)
    sizes: list[list[str]] = []

    def size(text: str, values: Sequence[float], most: tuple[float, float], unit: str) -> None:
        middle, tail = (quantile(values, part) for part in (0.5, 0.9))
        finite = sum(map(math.isfinite, values))
        if not finite:
            return
        sizes.append([text, f"{middle:.3g}", f"{tail:.3g}", str(finite)])
        for value, bound, which in zip((middle, tail), most, ("median", "90 %"), strict=True):
            if math.isfinite(value) and math.isfinite(bound):
                promises.append(Promise(f"{text}, {which}", value, bound, unit, most=True))

    hit = [r for g in ("single", "double", "extra") for r in groups.get(g, ())]
    errors = [100 * e for r in hit for e in r["judged"]["errors"]]
    size("coefficient error (%)", errors, (3.0, 10.0), "%")
    named = [r for r in hit if r["judged"]["verdict"] == "effect"]
    none = math.nan
    free = [(r, r["free"]) for r in named if "after" in r.get("free", {})]
    one = [f for r, f in free if r["system"] != "double_torsion"]
    two = [f for r, f in free if r["system"] == "double_torsion"]
    size("free run after/before", [f["after"] / f["before"] for _, f in free], (0.1, none), "")
    size("free run after (sigma)", [f["after"] for f in one], (1.5, none), "sigma")
    size("free run after, double torsion (sigma)", [f["after"] for f in two], (3.0, none), "sigma")
    size("reported after/before", [_reported(r)[0] for r in named], (none, none), "")
    size("reported after (sigma)", [_reported(r)[1] for r in named], (none, none), "")
    single = [r for r in hit if r["system"] not in ("chain", "double_torsion")]
    size("wall seconds, 1 DOF", [r["wall"] for r in single], (15.0, 15.0), "seconds")
    size("CPU seconds, 1 DOF", [r["cpu"] for r in single], (none, none), "")
    size(
        "wall seconds, chain", [r["wall"] for r in hit if r["system"] == "chain"], (none, none), ""
    )
    double = [r for r in hit if r["system"] == "double_torsion"]
    size("wall seconds, double torsion", [r["wall"] for r in double], (120.0, 120.0), "seconds")
    size("wall seconds, nulls", [r["wall"] for r in groups.get("null", ())], (none, none), "")
    remarks = [f"{len(missed)} not right:"] if (missed := [r for r in rows if _missed(r)]) else []
    remarks += [escape(f"  {r['case']}: {_said(r)}") for r in missed]
    return [
        Result("Tracing: counts", ("", "count", "95 % interval"), counted, promises),
        Result("Tracing: sizes", ("", "median", "90 %", "cases"), sizes, remarks=remarks),
    ]


def _missed(row: Row) -> bool:
    key = "structural" if row["group"] in ("single", "extra", "double") else "right"
    return not row["judged"].get(key)


def _said(row: Row) -> str:
    judged, answer = row["judged"], row["answer"]
    text: str = judged["verdict"] + " " + " + ".join(judged["named"])
    if "error" in answer:
        text += answer["error"].strip().splitlines()[-1][:200]
    if judged.get("variables"):
        text += f" {(answer.get('missing') or {}).get('place')}: {', '.join(judged['variables'])}"
    if row["group"] in ("single", "extra") and judged.get("tie"):
        text += " (truth in the ties)"
    return text
