"""stdout and stderr that are closed, full, or whose reader has gone: no command fails over them."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TextIO

from tracewire.cli.output import LOST, flush, note


def open_streams() -> None:
    """Make both streams take any text: one that is closed takes it and forgets it."""
    LOST.clear()
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):  # a terminal without a letter must not stop the work
            stream.reconfigure(errors="replace")


def close_streams(code: int) -> int:
    """Bring out what was printed; the exit code, which is not 0 where stdout did not take it all.

    That a reader such as `head` has seen enough is not told; a full disk is.
    """
    flush()
    if LOST:
        code = code or 1
        _forget(sys.stdout)
        if not any(isinstance(error, BrokenPipeError) for error in LOST):
            note(f"stdout cannot be written: {LOST[0].strerror or LOST[0]}.")
    try:
        sys.stderr.flush()
    except OSError:
        _forget(sys.stderr)
    return code


def _forget(stream: TextIO) -> None:
    """Let what is left in a stream go nowhere: Python would try it again at its end."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        stream.flush()
