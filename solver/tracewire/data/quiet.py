"""Packages that read files, kept from writing to the screen what is said as a DataError."""

from __future__ import annotations

import gc
import logging
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tracewire.errors import DataError, Location


class Attempts:
    """Calls of a package that has no class for what a damaged file makes it raise.

    `logged` is what it wrote to its log meanwhile.
    """

    def __init__(self, package: str, kind: str, path: Path, place: Location) -> None:
        self.package, self.kind, self.path, self.place = package, kind, path, place
        self.logged: list[logging.LogRecord] = []

    def __call__(self, work: Callable[[], Any]) -> Any:
        """What the call returns; DataError where it raises anything."""
        with _quiet(self.package, self.logged):
            try:
                return work()
            except DataError:
                raise
            except Exception as error:
                told = str(error) or type(error).__name__
            gc.collect()  # what is half made, and may complain when it is deleted
        raise self.damaged(told)

    def damaged(self, told: str) -> DataError:
        """The error of a file that cannot be read."""
        what = f"'{self.path}' cannot be read as {self.kind}: {told}"
        problems = DataError.one(what, self.place, hint="Save it again, or export it as CSV.")
        return DataError(problems.problems)


@contextmanager
def _quiet(package: str, logged: list[logging.LogRecord]) -> Iterator[None]:
    """Without warnings, without what the package logs, and without errors of deleted objects."""
    names = (n for n in logging.root.manager.loggerDict if f"{n}.".startswith(f"{package}."))
    loggers = [logging.getLogger(name) for name in names]
    before = [(logger.handlers, logger.propagate) for logger in loggers]
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    for logger in loggers:
        logger.handlers, logger.propagate = [_Keeping(logged)], False
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        sys.unraisablehook = hook
        for logger, (handlers, propagate) in zip(loggers, before, strict=True):
            logger.handlers, logger.propagate = handlers, propagate


class _Keeping(logging.Handler):
    """A handler that keeps what is logged."""

    def __init__(self, kept: list[logging.LogRecord]) -> None:
        super().__init__(logging.WARNING)
        self.kept = kept

    def emit(self, record: logging.LogRecord) -> None:
        self.kept.append(record)
