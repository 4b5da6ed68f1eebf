"""The result of a simulation: samples of the recorded signals and the log of events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, overload

import numpy as np

from tracewire.array_types import Cube, Vector
from tracewire.compile import Model
from tracewire.diagram import Shown, row_ends
from tracewire.errors import OptionError, Problem, unknown
from tracewire.extras import import_extra
from tracewire.files import replacing, write_rows
from tracewire.formula import quantity_hint, read_unit, same_quantity
from tracewire.result import Result

EventKind = Literal[
    "crossing", "scheduled", "reset", "impact", "stick", "slip", "rest", "transition"
]
EventDirection = Literal["up", "down", ""]


@dataclass(frozen=True)
class Event:
    """Something that happened at an instant.

    `time` in s; `block` the signal whose formula holds the guard; `guard` the text that crossed
    zero, `direction` the way it went; `before` and `after` the states x⁻ and x⁺ by name;
    `sensitivity` d time/d name of what sensitivities were asked for, in s by SI.
    """

    time: float
    kind: EventKind
    block: str
    guard: str
    direction: EventDirection
    before: Mapping[str, float]
    after: Mapping[str, float]
    sensitivity: Mapping[str, float] = field(default_factory=dict)


class EventLog(Sequence[Event]):
    """Events in the order of time, made when first asked for: many runs are never asked."""

    def __init__(self, make: Callable[[], tuple[Event, ...]]) -> None:
        self._make = make

    @cached_property
    def _events(self) -> tuple[Event, ...]:
        return self._make()

    def __reduce__(self) -> tuple[Any, ...]:
        """What pickle keeps: the events."""
        return _log_of, (self._events,)

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Event, ...]: ...
    def __getitem__(self, index: int | slice) -> Event | tuple[Event, ...]:
        return self._events[index]

    def __len__(self) -> int:
        return len(self._events)

    def __iter__(self) -> Iterator[Event]:
        return iter(self._events)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and self._events == tuple(other)

    def __repr__(self) -> str:
        return repr(self._events)


def _log_of(events: tuple[Event, ...]) -> EventLog:
    return EventLog(lambda: events)


class Sensitivities(Mapping[str, Mapping[str, Vector]]):
    """d signal/d name (N,) at fixed times in SI, by name and by recorded signal:
    `["k"]["theta"]`; all of them as `array` (names, signals, N)."""

    def __init__(
        self, names: Sequence[str] = (), signals: Sequence[str] = (), array: Cube | None = None
    ) -> None:
        self.signals = tuple(signals)
        self.array = np.zeros((0, len(self.signals), 0)) if array is None else array
        self._rows = {name: n for n, name in enumerate(names)}

    def __getitem__(self, name: str) -> Mapping[str, Vector]:
        return dict(zip(self.signals, self.array[self._rows[name]], strict=True))

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)


@dataclass(frozen=True)
class Statistics:
    """What a run cost: accepted and rejected steps, evaluations of the rates, method by mode."""

    steps: int
    rejected: int
    evaluations: int
    stiff_steps: int
    seconds: float


@dataclass(frozen=True, eq=False, repr=False)
class Run(Result):
    """A simulated solution: `run.t` (N,) in s, `run["name"]` (N,) in SI, and `run.events`.

    A sample at the time of an event is the right limit. `parameters` and `start` are the values
    that were used; `final` holds the states at the end. `sensitivities` holds, by parameter or
    `start.state`, by recorded signal, d signal/d that (N,) in SI, at a fixed time. `shown` has the
    labels and units of tables and figures; `model` is what was simulated. `resolved` holds, by
    state, the part of its largest value so far below which the tolerances do not resolve it.
    """

    title: str
    t: Vector
    signals: Mapping[str, Vector]
    units: Mapping[str, str]
    events: Sequence[Event]
    parameters: Mapping[str, float]
    start: Mapping[str, float]
    final: Mapping[str, float]
    statistics: Statistics
    warnings: tuple[str, ...] = ()
    sensitivities: Sensitivities = field(default_factory=Sensitivities)
    shown: Mapping[str, Shown] = field(default_factory=dict)
    model: Model | None = field(default=None, repr=False)
    resolved: Mapping[str, float] = field(default_factory=dict)

    def as_shown(self, name: str) -> Vector:
        """A signal (N,) in the unit in which tables and figures show it."""
        return self[name] / self.look(name).factor

    def look(self, name: str) -> Shown:
        """The label, unit and factor to SI of a signal in tables and figures."""
        given = self.shown.get(name, Shown())
        return Shown(given.label or name, given.unit or self.units.get(name, ""), given.factor)

    def in_units(self, units: Mapping[str, str]) -> Run:
        """The run as tables and figures show it in other units: `{"x": "mm"}`; it stays in SI.

        Raises OptionError: a signal that is not recorded, a unit of another quantity; FormulaError.
        """
        shown = dict(self.shown)
        for name, text in units.items():
            self[name]  # it must exist
            unit, known = read_unit(text), self.units.get(name, "")
            if known and not same_quantity(text, known):
                what = f"'{name}' is in {known}, and '{text}' is another quantity"
                hint = quantity_hint(text, known, f"Give a unit like {known}.")
                raise OptionError([Problem(what, hint=hint)])
            shown[name] = Shown(shown.get(name, Shown()).label, text, unit.factor)
        return replace(self, shown=shown)

    def __getitem__(self, name: str) -> Vector:
        if name not in self.signals and self.model is not None:
            name = row_ends(self.model.diagram, name)
        if name not in self.signals:
            hint = "Add it to `record:` of the diagram, or to `record=` of compile."
            raise OptionError([unknown("recorded signal", name, self.signals, hint=hint)])
        return self.signals[name]

    def to_pandas(self) -> Any:
        """The samples as a DataFrame of pandas in SI, over the time `t` in s.

        `attrs["units"]` has the units, which `Measured.from_frame` reads. Raises InstallationError
        where pandas is not installed.
        """
        pandas = import_extra("pandas", "frames", "for run.to_pandas()")
        frame = pandas.DataFrame(dict(self.signals), index=pandas.Index(self.t, name="t"))
        frame.attrs["units"] = {"t": "s", **self._known_units()}
        return frame

    def to_xarray(self) -> Any:
        """The samples as a Dataset of xarray in SI, over the time `t`, with `units` and `long_name`
        as attributes. Raises InstallationError where xarray is not installed."""
        xarray = import_extra("xarray", "frames", "for run.to_xarray()")
        units = self._known_units()
        variables = {
            name: (
                "t",
                values,
                {"long_name": self.look(name).label}
                | ({"units": units[name]} if name in units else {}),
            )
            for name, values in self.signals.items()
        }
        time = {"t": ("t", self.t, {"units": "s"})}
        return xarray.Dataset(variables, time, {"title": self.title})

    def _known_units(self) -> dict[str, str]:
        """The units of the recorded signals that have one."""
        return {name: unit for name in self.signals if (unit := self.units.get(name, ""))}

    def save(self, path: str | Path) -> Path:
        """Write the samples to a .csv file, or samples and events to an .npz file."""
        path = Path(path)
        if path.suffix == ".csv":
            columns = (self.t.tolist(), *(values.tolist() for values in self.signals.values()))
            write_rows(path, ["t", *self.signals], zip(*columns, strict=True))
        elif path.suffix == ".npz":
            events = {
                "event_time": np.array([event.time for event in self.events]),
                "event_kind": np.array([event.kind for event in self.events], dtype=str),
                "event_block": np.array([event.block for event in self.events], dtype=str),
            }
            with replacing(path) as file:
                np.savez(file, allow_pickle=False, t=self.t, **self.signals, **events)
        else:
            what = f"a run cannot be saved as '{path.name}'"
            raise OptionError([Problem(what, hint="End the name in .csv or .npz.")])
        return path
