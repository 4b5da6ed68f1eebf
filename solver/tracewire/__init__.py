"""tracewire: block diagrams that are simulated, fitted to data, and traced to what they lack.

The names of the stub beside this file are imported when they are first used, here and in each room,
so that the command line starts fast.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType

import lazy_loader

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


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
