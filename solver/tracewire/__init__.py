"""tracewire: block diagrams that are simulated, fitted to data, and traced to what they lack.

The names here are imported from their rooms when they are first used, so that the command line
starts fast.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracewire.analyse import (
        Plane,
        bifurcation,
        floquet,
        growth_rate,
        invariant_drift,
        judge,
        linearise,
        lyapunov,
        periodic_orbit,
        scalogram,
        section,
        spectrum,
        stability_chart,
        steady_state,
        sweep,
    )
    from tracewire.compile import Model, compile
    from tracewire.diagram import Diagram, DiagramBuilder, read, read_text, write
    from tracewire.draw import Drawing, draw
    from tracewire.errors import TracewireError
    from tracewire.fit import Fit, diagnose, fit, fminsearch, optimset, profile
    from tracewire.library import Block, Effect, Input, Output, Parameter, State, load_library
    from tracewire.residual import Measured, Sensor, load_measured
    from tracewire.show import animate, optimplotfit, optimplotfval, optimplotx, present, report
    from tracewire.solve import (
        Held,
        InitialValueProblem,
        Integrator,
        Interrupted,
        Limits,
        Run,
        Runs,
        Section,
        initial_value_problem,
        simulate,
        simulate_many,
    )
    from tracewire.trace import Found, TraceOptions, load, save, trace

__version__ = "0.1.0"

__all__ = [
    "Block",
    "Diagram",
    "DiagramBuilder",
    "Drawing",
    "Effect",
    "Fit",
    "Found",
    "Held",
    "InitialValueProblem",
    "Input",
    "Integrator",
    "Interrupted",
    "Limits",
    "Measured",
    "Model",
    "Output",
    "Parameter",
    "Plane",
    "Run",
    "Runs",
    "Section",
    "Sensor",
    "State",
    "TraceOptions",
    "TracewireError",
    "animate",
    "bifurcation",
    "compile",
    "diagnose",
    "draw",
    "fit",
    "floquet",
    "fminsearch",
    "growth_rate",
    "initial_value_problem",
    "invariant_drift",
    "judge",
    "linearise",
    "load",
    "load_library",
    "load_measured",
    "lyapunov",
    "optimplotfit",
    "optimplotfval",
    "optimplotx",
    "optimset",
    "periodic_orbit",
    "present",
    "profile",
    "read",
    "read_text",
    "report",
    "save",
    "scalogram",
    "section",
    "simulate",
    "simulate_many",
    "spectrum",
    "stability_chart",
    "steady_state",
    "sweep",
    "trace",
    "write",
]

ROOM_OF = {
    "analyse": "Plane bifurcation floquet growth_rate invariant_drift judge linearise "
    "lyapunov periodic_orbit scalogram section spectrum stability_chart steady_state sweep",
    "compile": "compile Model",
    "diagram": "Diagram DiagramBuilder read read_text write",
    "draw": "Drawing draw",
    "errors": "TracewireError",
    "fit": "Fit diagnose fit fminsearch optimset profile",
    "library": "Block Effect Input Output Parameter State load_library",
    "residual": "Measured Sensor load_measured",
    "show": "animate optimplotfit optimplotfval optimplotx present report",
    "solve": "Held InitialValueProblem Integrator Interrupted Limits Run Runs Section "
    "initial_value_problem simulate simulate_many",
    "trace": "Found TraceOptions load save trace",
}


def __getattr__(name: str) -> object:
    for room, names in ROOM_OF.items():
        if name in names.split():
            found = globals()[name] = getattr(import_module(f"tracewire.{room}"), name)
            return found
    raise AttributeError(f"module 'tracewire' has no attribute '{name}'")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


class _Package(ModuleType):
    """The package, on which `compile`, `draw`, `fit` and `trace` stay the functions.

    Importing the room of the same name sets the attribute to the room's module; a property lets
    that pass without effect.
    """

    @staticmethod
    def _function(room: str) -> property:
        def get(_: ModuleType) -> object:
            return getattr(import_module(f"tracewire.{room}"), room)

        def ignore(_: ModuleType, module: object) -> None:
            pass

        return property(get, ignore)


for _room in ("compile", "draw", "fit", "trace"):
    setattr(_Package, _room, _Package._function(_room))
sys.modules[__name__].__class__ = _Package
