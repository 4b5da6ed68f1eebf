"""`clean` of a measured series: a list of steps, each one that a record can do."""

from __future__ import annotations

from collections.abc import Mapping

from tracewire.data import STEPS, Option
from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Channel, Cleaning, Diagram
from tracewire.diagram.grammar import STEP
from tracewire.diagram.names import find_recorded, recordable
from tracewire.diagram.problems import clip
from tracewire.diagram.quantities import read_above_zero, read_count, read_time
from tracewire.diagram.strict import Entries, Items, Node, Scalar

EXAMPLE = "[{resample: {every: 0.01}}, {detrend: theta}]"
Given = float | int | str | tuple[str, ...]


def read_clean(
    node: Node,
    body: Body,
    diagram: Diagram,
    channels: dict[str, Channel],
    inputs: Mapping[str, Channel],
) -> tuple[Cleaning, ...]:
    """The steps in their order. A signal that a step makes is added to the channels."""
    if not isinstance(node, Items) and not _is_bare(node):
        hint = f"Write it like {EXAMPLE}."
        body.problems.add("'clean' must be a list of steps", body.place(node), (), hint)
        return ()
    reader = _Reader(body, diagram, channels, inputs)
    items = node.items if isinstance(node, Items) else [node]
    found = [step for item in items if (step := reader.step(item)) is not None]
    for step in found[1:]:
        if step.step == "sort":
            hint = "Write it as the first step."
            body.problems.add("'sort' comes before all other steps", step.place, (), hint)
    return tuple(found)


def _is_bare(node: Node) -> bool:
    """Whether a step is its name alone, which says something of this one only."""
    return isinstance(node, Scalar) and node.text == "sort"


class _Reader:
    def __init__(
        self,
        body: Body,
        diagram: Diagram,
        channels: dict[str, Channel],
        inputs: Mapping[str, Channel],
    ) -> None:
        self.body, self.diagram = body, diagram
        self.channels, self.inputs = channels, inputs
        self.calibrated: set[str] = set()

    def step(self, node: Node) -> Cleaning | None:
        body = self.body
        if isinstance(node, Scalar) and _is_bare(node):
            return Cleaning(node.text, {}, body.place(node))
        if not isinstance(node, Entries) or len(node.keys) != 1:
            hint = f"Write a list like {EXAMPLE}."
            body.problems.add("a step of 'clean' has one name", body.place(node), (), hint)
            return None
        ((name, key, given),) = node
        if name not in STEPS:
            body.problems.unknown("step of 'clean'", name, STEPS, body.place(key))
            return None
        known = STEPS[name]
        first = next(iter(known))
        if isinstance(given, Entries):
            values = given.values
            body.check_keys(given, STEP[name], f"option of '{name}'")
            for needed, option in known.items():
                if option.required:
                    body.required(given, needed, f"'{name}'")
        else:  # `detrend: theta` is short for `detrend: {signals: theta}`
            values = {first: given}
            for needed, option in known.items():
                if option.required and needed != first:
                    what, hint = f"'{name}' needs '{needed}'", f"Write {needed}: ..."
                    body.problems.add(what, body.place(key), (), hint)
        options: dict[str, Given] = {}
        for option_name, option in known.items():
            if option_name in values:
                read = self.option(name, option_name, option, values[option_name])
                if read is not None:
                    options[option_name] = read
        if name == "calibrate":
            self.note_calibrated(options, key)
        if name == "differentiate":
            self.add_channel(options, values.get("sigma"), key)
        return Cleaning(name, options, body.place(key))

    def option(self, step: str, name: str, option: Option, node: Node) -> Given | None:
        body, what = self.body, f"'{name}' of '{step}'"
        match option.kind:
            case "signal":
                text = body.text(node, what)
                return self.column(text, node) if text is not None else None
            case "signals":
                found = [self.column(n.text.strip(), n) for n in body.scalars(node, what)]
                return tuple(name for name in found if name is not None)
            case "new":
                return self.new(node, what)
            case "time":
                return read_time(node, body, what)
            case "count":
                return read_count(node, body, what)
            case "size":
                return read_above_zero(node, body, what)
            case "word":
                text = body.text(node, what)
                if text is not None and text not in option.words:
                    body.problems.unknown(f"word for {what}", text, option.words, body.place(node))
                    return None
                return text
        return body.number(node, what)

    def column(self, name: str, node: Node) -> str | None:
        """The column of the record that a measured signal or input has."""
        signal = find_recorded(self.diagram, name)
        if signal is not None and signal in self.channels:
            return signal
        if name in self.inputs:
            return f"input {name}"
        known = [*self.channels, *self.inputs]
        self.body.problems.unknown("measured signal", name, known, self.body.place(node))
        return None

    def new(self, node: Node, what: str) -> str | None:
        """The signal of the diagram that a step makes a measurement of."""
        name = self.body.text(node, what)
        if name is None:
            return None
        signal, place = find_recorded(self.diagram, name), self.body.place(node)
        if signal is None:
            self.body.problems.unknown("signal", name, recordable(self.diagram), place)
        elif signal in self.channels:
            hint = "Take it out of 'signals', or name another signal."
            self.body.problems.add(f"'{clip(name)}' is measured already", place, (), hint)
            return None
        return signal

    def note_calibrated(self, options: Mapping[str, Given], key: Scalar) -> None:
        signal = str(options.get("signal", ""))
        if signal in self.calibrated:
            what = f"'{signal}' is calibrated twice"
            self.body.problems.add(what, self.body.place(key), (), "Make one step of both.")
        self.calibrated.add(signal)

    def add_channel(self, options: Mapping[str, Given], sigma: Node | None, key: Scalar) -> None:
        of, to = options.get("signal"), options.get("to")
        noise = None if sigma is None else read_above_zero(sigma, self.body, "'sigma'")
        if not isinstance(of, str) or not isinstance(to, str):
            return
        source = self.channels.get(of) or self.inputs[of.removeprefix("input ")]
        self.channels[to] = Channel(
            to,
            "",
            source.factor,
            f"{source.unit or 1}/s",
            None if noise is None else noise * source.factor,
            place=self.body.place(key),
            declared=None if source.declared is None else f"({source.declared})/s",
        )
