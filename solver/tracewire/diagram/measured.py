"""The section `measured`: records of the real thing, and how their columns fit the diagram."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

from tracewire.diagram.body import Body
from tracewire.diagram.channels import read_measured_inputs, read_signals
from tracewire.diagram.cleaning import read_clean
from tracewire.diagram.diagram import Cleaning, Clock, Diagram, Format, Series, Use, Value
from tracewire.diagram.files import is_absent, problem_of
from tracewire.diagram.grammar import CLOCK, FORMAT, SERIES
from tracewire.diagram.names import find_state, states
from tracewire.diagram.problems import clip
from tracewire.diagram.quantities import read_above_zero, read_time, read_unit_like
from tracewire.diagram.settings import read_settings
from tracewire.diagram.strict import Entries, Items, Node, Scalar
from tracewire.diagram.values import read_value

EXAMPLE = "{file: run.csv, time: t, signals: {theta: angle}}"
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
        body, given = self.body, self.entries.values
        body.check_keys(self.entries, SERIES, "key of a series")
        file = self.file()
        clock_node = body.required(self.entries, "time", self.what)
        clock = None if clock_node is None else self.clock(clock_node)
        driving = "inputs" in given  # a run may be driven by a series that has nothing to compare
        signals = (
            given.get("signals") if driving else body.required(self.entries, "signals", self.what)
        )
        channels = {} if signals is None else read_signals(signals, body, self.diagram, self.what)
        inputs = (
            read_measured_inputs(given["inputs"], body, self.diagram, self.what)
            if "inputs" in given
            else {}
        )
        begin, end = self.time("from"), self.time("to")
        if begin is not None and end is not None and not begin < end:
            what = f"{self.what} ends at {end:g}, not after its begin at {begin:g}"
            body.problems.add(what, body.place(given["to"]))
        use, windows = self.use()
        start = self.start()
        self.check_windows(windows, start)
        clean: tuple[Cleaning, ...] = ()
        if "clean" in given:
            clean = read_clean(given["clean"], body, self.diagram, channels, inputs)
        weight, where, form = self.weight(), self.where(), self.format()
        burn_in, preset = self.burn_in(), self.preset()
        if file is None or clock is None:
            return None
        return Series(
            self.name,
            file,
            use,
            clock,
            channels,
            inputs,
            start,
            preset,
            begin,
            end,
            body.place(key),
            windows=windows,
            where=where,
            burn_in=burn_in,
            weight=weight,
            clean=clean,
            format=form,
            parameters=self.parameters(),
        )

    def file(self) -> Path | None:
        node = self.body.required(self.entries, "file", self.what)
        if node is None or self.body.text(node, "'file'") is None or not isinstance(node, Scalar):
            return None
        path = node.path
        problem = problem_of(path, self.body.place(node))
        if problem is not None and not is_absent(path):  # without data a diagram can still be run
            hint = problem.hint or "The path is relative to the diagram's file."
            self.body.problems.add(problem.what, problem.place, problem.exists, hint)
        return path

    def clock(self, node: Node) -> Clock | None:
        """`time`: a column, {column, unit, zero}, or {every} where the file has no such column."""
        body = self.body
        if not isinstance(node, Entries):
            column = body.text(node, "'time'")
            return None if column is None else Clock(column)
        given = node.values
        body.check_keys(node, CLOCK, "key of a time")
        if "every" in given:
            for key in ("column", "unit"):
                if key in given:
                    what = f"the time has 'every' or '{key}', and not both"
                    body.problems.add(what, body.place(given[key]), (), "Take one away.")
        column_node = None if "every" in given else body.required(node, "column", "'time'")
        column = None if column_node is None else body.text(column_node, "'column'")
        unit = None
        if "unit" in given:
            read_unit_like(given["unit"], body, "s")
            unit = body.text(given["unit"], "a unit")
        zero = body.number(given["zero"], "'zero'") if "zero" in given else 0.0
        every = None
        if "every" in given:
            every = read_time(given["every"], body, "'every'")
            if every is not None and every <= 0:
                what = f"'every' must be above zero, not {every:g}"
                hint = "It is the time from one row to the next."
                body.problems.add(what, body.place(given["every"]), (), hint)
        if column is None and every is None:
            return None
        return Clock(column or "", unit, zero or 0.0, every)

    def use(self) -> tuple[Use, dict[Use, tuple[float, float]]]:
        """`use`: a word, or {word: [from, to]} for windows of one record."""
        node = self.entries.values.get("use")
        if isinstance(node, Entries):
            windows = self.windows(node)
            return next(iter(windows), "train"), windows
        word = "train" if node is None else self.body.text(node, "'use'")
        if node is None or word is None or word in USES:
            return USES[word or "train"], {}
        self.body.problems.unknown("use", word, USES, self.body.place(node))
        return "train", {}

    def windows(self, node: Entries) -> dict[Use, tuple[float, float]]:
        body = self.body
        found: dict[Use, tuple[float, float]] = {}
        for word, key, given in node:
            if word not in USES:
                body.problems.unknown("use", word, USES, body.place(key))
            if not isinstance(given, Items) or len(given.items) != 2:
                hint = "Write it like use: {train: [0, 30], validate: [30, 40]}."
                body.problems.add("a window is a pair of times", body.place(given), (), hint)
                continue
            if any(isinstance(item, Items) for item in given.items):
                what = f"a series has one window for '{word}', a pair of times"
                hint = "Name the file in a series more under measured:, with the other window."
                body.problems.add(what, body.place(given), (), hint)
                continue
            begin, end = (read_time(item, body, "an end of a window") for item in given.items)
            if begin is None or end is None:
                continue
            if not begin < end:
                what = f"the window ends at {end:g}, not after its begin at {begin:g}"
                body.problems.add(what, body.place(given))
            for other, (low, high) in found.items():
                if begin < high and low < end:
                    what = f"the windows '{other}' and '{word}' overlap"
                    hint = "No sample may be used for both."
                    body.problems.add(what, body.place(given), (), hint)
            if word in USES:
                found[USES[word]] = (begin, end)
        for key_name in ("from", "to"):
            if key_name in self.entries.values:
                what = f"{self.what} has windows under 'use', and '{key_name}' beside them"
                place = body.place(self.entries.values[key_name])
                body.problems.add(what, place, (), "Give the times in the windows alone.")
        return found

    def check_windows(
        self, windows: dict[Use, tuple[float, float]], start: dict[str, Value | None]
    ) -> None:
        fixed = [name for name, value in start.items() if value is not None]
        if len(windows) > 1 and fixed:
            what = (
                f"the start value of '{fixed[0]}' holds at one time, and there are several windows"
            )
            hint = f"Write start: {{{fixed[0]}: free}}."
            place = self.body.place(self.entries.values["start"])
            self.body.problems.add(what, place, (), hint)

    def time(self, key: str) -> float | None:
        node = self.entries.values.get(key)
        return None if node is None else read_time(node, self.body, f"'{key}' of {self.what}")

    def burn_in(self) -> float:
        value = self.time("burn_in")
        if value is not None and value < 0:
            what = f"'burn_in' of {self.what} must not be negative, and is {value:g}"
            self.body.problems.add(what, self.body.place(self.entries.values["burn_in"]))
        return value or 0.0

    def weight(self) -> float:
        node = self.entries.values.get("weight")
        what = f"'weight' of {self.what}"
        return 1.0 if node is None else read_above_zero(node, self.body, what) or 1.0

    def where(self) -> dict[str, str | float]:
        """`where`: the texts or numbers that a row must have in other columns."""
        node = self.entries.values.get("where")
        if node is None:
            return {}
        found: dict[str, str | float] = {}
        entries = self.body.entries(node, f"'where' of {self.what}", "{ball: Golf Ball, drop: 1}")
        for name, _, given in entries or ():
            if isinstance(given, Scalar) and given.number is not None:
                found[name] = given.number
            elif isinstance(given, Scalar):
                found[name] = given.text.strip()
            else:
                what = f"'{clip(name)}' of 'where' must be a text or a number"
                hint = "Of several values each has a series of its own."
                self.body.problems.add(what, self.body.place(given), (), hint)
        return found

    def format(self) -> Format:
        """`format`: delimiter, decimal sign, comment, and the numbers that stand for no value."""
        node = self.entries.values.get("format")
        if node is None:
            return Format()
        body = self.body
        entries = body.entries(node, f"'format' of {self.what}", "{delimiter: ';', decimal: ','}")
        if entries is None:
            return Format()
        body.check_keys(entries, FORMAT, "key of a format")
        texts = {
            name: given.text if isinstance(given, Scalar) else body.text(given, f"'{name}'")
            for name, _, given in entries
            if name != "missing"
        }
        if texts.get("decimal") not in (None, ".", ","):
            what, place = "'decimal' is '.' or ','", body.place(entries.values["decimal"])
            body.problems.add(what, place, (), "Put it into quotes.")
        delimiter = {"tab": "\t", "blank": " "}.get(
            texts.get("delimiter") or "", texts.get("delimiter")
        )
        if delimiter is not None and (len(delimiter) != 1 or delimiter.isalnum()):
            what, place = "'delimiter' is one character", body.place(entries.values["delimiter"])
            body.problems.add(what, place, (), "Write ';', ',', tab or blank.")
        codes = entries.values.get("missing", Items((), self.body.place(node), 0, 0, True))
        read = [
            body.number(code, f"'missing' of {self.what}")
            for code in (codes.items if isinstance(codes, Items) else (codes,))
        ]
        missing = tuple(code for code in read if code is not None)
        return Format(delimiter, texts.get("decimal"), texts.get("comment") or "#", missing)

    def preset(self) -> str:
        node = self.entries.values.get("preset")
        name = "" if node is None else self.body.text(node, "'preset'") or ""
        if node is not None and name and name not in self.diagram.presets:
            presets = self.diagram.presets
            self.body.problems.unknown("preset", name, presets, self.body.place(node))
        return name

    def parameters(self) -> dict[str, Value]:
        """`parameters`: values that hold in this series alone; those with `fit` are free in it."""
        node = self.entries.values.get("parameters")
        if node is None:
            return {}
        what = f"'parameters' of {self.what}"
        return read_settings(node, self.body, self.diagram, what, fit=True)

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
