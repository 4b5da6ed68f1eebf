"""The command line: each verb is one small file, and `app` lists them."""

from __future__ import annotations

import signal
import sys
from collections.abc import Sequence

__all__ = ["main"]

INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; see `tracewire.cli.app.main`.

    Without arguments those of the process are meant, which ends then: an interrupt while it loads
    is told as any other, and one after the work changes nothing.
    """
    try:
        from tracewire.cli.app import main as run

        code = run(arguments)
    except KeyboardInterrupt:
        if sys.stderr is not None:
            sys.stderr.write("interrupted; nothing was finished.\n")
        code = INTERRUPTED
    if arguments is None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return code
