"""Ctrl-C, as the command line meets it: its exit code, and the errors that hide it."""

from __future__ import annotations

import signal

INTERRUPTED = 128 + signal.SIGINT
"""The exit code after Ctrl-C, as of a shell."""


def is_interrupt(error: BaseException) -> bool:
    """Whether an error is Ctrl-C. Python 3.11 makes a RuntimeError of what is raised while it makes
    a class, and pybind11 an ImportError of what is raised while a module of C++ is loaded."""
    hidden = isinstance(error, RuntimeError | ImportError)
    return isinstance(error.__cause__ if hidden else error, KeyboardInterrupt)
