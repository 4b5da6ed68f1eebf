"""The keys of a setting that the quantities measured in it do not read."""

from __future__ import annotations

from collections.abc import Collection

from tracewire.diagram.body import Body
from tracewire.diagram.grammar import SETTING
from tracewire.diagram.strict import Entries, Node
from tracewire.formula import QUANTITIES

ONLY_FOR = {"over": "bifurcation diagram", "method": "fit"}
OF_FITS = ("preset", "set", "rtol", "method")
APART = ("start", "series")
"""What a run may have, and a fit in the same statement would not."""


def refuse_unused(node: Node, body: Body, quantities: Collection[str]) -> None:
    """Note the keys of a setting, and of its `full`, that no quantity reads: they would change
    nothing."""
    if not isinstance(node, Entries):
        return
    made_by = {QUANTITIES[name].made_by for name in quantities}
    for key, place, value in node:
        analysis = ONLY_FOR.get(key)
        if key == "full":
            refuse_unused(value, body, quantities)
        elif analysis is not None and analysis not in made_by:
            there = [name for name, known in QUANTITIES.items() if known.made_by == analysis]
            what = f"'{key}' is of a {analysis}, and the statement measures nothing of one"
            hint = f"Leave it out, or measure one of {', '.join(there)}."
            body.problems.add(what, body.place(place), (), hint)
        elif made_by == {"fit"} and key in SETTING and key not in OF_FITS:
            what = f"'{key}' cannot stand with a fit, whose runs are those of the measured series"
            hint = "Leave it out, or change the series."
            body.problems.add(what, body.place(place), (), hint)
        elif "fit" in made_by and key in APART:
            what = f"'{key}' would hold in the run and not in the fit of one statement"
            hint = "Write two statements, or use 'preset' or 'set', which hold in both."
            body.problems.add(what, body.place(place), (), hint)
