"""The machine code of the core, loaded before the first run of a process needs it."""

from __future__ import annotations

from functools import cache
from typing import Any, cast

from numba import types

from tracewire.solve.code_store import COMPLETE
from tracewire.solve.core.integrate import advance
from tracewire.solve.core.jit import STORE, invoke_at, ready
from tracewire.solve.interrupt import until_interrupted

VECTOR = types.float64[::1]


@cache
def load_core() -> None:
    """Load the core, once in a process, where it is kept on disk.

    Ctrl-C is heard when that is done, after about a second: LLVM calls back into Python, and an
    exception in there ends the process. To compile the core takes minutes; Ctrl-C ends that at
    once, and so nothing is done here where it is not kept.
    """
    if STORE.read(COMPLETE) is None:
        return
    with until_interrupted() as halt:
        ready(advance)
        cast(Any, invoke_at).compile((types.int64, types.float64, *[VECTOR] * 5))
    if halt.asked:
        raise KeyboardInterrupt
