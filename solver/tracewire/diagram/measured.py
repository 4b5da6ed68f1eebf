"""The section `measured`: records of the real thing, and how their columns fit the diagram."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import get_args

from tracewire.diagram.body import Body
from tracewire.diagram.diagram import Channel, Diagram, Series, Use, Value
from tracewire.diagram.files import problem_of
from tracewire.diagram.names import find_recorded, find_state, recordable, states
from tracewire.diagram.problems import clip
from tracewire.diagram.strict import Entries, Node, Scalar
from tracewire.diagram.values import read_bounds, read_value
from tracewire.formula import Number, Unit

EXAMPLE = "{file: run.csv, time: t, signals: {theta: angle}}"
KEYS = ("file", "use", "time", "signals", "inputs", "start", "preset", "from", "to")
USES: dict[str, Use] = {word: word for word in get_args(Use)}


def read_measured(node: Node, body: Body, diagram: Diagram) -> dict[str, Series]:
    """`measured`: a mapping of names to series. `diagram` is complete but for this section."""
    found: dict[str, Series] = {}
    for name, key, given in body.entries(node, "'measured'", f"{{run_1: {EXAMPLE}}}") or ():
        what = f"series '{clip(name)}'"
        entries = body.entries(given, what, EXAMPLE)
        if entries is not None:
            series = _Series(name, what, entries, body, diagram).read(key)
            if series is not None:
                found[name] = series
    return found


class _Series:
    def __init__(
        self, name: str, what: str, entries: Entries, body: Body, diagram: Diagram
    ) -> None:
        self.name, self.what, self.entries = name, what, entries
        self.body, self.diagram = body, diagram

    def read(self, key: Scalar) -> Series | None:
        body, entries = self.body, self.entries
        body.check_keys(entries, KEYS, "key of a series")
        file = self.file()
        time_node = body.required(entries, "time", self.what)
        time = None if time_node is None else body.text(time_node, "'time'")
        channels = self.channels()
        begin, end = self.number("from"), self.number("to")
        if begin is not None and end is not None and not begin < end:
            what = f"{self.what} ends at {end:g}, not after its begin at {begin:g}"
            body.problems.add(what, body.place(entries.values["to"]))
        use, inputs, start, preset = self.use(), self.inputs(), self.start(), self.preset()
        if file is None or time is None:
            return None
        place = body.place(key)
        return Series(
            self.name, file, use, time, channels, inputs, start, preset, begin, end, place
        )

    def file(self) -> Path | None:
        node = self.body.required(self.entries, "file", self.what)
        text = None if node is None else self.body.text(node, "'file'")
        if node is None or text is None:
            return None
        path = self.body.folder / text
        problem = problem_of(path, self.body.place(node))
        if problem is not None:
            hint = problem.hint or "The path is relative to the diagram's file."
            self.body.problems.add(problem.what, problem.place, problem.exists, hint)
        return path

    def use(self) -> Use:
        node = self.entries.values.get("use")
        word = "train" if node is None else self.body.text(node, "'use'")
        if node is None or word is None or word in USES:
            return USES[word or "train"]
        self.body.problems.unknown("use", word, USES, self.body.place(node))
        return "train"

    def number(self, key: str) -> float | None:
        node = self.entries.values.get(key)
        return None if node is None else self.body.number(node, f"'{key}' of {self.what}")

    def preset(self) -> str:
        node = self.entries.values.get("preset")
        name = "" if node is None else self.body.text(node, "'preset'") or ""
        if node is not None and name and name not in self.diagram.presets:
            presets = self.diagram.presets
            self.body.problems.unknown("preset", name, presets, self.body.place(node))
        return name

    def channels(self) -> dict[str, Channel]:
        node = self.body.required(self.entries, "signals", self.what)
        if node is None:
            return {}
        found: dict[str, Channel] = {}
        example = "{theta: {column: angle, unit: deg, sigma: 0.1}}"
        signals = self.body.entries(node, f"'signals' of {self.what}", example)
        for name, key, given in signals or ():
            signal = find_recorded(self.diagram, name)
            if signal is None:
                place = self.body.place(key)
                self.body.problems.unknown("signal", name, recordable(self.diagram), place)
            elif signal in found:
                what = f"two definitions of the signal '{clip(name)}' in {self.what}"
                self.body.problems.add(what, self.body.place(key), (), "Remove one.")
            channel = self.channel(signal or name, key, given, ("sigma", "offset"))
            if channel is not None:
                found[channel.signal] = channel
        if signals is not None and not signals.keys:
            self.body.problems.add(f"{self.what} has no signals", self.body.place(node))
        return found

    def inputs(self) -> dict[str, Channel]:
        node = self.entries.values.get("inputs")
        if node is None:
            return {}
        found: dict[str, Channel] = {}
        example = "{drive: {column: u, unit: N m}}"
        inputs = self.body.entries(node, f"'inputs' of {self.what}", example)
        for name, key, given in inputs or ():
            if name not in self.diagram.inputs:
                hint = "An input of the diagram is named under 'inputs' at its top."
                place = self.body.place(key)
                self.body.problems.unknown("input", name, self.diagram.inputs, place, hint)
            channel = self.channel(name, key, given, ())
            if channel is not None:
                found[name] = channel
        return found

    def channel(
        self, signal: str, key: Scalar, node: Node, more: tuple[str, ...]
    ) -> Channel | None:
        body, place = self.body, self.body.place(key)
        if isinstance(node, Scalar):
            return Channel(signal, node.text.strip(), place=place)
        what = f"'{clip(signal)}' of {self.what}"
        entries = body.entries(node, what, "{column: angle, unit: deg}")
        if entries is None:
            return None
        body.check_keys(entries, ("column", "unit", *more), f"key of a measured {_kind(more)}")
        column_node = body.required(entries, "column", what)
        column = None if column_node is None else body.text(column_node, "'column'")
        unit_node = entries.values.get("unit")
        unit = Unit("", 1.0) if unit_node is None else body.unit(unit_node)
        sigma, offset = None, None
        if "sigma" in more and "sigma" in entries.values:
            sigma = self.sigma(entries.values["sigma"], unit)
        if "offset" in more and "offset" in entries.values:
            offset = self.offset(entries.values["offset"], unit)
        if column is None:
            return None
        return Channel(signal, column, unit.factor, unit.text, sigma, offset, place)

    def sigma(self, node: Node, unit: Unit) -> float | None:
        sigma = self.body.number(node, "'sigma'")
        if sigma is not None and sigma <= 0:
            hint = "It is the standard deviation of the noise, in the unit of the column."
            what = f"'sigma' must be above zero, not {sigma:g}"
            self.body.problems.add(what, self.body.place(node), (), hint)
            return None
        return None if sigma is None else sigma * unit.factor

    def offset(self, node: Node, unit: Unit) -> Value | None:
        """An offset in the unit of the column; where only bounds are given it is 0 at first."""
        if isinstance(node, Entries) and "value" not in node.keys and "fit" in node.keys:
            self.body.check_keys(node, ("value", "unit", "fit"), "key of a value")
            own = self.body.unit(node.values["unit"]) if "unit" in node.values else unit
            bounds = read_bounds(node.values["fit"], self.body)
            if bounds is None:
                return None
            scaled = (bounds[0] * own.factor, bounds[1] * own.factor)
            place = self.body.place(node)
            return Value(Number(0.0), own.text, own.factor, scaled, named=True, place=place)
        value = read_value(node, self.body, unit=unit)
        return None if value is None else replace(value, named=True)

    def start(self) -> dict[str, Value | None]:
        node = self.entries.values.get("start")
        if node is None:
            return {}
        found: dict[str, Value | None] = {}
        given = self.body.entries(node, f"'start' of {self.what}", "{theta: free, omega: 0}")
        for name, key, value in given or ():
            state = find_state(self.diagram, name)
            if state is None:
                place = self.body.place(key)
                self.body.problems.unknown("state", name, states(self.diagram), place)
            elif isinstance(value, Scalar) and value.text == "free":
                found[state] = None
            elif (start := read_value(value, self.body, fit=False)) is not None:
                found[state] = start
        return found


def _kind(more: tuple[str, ...]) -> str:
    return "signal" if more else "input"
