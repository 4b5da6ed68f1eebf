"""Measured series from files beside a diagram: what their columns are, by their names."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from tracewire.compile import Flat, Model, compile
from tracewire.data import Headings, read_headings
from tracewire.diagram import (
    Diagram,
    Series,
    Use,
    find_recorded,
    mapping_text,
    path_text,
    quote,
    replace_series,
    series_parts,
)
from tracewire.errors import DataError, Location, OptionError, Problem, unknown
from tracewire.formula import names_of
from tracewire.residual.endings import alike, endings

TIMES = ("t", "time", "seconds", "sec")


@dataclass(frozen=True)
class _Column:
    """A column of a file, the name that it stands for, and the unit that its own name tells."""

    name: str
    column: str
    unit: str = ""

    def text(self) -> str:
        if not self.unit:
            return quote(self.column)
        return mapping_text({"column": quote(self.column), "unit": quote(self.unit)})


def series_from_files(
    subject: Model | Diagram, files: Mapping[str, Iterable[str | Path]]
) -> tuple[Diagram, tuple[str, ...]]:
    """The diagram with these files as its measured series, and what is to be told of them.

    files: use (`train`, `gate`, `validate`) -> paths. They take the place of all series that the
    diagram has. Where it has some, the one that names the same file, else the first, tells columns,
    units, sensors, start, time and steps of cleaning; of another file the window is not taken over,
    and start values are free. Where it has none, columns are found by their names: a time is called
    `t` or `time`, a signal, state or input as in the diagram; a unit is that of the header, or of
    an ending such as `_deg` or `_rad_s`; all states are free at the start.

    The text of the new diagram has the series, so that edits go on from there. Raises DataError: no
    file to train on, a file twice, columns or inputs that are missing.
    """
    model = compile(subject) if isinstance(subject, Diagram) else subject
    return _Attaching(model, files).attached()


class _Attaching:
    def __init__(self, model: Model, files: Mapping[str, Iterable[str | Path]]) -> None:
        wrong = [unknown("use", use, get_args(Use)) for use in files if use not in get_args(Use)]
        if wrong:
            raise OptionError(wrong)
        self.model, self.diagram = model, model.diagram
        self.files = [(use, Path(path)) for use, paths in files.items() for path in paths]
        self.states = [state.name for state in model.flat.states]
        self.remarks: list[str] = []
        self.problems: list[Problem] = []

    def attached(self) -> tuple[Diagram, tuple[str, ...]]:
        self.check()
        found: dict[str, str] = {}
        for use, path in self.files:
            name = path.stem or "series"
            count = sum(other == name or other.startswith(f"{name} (") for other in found)
            name += f" ({count + 1})" if count else ""
            try:
                headings = read_headings(path, *self.form())
            except DataError as error:
                self.problems += error.problems
                continue
            parts = self.by_template(headings) if self.diagram.measured else self.by_name(headings)
            if parts is not None:
                file = quote(path_text(path, self.diagram.file.parent))
                found[name] = mapping_text({"file": file, "use": use, **parts})
        if self.problems:
            raise DataError(self.problems)
        return replace_series(self.diagram, found), tuple(dict.fromkeys(self.remarks))

    def form(self) -> tuple[str | None, str | None, str]:
        """How files are written down: as the first series of the diagram says."""
        for series in self.diagram.measured.values():
            return series.format.delimiter, series.format.decimal, series.format.comment
        return None, None, "#"

    def check(self) -> None:
        if not any(use == "train" for use, _ in self.files):
            what = "files are given, and none of them to train on"
            raise DataError.one(
                what, hint="Name at least one with --train: they replace all series."
            )
        seen: dict[str, str] = {}
        for use, path in self.files:
            real = os.path.realpath(path)
            if real in seen:
                both = f"{seen[real]} and {use}" if seen[real] != use else f"{use} twice"
                what = f"the file is given for {both}"
                hint = "Data that a fit has seen cannot check it."
                self.problems.append(Problem(what, Location(str(path)), hint=hint))
            seen[real] = use

    def by_template(self, headings: Headings) -> dict[str, str] | None:
        """The keys of a series of the diagram, for another file."""
        own, same = self.template(headings)
        without = {"file", "use", *(() if same else ("from", "to"))}
        parts = series_parts(self.diagram, own.name, without)
        place = Location(headings.file)
        missing = [column for column in _columns(own) if not headings.has(column)]
        hint = f"The series '{own.name}' of the diagram tells the columns of this file."
        for column in missing:
            self.problems.append(unknown("column", column, headings.names, place, hint))
        self.check_inputs(own.inputs, headings)
        if not same:
            kept = own.start or self.states
            free = [state for state in kept if own.start.get(state) is not None or not own.start]
            if free:
                self.remarks.append(f"{Path(headings.file).name}: the start is free")
            parts["start"] = mapping_text(dict.fromkeys(kept, "free"))
        return None if missing else parts

    def template(self, headings: Headings) -> tuple[Series, bool]:
        """The series that names this file, and whether it means the file as a whole; else the first
        that has its columns, or the first."""
        series = list(self.diagram.measured.values())
        real = os.path.realpath(headings.file)
        for own in series:
            if os.path.realpath(own.file) == real:
                return own, not own.windows
        fitting = (own for own in series if all(map(headings.has, _columns(own))))
        return next(fitting, series[0]), False

    def by_name(self, headings: Headings) -> dict[str, str] | None:
        """The keys of a series whose columns are found by their names."""
        file, place = Path(headings.file).name, Location(headings.file)
        before = len(self.problems)
        time: _Column | None = None
        signals: dict[str, _Column] = {}
        inputs: dict[str, _Column] = {}
        left: list[str] = []
        for name, unit, column in self.in_order(headings):
            clock = self.as_time(name, unit, column) if time is None else None
            bound = self.as_named(name, unit, column, self.model.flat.inputs)
            signal = None if bound else self.as_named(name, unit, column, None)
            if clock is not None:
                time = clock
            elif bound is not None and bound.name not in inputs:
                inputs[bound.name] = bound
            elif signal is not None and signal.name not in signals:
                signals[signal.name] = signal
            else:
                left.append(name)
        if time is None:
            what = "no column is the time"
            hint = "Call it 't' or 'time', with its unit, or describe the series in the diagram."
            self.problems.append(Problem(what, place, headings.names, hint))
        if not signals:
            what = "no column is named as a signal of the diagram"
            hint = f"The states are {', '.join(self.states) or 'none'}: name a column like one, or "
            hint += "describe the series in the diagram under `measured:`."
            self.problems.append(Problem(what, place, headings.names, hint))
        self.check_inputs(inputs, headings)
        if left:
            some = f"the column '{left[0]}'" if len(left) == 1 else f"the columns {', '.join(left)}"
            self.remarks.append(f"{file}: not used: {some}")
        for found in (time, *signals.values(), *inputs.values()):
            if found is not None and found.unit:
                what = f"{file}: the column '{found.column}' is taken in {found.unit}, by its name"
                self.remarks.append(what)
        if time is None or len(self.problems) > before:
            return None
        parts = {"time": time.text()}
        parts["signals"] = mapping_text({name: c.text() for name, c in signals.items()})
        if inputs:
            parts["inputs"] = mapping_text({name: c.text() for name, c in inputs.items()})
        if self.states:
            parts["start"] = mapping_text(dict.fromkeys(self.states, "free"))
        return parts

    def in_order(self, headings: Headings) -> Iterator[tuple[str, str, str]]:
        """The columns, those that are named exactly as in the diagram first."""
        columns = list(headings)
        flat = self.model.flat

        def exact(column: tuple[str, str, str]) -> bool:
            name = column[0]
            return name in TIMES or name in flat.inputs or self.signal(name) is not None

        return iter(sorted(columns, key=lambda column: not exact(column)))

    def as_time(self, name: str, unit: str, column: str) -> _Column | None:
        if name.lower() in TIMES:
            return _Column("t", column)
        for stem, told in endings(name):
            if stem.lower() in TIMES and not unit and alike(told, "s"):
                return _Column("t", column, "" if told == "s" else told)
        return None

    def as_named(
        self, name: str, unit: str, column: str, inputs: Iterable[str] | None
    ) -> _Column | None:
        """A column as an input, or (None) as a signal: by its name, or that without its unit."""
        find = (
            self.signal
            if inputs is None
            else (lambda n: n if n in self.model.flat.inputs else None)
        )
        full = find(name)
        if full is not None:
            return _Column(full, column)
        for stem, told in endings(name):
            full = find(stem)
            if full is not None and alike(told, self.unit(full)):
                return _Column(full, column, "" if unit else told)
        return None

    def unit(self, name: str) -> str:
        port = self.diagram.inputs.get(name)
        return port.unit if port is not None else self.model.flat.units.get(name, "")

    def signal(self, name: str) -> str | None:
        """The full name of a signal that depends on a state or an input, or None.

        A source is none: that the diagram agrees with a record of it says nothing of the diagram.
        """
        full = find_recorded(self.diagram, name)
        return full if full is not None and _responds(self.model.flat, full) else None

    def check_inputs(self, known: Iterable[str], headings: Headings) -> None:
        """An input without a column needs a default."""
        given = set(known)
        for name, default in self.model.flat.inputs.items():
            if name in given:
                continue
            if default is None:
                what = f"no column is the input '{name}' of the diagram, which has no default"
                hint = f"Name the column '{name}', or bind it under `inputs:` of a series."
                place = Location(headings.file)
                self.problems.append(Problem(what, place, headings.names, hint))
            else:
                file = Path(headings.file).name
                self.remarks.append(f"{file}: no column is the input '{name}': its default counts")


def _responds(flat: Flat, name: str) -> bool:
    """Whether a signal exists and reads a state or an input, directly or through others."""
    sources = {*(state.name for state in flat.states), *flat.inputs}
    seen: set[str] = set()
    open_ = [name]
    while open_:
        if (now := open_.pop()) in seen:
            continue
        seen.add(now)
        if now in sources:
            return True
        if now in flat.signals:
            open_ += names_of(flat.signals[now])
    return False


def _columns(series: Series) -> list[str]:
    """The columns that a series reads, each once."""
    channels = [*series.channels.values(), *series.inputs.values()]
    columns = [series.time.column, *(channel.column for channel in channels), *series.where]
    return list(dict.fromkeys(column for column in columns if column))
