"""The steps of cleaning by name, and the options that each takes in a diagram.

`sort` is the first of a list, where it is one: every other step takes rows in the order of time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Kind = Literal["signal", "signals", "new", "number", "count", "time", "size", "word"]


@dataclass(frozen=True)
class Option:
    """An option of a step: what it is, whether it must be given, the words there are for it.

    Kinds: a measured signal or input, several of them, a signal that the step makes (`new`), a
    number, a whole number, a time or interval in s, a `size` in the unit of the column, a word.
    `argument` is its name in Python where that is another one.
    """

    kind: Kind
    required: bool = False
    words: tuple[str, ...] = ()
    argument: str = ""


SIGNAL, SIGNALS = Option("signal", required=True), Option("signals", required=True)
NUMBER, COUNT = Option("number"), Option("count")
STEPS: Mapping[str, Mapping[str, Option]] = {
    "sort": {"duplicates": Option("word", words=("first", "last", "mean"))},
    "trim": {"from": Option("time", argument="begin"), "to": Option("time", argument="end")},
    "outliers": {"signals": SIGNALS, "width": COUNT, "limit": NUMBER},
    "resample": {
        "every": Option("time", required=True),
        "method": Option("word", words=("linear", "spline")),
    },
    "calibrate": {"signal": SIGNAL, "gain": NUMBER, "offset": NUMBER},
    "detrend": {"signals": SIGNALS, "order": COUNT},
    "lowpass": {"signals": SIGNALS, "cutoff": Option("number", required=True), "order": COUNT},
    "differentiate": {
        "signal": SIGNAL,
        "to": Option("new", required=True),
        "noise": Option("size"),
    },
}
