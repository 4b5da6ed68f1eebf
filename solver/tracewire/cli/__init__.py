"""The command line: each verb is one small file, and `app` lists them."""

from __future__ import annotations

import signal
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tracewire.cli.interrupt import INTERRUPTED, is_interrupt

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

__all__ = ["main"]

SOON = 0.01
"""Seconds after which an interrupt that was lost comes again."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; see `tracewire.cli.app.main`.

    Without arguments those of the process are meant, which ends then: an interrupt while it loads
    is told as any other, one that Python would lose comes again, and one after the work changes
    nothing.
    """
    if arguments is None:
        sys.unraisablehook = _ask_again
    try:
        from tracewire.cli.app import main as run

        code = run(arguments)
    except (KeyboardInterrupt, RuntimeError, ImportError) as error:
        if not is_interrupt(error):
            raise
        if sys.stderr is not None:
            sys.stderr.write("interrupted; nothing was finished.\n")
        code = INTERRUPTED
    if arguments is None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return code


def _ask_again(lost: UnraisableHookArgs) -> None:
    """Interrupt the process once more where Python cannot raise it, as in a callback of an import:
    there it would print a traceback and go on."""
    if not isinstance(lost.exc_value, KeyboardInterrupt):
        sys.__unraisablehook__(lost)
        return
    from threading import Timer

    again = Timer(SOON, signal.raise_signal, [signal.SIGINT])
    again.daemon = True
    again.start()
