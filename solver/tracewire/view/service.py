"""What the page asks, and what it gets: each request is a mapping, each answer one or bytes."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from threading import Lock
from typing import Any

from tracewire.diagram import LIMITS, SetValues, complete, load_text, patch, word_before
from tracewire.draw import draw
from tracewire.errors import DiagramError, OptionError, Problem, TracewireError, unknown
from tracewire.files import write_file, writing
from tracewire.library import load_library
from tracewire.solve import Limits
from tracewire.view.comparison import comparison_of, conditions_of
from tracewire.view.export import DRAWING, figure_of, script_of
from tracewire.view.frame import Arrays, frame_of, pack_frame, panels_of
from tracewire.view.job import Job
from tracewire.view.limits import VIEW
from tracewire.view.setting import Setting, setting_of
from tracewire.view.sliders import in_si, sliders_of
from tracewire.view.version import Version, read_version, stamp_of

Request = Mapping[str, Any]
Answer = Mapping[str, Any] | bytes
PRESENTED = "this page was started with --present, and changes no file"


class Superseded(Exception):
    """A run that nobody waits for any more: its page has asked for a newer one."""


class Service:
    """A diagram file and the versions of its text that pages have, by key.

    `seconds` is the time that a run may take. `present`: the text cannot be changed or saved.
    Methods are called by several threads. Raises DiagramError where the file cannot be read at the
    start, BlockError where a library is wrong.
    """

    def __init__(
        self,
        file: str | Path,
        libraries: Iterable[str | Path] = (),
        *,
        present: bool = False,
        seconds: float = 5.0,
    ) -> None:
        self.file, self.present = Path(file), present
        self.limits = Limits(seconds=seconds, events=VIEW.most_events)
        self.library = load_library(libraries)
        self._versions: OrderedDict[str, Version] = OrderedDict()
        self._latest: OrderedDict[str, int] = OrderedDict()
        self._lock = Lock()
        self._job: Job | None = None
        self.actions: dict[str, Callable[[Request], Answer]] = {
            "open": self.open,
            "read": self.read,
            "complete": self.complete,
            "draw": self.draw,
            "run": self.run,
            "state": self.state,
            "put": self.put,
            "save": self.save,
            "export": self.export,
            "start": self.start,
            "stop": self.stop,
            "proposal": self.proposal,
        }
        self._text()

    def answer(self, action: str, request: Request) -> Answer:
        """The answer to a request; what is wrong with it is told as `problems`."""
        if action not in self.actions:
            return told([unknown("request", action, self.actions)])
        try:
            return self.actions[action](request)
        except TracewireError as error:
            return told(error.problems)

    # --- the text ---------------------------------------------------------------------------------

    def open(self, request: Request) -> Answer:
        """The text of the file as it is now, and what kind of page this is."""
        text = self._text()
        return {
            "name": self.file.name,
            "path": str(self.file),
            "text": text,
            "digest": digest_of(text),
            "present": self.present,
        }

    def read(self, request: Request) -> Answer:
        """Read a text: its key, its mistakes, and where it has none its parameters."""
        text = _text_in(request)
        if self.present and text != self._text():
            raise OptionError.one(PRESENTED)
        version = self._keep(read_version(text, self.file, self.library))
        answer: dict[str, Any] = {
            "key": version.key,
            "problems": [record_of(problem) for problem in version.problems],
            "drawn": version.diagram is not None,
            "runs": version.model is not None,
        }
        if version.model is not None:
            diagram = version.model.diagram
            answer |= {
                "title": diagram.title or self.file.stem,
                "presets": list(diagram.presets),
                "parameters": [asdict(s) for s in sliders_of(version.model)],
                "scene": bool(version.model.scene),
                "series": list(diagram.measured),
                "needs_series": any(port.default is None for port in diagram.inputs.values()),
                "fits": any(one.channels for one in diagram.measured.values()),
            }
        return answer

    def complete(self, request: Request) -> Answer:
        """What may stand at the end of a text, in place of the `word` there.

        `key` is that of the last version with a diagram, whose names are proposed.
        """
        before = _text_in(request)
        version = self._versions.get(str(request.get("key")))
        diagram = None if version is None else version.diagram
        library = self.library if diagram is None else diagram.library  # with those that it names
        found = complete(before, library, diagram)
        return {"word": word_before(before), "proposals": [asdict(one) for one in found]}

    def draw(self, request: Request) -> Answer:
        """The picture of a version as SVG, with its mistakes in red.

        `like` is the key of the version whose picture the page shows: blocks stay where they are.
        """
        version = self._version(request)
        if version.diagram is None:
            raise DiagramError(version.problems)
        if version.drawing is None:
            before = self._versions.get(str(request.get("like")))
            version.drawing = draw(
                version.diagram,
                measured=True,
                problems=version.problems,
                like=None if before is None else before.drawing,
            )
        return {"svg": version.drawing.svg}

    def put(self, request: Request) -> Answer:
        """The text of a version with other values of parameters, in the units of the file."""
        model = self._version(request).model
        if model is None:
            raise OptionError.one("the text has mistakes", hint="Repair them first.")
        changed = patch(model.diagram, [SetValues(in_si(request.get("parameters") or {}))])
        return {"text": changed.text}

    def state(self, request: Request) -> Answer:
        """The digest of the file as it is now, and whether a version's other files have changed."""
        version = self._versions.get(str(request.get("key")))
        fresh = version is None or stamp_of(version.diagram) == version.stamp
        job = None if self._job is None else self._job.state
        return {"digest": digest_of(self._text()), "fresh": fresh, "job": job}

    def save(self, request: Request) -> Answer:
        """Write a text to the file, unless that has changed since the page has read it.

        `digest` is that of the text which the page has read, or `over` is true.
        """
        if self.present:
            raise OptionError.one(PRESENTED)
        text = _text_in(request)
        now = digest_of(self._text(missing=""))
        if request.get("digest") != now and request.get("over") is not True:
            return {"conflict": True, "digest": now}
        with writing(self.file):
            write_file(self.file, text)
        return {"digest": digest_of(text)}

    # --- runs -------------------------------------------------------------------------------------

    def run(self, request: Request) -> Answer:
        """A run of a version as `frame_of` has it; a newer one of the same page ends it.

        `tab` names the page, `number` ascends with its requests; `parameters` are in SI. With a
        measured `series` it is a run under the conditions and the preset of that, and compared
        with it.
        """
        version = self._version(request)
        tab, number = str(request.get("tab", ""))[:64], int(request.get("number", 0))
        with self._lock:
            self._latest[tab] = max(number, self._latest.get(tab, 0))
            self._latest.move_to_end(tab)
            while len(self._latest) > VIEW.most_tabs:
                self._latest.popitem(last=False)

        def go_on(part: float = 0.0, left: float = 0.0) -> None:
            if self._latest.get(tab, number) > number:
                raise Superseded

        if version.model is None:
            return told(version.problems, number)
        arrays = Arrays()
        head: dict[str, Any] = {"number": number}
        try:
            with version.lock:
                go_on()
                setting = self._setting(version, request)
                run = setting.run(self.limits, go_on)
                if setting.series is not None:
                    head["measured"] = comparison_of(
                        version.model, setting.series, setting.given, self.limits, arrays
                    )
        except Superseded:
            return {"superseded": True, "number": number}
        except TracewireError as error:
            return told(error.problems, number)
        version.panels = version.panels or panels_of(run, version.shown)
        head["followed"] = {n: v for n, v in setting.values.items() if n not in setting.given}
        head["overruled"] = setting.overruled
        return pack_frame(head | frame_of(run, version.panels, arrays), arrays)

    def export(self, request: Request) -> Answer:
        """What a page shows as the text of a file: `figure` as SVG, `script`, or `diagram`."""
        version, kind = self._version(request), str(request.get("kind"))
        if version.model is None:
            return told(version.problems)
        if kind == "diagram":
            values = in_si(request.get("parameters") or {})
            changed = patch(version.model.diagram, [SetValues(values)])
            return {"name": self.file.name, "text": changed.text}
        if kind == "script" and version.text != self._text():
            what = "a script reads the diagram from its file, and the text here is another"
            raise OptionError.one(what, hint="Save the text first.")
        with version.lock:
            setting = self._setting(version, request)
            if kind == "script":
                return {"name": f"{self.file.stem}.py", "text": script_of(setting, self.file)}
            if kind == "figure":
                run = setting.run(self.limits)
                text = figure_of(setting, run, version.shown)
                return {"name": f"{self.file.stem}.svg", "text": text}
        raise OptionError([unknown("export", kind, ("figure", "script", "diagram"))])

    def _setting(self, version: Version, request: Request) -> Setting:
        """What a request asks to run. A measured series is read when it is first named."""
        assert version.model is not None
        series = str(request.get("series") or "")
        if series and series not in version.series:
            version.series[series] = conditions_of(version.model, series, self.limits)
        conditions = version.series.get(series)
        values, preset = in_si(request.get("parameters") or {}), str(request.get("preset") or "")
        return setting_of(version.model, values, preset, conditions)

    # --- fits and traces --------------------------------------------------------------------------

    def start(self, request: Request) -> Answer:
        """Begin a fit or a trace (`kind`) from these values; only one is done at a time."""
        if self.present:
            raise OptionError.one(PRESENTED)
        version = self._version(request)
        if version.model is None:
            return told(version.problems)
        with self._lock:
            if self._job is not None and not self._job.done:
                what = f"a {self._job.kind} is under way"
                raise OptionError.one(what, hint="Stop it first, or wait for its end.")
            values = in_si(request.get("parameters") or {})
            job = Job(str(request.get("kind")), version.model.diagram, values)
            job.start()
            self._job = job
        return job.state

    def stop(self, request: Request) -> Answer:
        """End the fit or trace with its best so far."""
        if self._job is not None:
            self._job.stop()
        return {}

    def proposal(self, request: Request) -> Answer:
        """What a fit or trace that is done proposes, with the picture of the diagram by then.

        `effects` are the texts of those that are accepted of a trace; without it all are.
        """
        effects = request.get("effects")
        if effects is not None and not (isinstance(effects, list) and all(map(_is_text, effects))):
            raise OptionError.one("the accepted effects are no list", hint="Name them by texts.")
        return self._ended(request.get("id")).proposal(effects)

    def report(self, id: str) -> str:
        """The report of a fit or trace that is done, as an HTML page. Raises OptionError."""
        job = self._ended(id)
        with DRAWING:
            return job.report

    def _ended(self, id: object) -> Job:
        """The fit or trace of that id, which is done. Raises OptionError: it is another one."""
        job = self._job
        if job is None or not job.done or id != job.id:
            raise OptionError.one("there is no such result any more", hint="Begin it again.")
        return job

    # --- what is kept -----------------------------------------------------------------------------

    def _text(self, missing: str | None = None) -> str:
        """The text of the file. Raises DiagramError unless `missing` stands for one not there."""
        if missing is not None and not self.file.exists():
            return missing
        return load_text(self.file)

    def _keep(self, version: Version) -> Version:
        with self._lock:
            version = self._versions.setdefault(version.key, version)
            self._versions.move_to_end(version.key)
            while len(self._versions) > VIEW.most_versions:
                self._versions.popitem(last=False)
        return version

    def _version(self, request: Request) -> Version:
        with self._lock:
            version = self._versions.get(str(request.get("key")))
            if version is not None:
                self._versions.move_to_end(version.key)
        if version is None:
            hint = "The page reads the text again by itself; else reload it."
            raise OptionError.one("this version of the text is not kept any more", hint=hint)
        return version


def told(problems: Iterable[Problem], number: int | None = None) -> dict[str, Any]:
    """An answer that tells what is wrong."""
    answer: dict[str, Any] = {"problems": [record_of(problem) for problem in problems]}
    return answer if number is None else answer | {"number": number}


def record_of(problem: Problem) -> dict[str, Any]:
    """A problem for the page: its place, and all of it in words."""
    place = problem.place
    return {
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "block": place.block,
        "text": str(problem),
    }


def digest_of(text: str) -> str:
    """What tells two texts apart."""
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _text_in(request: Request) -> str:
    text = request.get("text")
    if not isinstance(text, str) or len(text.encode(errors="replace")) > LIMITS.most_bytes:
        what = f"a text of at most {LIMITS.most_bytes // 1_000_000} MB is needed"
        raise OptionError.one(what, hint="Put subsystems into files of their own.")
    return text
