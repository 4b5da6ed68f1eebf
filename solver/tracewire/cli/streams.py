"""stdout and stderr that are closed, full, or whose reader has gone: no command fails over them."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TextIO

from tracewire.cli.output import LOST, flush, note


@dataclass
class Ending:
    """How a command ends."""

    code: int = 0


@contextmanager
def safe_streams() -> Iterator[Ending]:
    """Let both streams take any text meanwhile, and bring out at the end what was printed.

    One that is closed takes it and forgets it. The exit code of what is given is not 0 then where
    stdout did not take it all. That a reader such as `head` has seen enough is not told; a full
    disk is.
    """
    LOST.clear()
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):  # a terminal without a letter must not stop the work
            stream.reconfigure(errors="replace")
    ending = Ending()
    yield ending
    flush()
    if LOST:
        ending.code = ending.code or 1
        _forget(sys.stdout)
        if not any(isinstance(error, BrokenPipeError) for error in LOST):
            note(f"stdout cannot be written: {LOST[0].strerror or LOST[0]}.")
    try:
        sys.stderr.flush()
    except OSError:
        _forget(sys.stderr)


def _forget(stream: TextIO) -> None:
    """Let what is left in a stream go nowhere: Python would try it again at its end."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        stream.flush()
