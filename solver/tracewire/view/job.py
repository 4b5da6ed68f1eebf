"""A fit or a trace in the background: how far it is, and what it proposes for the text."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tracewire.compile import compile
from tracewire.diagram import Diagram, set_sensors, set_values
from tracewire.errors import OptionError, Problem, TracewireError

if TYPE_CHECKING:
    from tracewire.fit import Fit, Progress
    from tracewire.trace import Found

KINDS = ("fit", "trace")


@dataclass(eq=False)
class Job:
    """Work on the diagram of a version, in a thread of its own.

    `text` tells how far it is. When it is `done`, `problems` or `proposal` is there: the words of
    the result, the text of the diagram with it, and the names of the blocks that were added.
    """

    kind: str
    diagram: Diagram
    values: Mapping[str, float]
    id: str = field(default_factory=lambda: secrets.token_hex(8))
    text: str = "it begins"
    done: bool = False
    problems: tuple[Problem, ...] = ()
    proposal: Mapping[str, Any] | None = None
    result: Fit | Found | None = None
    began: float = field(default_factory=time.monotonic)
    ended: float | None = None
    _stopped: bool = False

    def start(self) -> None:
        """Begin to work. Raises OptionError for a kind that does not exist."""
        if self.kind not in KINDS:
            raise OptionError.one(f"there is no work '{self.kind}'", exists=KINDS)
        threading.Thread(target=self._work, daemon=True).start()

    def stop(self) -> None:
        """End it at the next step with the best so far, as Ctrl-C does."""
        self._stopped = True

    @property
    def state(self) -> dict[str, Any]:
        """What a page is told of it."""
        seconds = (self.ended or time.monotonic()) - self.began
        told = {"id": self.id, "kind": self.kind, "text": self.text, "done": self.done}
        return told | {"seconds": seconds}

    def _work(self) -> None:
        try:
            self.proposal = self._fitted() if self.kind == "fit" else self._traced()
        except TracewireError as error:
            self.problems = tuple(error.problems)
        except KeyboardInterrupt:
            self.problems = (Problem("it was stopped before there was a result"),)
        except Exception as error:
            what = f"internal error ({type(error).__name__}: {error})"
            self.problems = (Problem(what, hint="Please report it."),)
        self.ended = time.monotonic()
        self.done = True

    def _tell(self, text: str) -> None:
        self.text = text
        if self._stopped:
            raise KeyboardInterrupt

    def _fitted(self) -> dict[str, Any]:
        from tracewire.fit import fit
        from tracewire.show import fit_text, fit_words

        def progress(now: Progress) -> None:
            stage = f", {now.stage}" if now.stage else ""
            self._tell(f"{now.evaluations} evaluations{stage}, best criterion {now.best:.6g}")

        model = compile(self.diagram)
        found = fit(model, method="least_squares", parameters=self.values, progress=progress)
        self.result = found
        own = {n: v for n, v in found.values.items() if n in model.flat.parameters}
        sensors = {n: v for n, v in found.values.items() if n not in own}
        rest = {n: v for n, v in self.values.items() if n not in own}
        edited = set_sensors(set_values(self.diagram, {**rest, **own}), sensors)
        words = [fit_text(found), *fit_words(found)]
        return {"words": words, "text": edited.text, "added": []}

    def _traced(self) -> dict[str, Any]:
        from tracewire.show import paragraph_of
        from tracewire.trace import trace

        found = trace(compile(self.diagram), progress=self._tell)
        self.result = found
        added = [name for name in found.diagram.blocks if name not in self.diagram.blocks]
        words = [paragraph_of(found)]
        return {"words": words, "text": found.diagram.text, "added": added}
