"""The saved file of a fit: enough to go on from where it was."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tracewire.errors import Location, OptionError, Problem
from tracewire.fit.search import Search
from tracewire.residual import Criterion
from tracewire.resume import ResumeFile

KIND = "a fit of tracewire"
KEYS = ("method", "seed", "names", "best", "state", "evaluations", "iterations", "history")


class Store:
    """Writes how far a fit is to a file, now and then and at the end."""

    def __init__(self, path: str | Path, method: str) -> None:
        self.file, self.method = ResumeFile(path, KIND), method
        self.works = False
        self.remarks: tuple[str, ...] = ()

    def __call__(self, search: Search, last: bool) -> None:
        """Write, unless it was done just before.

        Raises OptionError where the first writing fails. Where a later one does, as on a disk that
        became full, the search goes on, and `remarks` says so.
        """
        if not last and not self.file.is_due:
            return
        content = {
            "method": self.method,
            "seed": search.seed,
            "names": search.criterion.names,
            "best": (search.best * search.criterion.scales).tolist(),
            "criterion": search.best_value if math.isfinite(search.best_value) else None,
            "evaluations": search.criterion.evaluations,
            "iterations": search.iterations,
            "history": [asdict(step) for step in search.history],
            "state": dict(search.state),
        }
        try:
            self.file.write(content)
        except OptionError as error:
            if not self.works:
                raise
            self.remarks = (f"the fit was not saved to its end: {error.problems[0]}",)
            return
        self.works, self.remarks = True, ()


def resume_from(path: str | Path, method: str, criterion: Criterion) -> Mapping[str, Any]:
    """The content of a saved file: `best` in SI, and `state`, empty where another method saved it.

    Raises OptionError: no such file, another content, other unknowns.
    """
    place = Location(str(path))
    try:
        content = ResumeFile(path, KIND).read()
    except OSError as error:
        what = f"the saved fit cannot be read: {error.strerror or error}"
        raise OptionError.one(what, place, hint="Check its path.") from None
    if content is None or not content.keys() >= {*KEYS}:
        hint = "Name the file that --save, or save= of fit, has written."
        raise OptionError.one("this is not the saved file of a fit", place, hint=hint)
    if content["names"] != criterion.names:
        what = f"the saved fit is one of {', '.join(content['names'])}"
        hint = f"Free the same, or begin anew; free now: {', '.join(criterion.names)}."
        raise OptionError([Problem(what, place, hint=hint)])
    if content["method"] != method:
        content["state"] = {}
    return content
