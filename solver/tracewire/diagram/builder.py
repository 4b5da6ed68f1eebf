"""Diagrams that are built in Python, and become the YAML that a person would have written."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from tracewire.arguments import checked
from tracewire.diagram.built import Data, Names, by_python, caller, node_of, text_of
from tracewire.diagram.diagram import Diagram
from tracewire.diagram.reader import read_text
from tracewire.errors import DiagramError, Location, OptionError, unknown
from tracewire.formula import is_name, name_hint

FREE_NAMES = ("presets", "measured", "variants")
"""Sections whose names stand in no formula."""
B = TypeVar("B", bound="BodyBuilder")


class Signal(str):
    """The name of a signal; `-x` is the signal with the other sign."""

    def __neg__(self) -> Signal:
        return Signal(self[1:] if self.startswith("-") else f"-{self}")

    def output(self, name: str) -> Signal:
        """An output of a block that has several, or of a subsystem: `bearing.torque`."""
        return Signal(f"{self}.{name}")


class BodyBuilder:
    """What a diagram and a subsystem have both: inputs, parameters, blocks, events.

    Each method adds one entry and returns its name. A value is a number, a formula as text, a list
    or a mapping as in the file: {"value": 3, "unit": "N/m", "fit": [0, 10]}. `comment` stands
    behind the entry in the text. A name may be used before it is defined; `build` checks all. What
    has no place in the text raises OptionError: a name that is none or is there, NaN, an object.
    """

    def __init__(self, path: Names = ()) -> None:
        self._path = path
        self._places: dict[Names, Location] = {(): caller()}
        self._sections: dict[str, Data] = {}
        self._inner: dict[tuple[str, str], BodyBuilder] = {}
        self._comments: dict[Names, str] = {}

    @checked
    def parameter(
        self,
        name: str,
        value: float | str,
        *,
        unit: str = "",
        fit: Sequence[float] | str | None = None,
        comment: str = "",
    ) -> str:
        """A parameter. fit: its bounds in its unit, or "free", where a fit may change it."""
        given: dict[str, Data] = {"value": value}
        given |= {"unit": unit} if unit else {}
        given |= {"fit": fit} if fit is not None else {}
        self._add("parameters", name, given if len(given) > 1 else value, comment)
        return name

    @checked
    def input(
        self,
        name: str,
        *,
        unit: str = "",
        label: str = "",
        default: float | None = None,
        comment: str = "",
    ) -> Signal:
        """An input. default: its value in a run that binds no source to it."""
        given: dict[str, Data] = {"unit": unit} if unit else {}
        given |= {"label": label} if label else {}
        given |= {"default": default} if default is not None else {}
        self._add("inputs", name, given, comment)
        return Signal(name)

    @checked
    def block(self, name: str, type: str, *, comment: str = "", **settings: Data) -> Signal:
        """A block of a type, with the signals of its inputs and the values of its parameters.

        `unit`, `label`, `guess`, `place` and `replicate` are those of the file.
        """
        given = {key: value for key, value in settings.items() if value is not None}
        self._add("blocks", name, {"type": type, **given}, comment)
        return Signal(name)

    def connect(self, signal: str, block: str, input: str = "of") -> None:
        """A wire from a signal to an input of a block; behind the others, where it has some."""
        blocks = self._section("blocks")
        if block not in blocks:
            raise OptionError([unknown("block", block, blocks, caller())])
        line = blocks[block]
        known = line.get(input)
        if known is None:
            line[input] = signal
        else:
            line[input] = [*known, signal] if isinstance(known, list | tuple) else [known, signal]

    def event(
        self,
        set: Mapping[str, float | str],
        *,
        when: str | None = None,
        crosses: str | None = None,
        every: float | str | None = None,
        offset: float | str | None = None,
    ) -> None:
        """A reset of states, where `when` happens or at the ticks of a clock (`every`)."""
        given = {"when": when, "crosses": crosses, "every": every, "offset": offset, "set": set}
        self._append("events", [{key: value for key, value in given.items() if value is not None}])

    def subsystem(self, name: str, *, comment: str = "") -> SubsystemBuilder:
        """A subsystem, to which inputs, parameters, blocks and outputs are then added."""
        return self._open("subsystems", name, comment, SubsystemBuilder)

    def _open(self, section: str, name: str, comment: str, kind: type[B]) -> B:
        """A part with a body of its own, under a name in a section."""
        self._check(section, name, (known for within, known in self._inner if within == section))
        inner = self._inner[section, name] = kind((*self._path, section, name))
        self._places[section, name] = caller()
        if comment:
            self._comments[section, name] = comment
        return inner

    def _add(self, section: str, name: str, value: Data, comment: str) -> None:
        known = self._section(section)
        self._check(section, name, known)
        node_of(value, f"'{name}'")  # it is refused where it is given
        known[name] = dict(value) if isinstance(value, Mapping) else value
        self._places[section, name] = caller()
        if comment:
            self._comments[section, name] = comment

    def _section(self, name: str) -> dict[str, Data]:
        found: dict[str, Data] = self._sections.setdefault(name, {})
        return found

    def _check(self, section: str, name: str, known: Iterable[str]) -> None:
        if name in known:
            first = self._places[section, name]
            what = f"two definitions of '{name}' in '{section}': the other is in {first}"
            raise OptionError.one(what, caller(), hint="Rename one.")
        if section not in FREE_NAMES and not is_name(name):
            what = f"'{name}' cannot be a name in '{section}'"
            raise OptionError.one(what, caller(), hint=name_hint(name))

    def _append(self, section: str, items: Sequence[Data]) -> None:
        known = self._sections.setdefault(section, [])
        node_of(list(items), f"'{section}'")
        for item in items:
            self._places[section, str(len(known))] = caller()
            known.append(item)

    def _data(self) -> dict[str, Data]:
        found = dict(self._sections)
        for section in ("inputs", "outputs"):
            ports: dict[str, Data] = found.get(section, {})
            if all(not given or given == name for name, given in ports.items()) and ports:
                found[section] = list(ports)  # as a person would write it
        for (section, name), part in self._inner.items():
            found[section] = {**found.get(section, {}), name: part._data()}
        return found

    def _all_comments(self) -> dict[Names, str]:
        found = {(*self._path, *path): comment for path, comment in self._comments.items()}
        for inner in self._inner.values():
            found |= inner._all_comments()
        return found

    def _all_places(self) -> dict[Names, Location]:
        found = {(*self._path, *path): place for path, place in self._places.items()}
        for inner in self._inner.values():
            found |= inner._all_places()
        return found


class SubsystemBuilder(BodyBuilder):
    """A subsystem of a diagram that is built."""

    def output(self, name: str, signal: str = "") -> None:
        """An output: a signal of the subsystem, under this name. It is the name, unless given."""
        self._add("outputs", name, signal or name, "")

    def variant(self, name: str, *, comment: str = "") -> BodyBuilder:
        """One of several bodies, to which blocks, parameters and events are then added."""
        return self._open("variants", name, comment, BodyBuilder)

    def effect(self, coefficient: str, inputs: Mapping[str, str], **more: Data) -> None:
        """Say how a trace may add the subsystem to a diagram."""
        self._sections["effect"] = {"coefficient": coefficient, "inputs": dict(inputs), **more}
        self._places[("effect",)] = caller()


class DiagramBuilder(BodyBuilder):
    """A diagram that is built in Python from blocks and wires: `build` makes the `Diagram`.

    title, span, every, max_step, record: the sections of these names. comment: what stands above
    all. file: the file that it may be written to; files that it names are looked for from there.
    libraries: files and folders of block declarations, beside the shipped ones.
    """

    def __init__(
        self,
        title: str = "",
        *,
        span: Sequence[float | str] | None = None,
        every: float | str | None = None,
        max_step: float | str | None = None,
        record: Sequence[str] | None = None,
        include: Sequence[str] | None = None,
        comment: str = "",
        file: str | Path = "built.yaml",
        libraries: Iterable[str | Path] = (),
    ) -> None:
        super().__init__()
        given = {"title": title or None, "include": include, "span": span, "every": every}
        given |= {"max_step": max_step, "record": record}
        for name, value in given.items():
            if value is not None:
                node_of(value, f"'{name}'")
                self._sections[name] = value
                self._places[(name,)] = caller()
        self._file, self._libraries, self._comment = Path(file), tuple(libraries), comment

    def require(self, *conditions: str) -> None:
        """Conditions on parameters: `require("k > 0")`."""
        self._append("require", conditions)

    def scene(self, *parts: Mapping[str, Data]) -> None:
        """Parts of the picture: `scene({"rod": {"from": [0, 0], "to": ["x", 0]}})`."""
        self._append("scene", parts)

    def preset(self, name: str, values: Mapping[str, float | str], comment: str = "") -> None:
        """Values of parameters under a name."""
        self._add("presets", name, dict(values), comment)

    def measured(self, name: str, file: str | Path, *, comment: str = "", **more: Data) -> None:
        """A measured series; `more` are the keys of the file, such as time and signals."""
        self._add("measured", name, {"file": str(file), **more}, comment)

    @property
    def text(self) -> str:
        """The diagram as YAML."""
        return text_of(self._data(), self._all_comments(), self._comment)

    def build(self) -> Diagram:
        """The checked diagram.

        Raises DiagramError with everything that is wrong, by the lines of Python that said it.
        """
        text = self.text
        try:
            return read_text(text, self._file, self._libraries)
        except DiagramError as error:
            problems = by_python(error, text, self._file, self._all_places())
            raise DiagramError(problems) from None
