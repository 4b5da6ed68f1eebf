"""The names in a quantity: signals, parameters, events, each where it may stand."""

from __future__ import annotations

from tracewire.diagram.diagram import Diagram, Setting
from tracewire.diagram.names import (
    element_name,
    events,
    find_parameter,
    find_recorded,
    find_state,
    parameters,
    recordable,
)
from tracewire.diagram.problems import Problems, clip
from tracewire.errors import Location, Problem
from tracewire.formula import (
    CONSTANTS,
    FUNCTIONS,
    QUANTITIES,
    Call,
    Expression,
    Name,
    Number,
    is_condition,
    to_text,
)

EVENT_KINDS = ("crossing", "scheduled", "reset", "impact", "stick", "slip", "rest", "transition")
OF_RUNS = frozenset({"number", "parameter"})


def is_quantity(node: Call) -> bool:
    """Whether a call is one of QUANTITIES: max(x) is, max(x, y) is a function of formulas."""
    if node.function not in QUANTITIES:
        return False
    known = FUNCTIONS.get(node.function)
    return known is None or len(node.arguments) < known.least


def quantities_in(node: Expression, reference: bool) -> set[str]:
    """The functions of quantities in a part; with `reference` those inside of reference(...)."""
    if not isinstance(node, Call):
        return set()
    if node.function == "reference":
        return quantities_in(node.arguments[0], False) if reference else set()
    inside = {name for part in node.arguments for name in quantities_in(part, reference)}
    return inside | {node.function} if is_quantity(node) and not reference else inside


def quantity_problems(
    node: Expression,
    diagram: Diagram,
    place: Location = Location(),
    reference: Setting | None = None,
    fixed: bool = False,
) -> list[Problem]:
    """The names of a quantity that do not exist in a diagram, or that may not stand where they do.

    fixed: it may read parameters only, as what is expected does. What `reference` has of another
    file is looked up when it is measured.
    """
    names = _Names(diagram, place, reference, fixed)
    if isinstance(node, Call) and node.function in QUANTITIES and QUANTITIES[node.function].text:
        return []  # a word, which stands alone
    names.check(node, along=False)
    return names.problems.found


class _Names:
    def __init__(
        self, diagram: Diagram, place: Location, reference: Setting | None, fixed: bool
    ) -> None:
        self.diagram, self.place = diagram, place
        self.reference, self.fixed = reference, fixed
        self.problems = Problems()

    def check(self, node: Expression, along: bool) -> None:
        """Note what is wrong in a part. along: whether it may be a signal."""
        if isinstance(node, Name):
            self.name(node.name, along)
        elif isinstance(node, Call) and node.function == "[]":
            vector, *indices = node.arguments
            number = tuple(int(i.value) for i in indices if isinstance(i, Number))
            if isinstance(vector, Name):
                self.name(element_name(vector.name, number), along)
        elif isinstance(node, Call) and is_quantity(node):
            self.quantity(node, along)
        elif isinstance(node, Call):
            if node.function in FUNCTIONS and FUNCTIONS[node.function].instead:
                what = f"{node.function} is for the formulas of block declarations"
                self.note(what, FUNCTIONS[node.function].instead)
            for argument in node.arguments:
                self.check(argument, along)

    def quantity(self, node: Call, along: bool) -> None:
        known = QUANTITIES[node.function]
        reads_run = any(kind not in OF_RUNS for kind in known.takes) or known.study
        if self.fixed and reads_run and not node.function.startswith("bessel"):
            what = f"what is expected cannot read {node.function}: it is no number of a run"
            self.note(what, "Write the difference or the ratio of both in 'that'.")
            return
        if known.text:
            hint = "Write it alone, with is: stable."
            self.note(f"{node.function}() is a word, and no part of a formula", hint)
            return
        if node.function == "reference":
            if self.reference is None:
                hint = "Write reference: {preset: ...} in the statement."
                self.note("the quantity has reference(...), and the statement no 'reference'", hint)
            elif self.reference.file is None:
                self.check(node.arguments[0], along=True)
            return
        for n, argument in enumerate(node.arguments):
            match known.kind(n):
                case "word" if known.words and to_text(argument) not in known.words:
                    self.unknown(f"word of {node.function}", to_text(argument), list(known.words))
                case "word":
                    pass
                case "parameter" if node.function == "motions":
                    self.state(to_text(argument))
                case "parameter":
                    if find_parameter(self.diagram, to_text(argument)) is None:
                        there = parameters(self.diagram)
                        self.unknown("parameter", to_text(argument), there)
                case "event":
                    self.event(argument)
                case "happening" if not is_condition(argument):
                    self.event(argument)
                case "number":
                    self.check(argument, along=node.function == "at")
                case _:
                    self.check(argument, along=True)

    def event(self, node: Expression) -> None:
        """A kind of event, a block, or a guard, which is a formula."""
        text = to_text(node)
        head = text.partition(".")[0].partition("[")[0]
        if text in EVENT_KINDS or head in self.diagram.blocks or head == "events":
            return
        if isinstance(node, Name):
            there = [*EVENT_KINDS, *self.diagram.blocks, *events(self.diagram)]
            self.unknown("event", text, there)
        else:
            self.check(node, along=True)

    def state(self, name: str) -> None:
        if find_state(self.diagram, name) is None:
            self.unknown("state", name, recordable(self.diagram))

    def name(self, name: str, along: bool) -> None:
        if name in CONSTANTS or find_parameter(self.diagram, name) is not None:
            return
        is_signal = name == "t" or find_recorded(self.diagram, name) is not None
        if is_signal and along and not self.fixed:
            return
        shown = clip(name)
        if is_signal and self.fixed:
            what = f"what is expected reads '{shown}', a signal"
            self.note(what, "Compare signals in 'that', such as max(abs(x - y)).")
        elif is_signal:
            what = f"'{shown}' is a signal, and a quantity is one number"
            self.note(what, f"Write end({shown}), max({shown}) or another number of it.")
        else:
            there = [*recordable(self.diagram), *parameters(self.diagram), "t"]
            self.unknown("signal or parameter", name, there)

    def unknown(self, kind: str, name: str, there: list[str]) -> None:
        self.problems.unknown(kind, name, there, self.place)

    def note(self, what: str, hint: str) -> None:
        self.problems.add(what, self.place, (), hint)
