"""A fit or a trace in the background: how far it is, and what it proposes for the text."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from tracewire.compile import compile
from tracewire.diagram import Diagram, SetValues, patch
from tracewire.draw import draw
from tracewire.errors import OptionError, Problem, TracewireError

if TYPE_CHECKING:
    from tracewire.fit import Fit, Progress
    from tracewire.trace import Found

KINDS = ("fit", "trace")


@dataclass(eq=False)
class Job:
    """Work on the diagram of a version, in a thread of its own.

    `text` tells how far it is. When it is `done`, `problems` or `result` is there, and `words`
    says in sentences what the result is.
    """

    kind: str
    diagram: Diagram
    values: Mapping[str, float]
    id: str = field(default_factory=lambda: secrets.token_hex(8))
    text: str = "it begins"
    done: bool = False
    problems: tuple[Problem, ...] = ()
    words: tuple[str, ...] = ()
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

    def proposal(self, effects: Collection[str] | None = None) -> dict[str, Any]:
        """The text and the picture of the diagram with the result, and its words.

        effects: those of a trace that are accepted, by their texts; None accepts all. Raises
        OptionError: no such effect.
        """
        from tracewire.fit import Fit
        from tracewire.show import draw_trace

        if self.result is None:
            raise OptionError(self.problems)
        if isinstance(self.result, Fit):
            diagram, told = self._fitted(self.result), []
            picture = draw(diagram, measured=True, like=draw(self.diagram, measured=True))
        else:
            diagram, told = self.result.apply(effects=effects), _effects_told(self.result)
            picture = draw_trace(self.result, effects)
        return {"words": self.words, "text": diagram.text, "effects": told, "svg": picture.svg}

    @cached_property
    def report(self) -> str:
        """The report of the result as an HTML page. Raises OptionError where there is none."""
        from tracewire.show import report

        if self.result is None:
            raise OptionError(self.problems)
        return report(self.result).html()

    def _work(self) -> None:
        try:
            if self.kind == "fit":
                self._fit()
            else:
                self._trace()
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

    def _fit(self) -> None:
        from tracewire.fit import fit
        from tracewire.show import fit_text, fit_words

        def progress(now: Progress) -> None:
            stage = f", {now.stage}" if now.stage else ""
            self._tell(f"{now.evaluations} evaluations{stage}, best criterion {now.best:.6g}")

        model = compile(self.diagram)
        found = fit(model, method="least_squares", parameters=self.values, progress=progress)
        self.words = (fit_text(found), *fit_words(found))
        self.result = found

    def _fitted(self, found: Fit) -> Diagram:
        """The diagram with the values that the fit has found, and with those of the page."""
        return patch(self.diagram, [SetValues({**self.values, **found.values})])

    def _trace(self) -> None:
        from tracewire.show import sentences_of
        from tracewire.trace import trace

        found = trace(compile(patch(self.diagram, [SetValues(self.values)])), progress=self._tell)
        self.words = sentences_of(found)
        self.result = found


def _effects_told(found: Found) -> list[dict[str, str]]:
    """The effects of a trace as a page lists them: their texts, their blocks, their sizes."""
    from tracewire.show import value_words

    return [
        {
            "name": str(effect),
            "block": effect.block,
            "words": value_words(found, effect, effect.coefficient),
        }
        for effect in found.effects
    ]
