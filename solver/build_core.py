"""What hatchling calls when the package is built or installed: it adds the core's machine code."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
NUMBA = ["numba>=0.62", "numpy>=2.0"]
PLATFORMS = {
    "linux": "manylinux_2_17_{0}.musllinux_1_1_{0}",
    "darwin": "macosx_11_0_{0}",
    "win32": "win_{0}",
}
"""The tags of a wheel. The machine code names functions of C's library and no version of these."""


class CoreHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the file of the machine code beside the sources, and from there into a wheel."""

    def dependencies(self) -> list[str]:
        """Numba, unless there is machine code of these sources."""
        core_file = _core_file()
        return [] if core_file.is_there() else NUMBA

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Get or make the file; an editable installation finds it beside the sources."""
        core_file = _core_file()
        file = core_file.put_beside_sources()
        if version != "editable":
            family = "amd64" if sys.platform == "win32" else core_file.machine()
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{PLATFORMS[sys.platform].format(family)}"
            inside = file.relative_to(HERE).as_posix()
            build_data["force_include"][str(file)] = inside


def _core_file() -> Any:
    """`tracewire.solve.core_file`; of the rest it needs no more than it imports itself."""
    sys.path.insert(0, str(HERE))
    return importlib.import_module("tracewire.solve.core_file")
