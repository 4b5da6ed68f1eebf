"""What an answer is worth beside the truth: right, with more, partly, or wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from benchmarks.rigs.hidden import Truth

Grade = Literal["right", "with more", "partly", "wrong"]
Effect = Mapping[str, Any]
"""An effect as the JSON of a trace has it."""


def label(effect: Effect) -> str:
    """`effect @ place`."""
    return f"{effect['name']} @ {effect['place']}"


def grade(truth: Truth, answer: Mapping[str, Any]) -> Grade:
    """How far the JSON of a trace says what is hidden.

    'right': every hidden effect is named, or one that is equal to it, or a tie of one that is named
    is it, and nothing else is but what the truth has besides; or the answer is another that the
    truth lists. 'with more': there are others. 'partly': some of it is there, or all of it under
    the verdict unexplained, or a missing force at the right place on other variables. 'wrong':
    nothing of it is there.
    """
    effects = [effect for effect in answer["effects"] if meant(truth, effect)]
    strangers = [effect for effect in answer["effects"] if not meant(truth, effect)]
    if truth.hidden:
        met, others = matched(truth, effects)
        more = [effect for effect in (*others, *strangers) if label(effect) not in truth.besides]
        if met == len(truth.hidden) and answer["verdict"] != "unexplained":
            return "with more" if more else "right"
        return "partly" if met else "wrong"
    law = answer["verdict"] == "unexplained" and tells(truth, answer)
    if not answer["effects"]:
        if law or (truth.clean and answer["verdict"] in ("null", "unexplained")):
            return "right"
        at_place = truth.law is not None and told_law(answer)[0] == truth.law[0]
        return "partly" if answer["verdict"] == "unexplained" and at_place else "wrong"
    names = {label(effect) for effect in effects}
    if not strangers and any(names == set(other) for other in truth.answers):
        return "right"
    if law or any(names >= set(other) for other in truth.answers):
        return "with more"
    return "partly" if names & set(truth.half) else "wrong"


def meant(truth: Truth, effect: Effect) -> bool:
    """Whether the parameters of an effect are within the bounds that the truth gives, if any."""
    return all(
        low <= effect["params"].get(parameter, low - 1) <= high
        for (name, parameter), (low, high) in truth.bounds.items()
        if name == label(effect)
    )


def matched(truth: Truth, effects: Sequence[Effect]) -> tuple[int, list[Effect]]:
    """How many hidden effects are met, and the effects that are named and that none of them is.

    An effect that is named stands for one hidden effect at most, by its name before by its ties.
    """
    left = list(effects)
    unmet = []
    for hidden in truth.hidden:
        alike = {hidden, *truth.equal.get(hidden, ())}
        same = [effect for effect in left if label(effect) in alike]
        if same:
            left.remove(same[0])
        else:
            unmet.append(alike)
    missed = 0
    for alike in unmet:
        tied = [effect for effect in left if alike & set(effect["ties"])]
        if tied:
            left.remove(tied[0])
        else:
            missed += 1
    return len(truth.hidden) - missed, left


def told_law(answer: Mapping[str, Any]) -> tuple[str, set[str]]:
    """The place of the missing force that an answer tells, and the variables it depends on."""
    missing = answer.get("missing")
    if missing is None:
        listed = [*answer.get("where_what", ()), *answer.get("remainder_depends", ())]
        missing = listed[0] if listed else {"place": "", "variables": ()}
    return missing["place"], {variable.split()[0] for variable in missing["variables"]}


def tells(truth: Truth, answer: Mapping[str, Any]) -> bool:
    """Whether the missing force is told at its place, on its variable alone."""
    return truth.law is not None and told_law(answer) == (truth.law[0], {truth.law[1]})
