"""The machine code of the core in memory: the functions that Python calls."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from tracewire.compile.native import load_objects
from tracewire.errors import Problem, SimulationError
from tracewire.solve.core_build.objects import split
from tracewire.solve.core_file import object_code
from tracewire.solve.interrupt import until_interrupted

ADDRESS, COUNT, NUMBER = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
ROOM = "tracewire_solve_core_"
FAULT = "tracewire_core_fault"
REPORT = (
    "There may be no memory left. If there is, this is an error of tracewire: please report it."
)


@dataclass(frozen=True)
class Library:
    """The functions of the core by what they do, each with the addresses of its arrays.

    `advance(table)`, `advance_spans(table, spans)`, `keep_end(table, spans)`,
    `rates(table, t, x, n, out, n)`, `jacobian(table, t, x, n, out, n, n + 1)`.
    """

    advance: Callable[..., int]
    advance_spans: Callable[..., int]
    keep_end: Callable[..., None]
    rates: Callable[..., None]
    jacobian: Callable[..., None]
    fault: Any = field(repr=False)
    engine: Any = field(repr=False)

    def check(self) -> None:
        """Raises SimulationError where a function met an error that it could not tell of."""
        if self.fault.value:
            self.fault.value = 0
            raise SimulationError([Problem("the integrator failed inside a step", hint=REPORT)])


@cache
def library() -> Library:
    """The library, loaded at the first call.

    Ctrl-C is heard when it is loaded: an exception inside of LLVM would end the process.
    """
    codes = split(object_code())
    with until_interrupted() as stop_flag:
        engine = load_objects(codes)
    if stop_flag.asked:
        raise KeyboardInterrupt

    def function(name: str, result: Any, *given: Any) -> Any:
        address = engine.get_function_address(ROOM + name)
        return ctypes.CFUNCTYPE(result, *given)(address)

    vector = (ADDRESS, COUNT)
    return Library(
        function("integrate_advance", COUNT, COUNT),
        function("spans_advance_spans", COUNT, COUNT, COUNT),
        function("spans_keep_end", None, COUNT, COUNT),
        function("flow_rates", None, COUNT, NUMBER, *vector, *vector),
        function("flow_jacobian", None, COUNT, NUMBER, *vector, *vector, COUNT),
        COUNT.from_address(engine.get_global_value_address(FAULT)),
        engine,
    )
