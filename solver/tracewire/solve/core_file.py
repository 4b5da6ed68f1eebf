"""The machine code of the core on disk: where it lies, and how it is made where it is missing.

It belongs to a text: its name has a digest of the sources of the core and of what makes the library
of them. A package has it beside its sources, put there when the package was built. A checkout whose
sources were changed since has not: there the file is made, which takes about a minute and needs
numba, and kept in a folder of the user for all checkouts and environments with this text.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import platformdirs

from tracewire.errors import InstallationError
from tracewire.files import write_file
from tracewire.solve.code_store import CACHE, CodeStore, seal, tell, unseal
from tracewire.solve.limits import MEMORY

HERE = Path(__file__).resolve().parent
PACKAGED = HERE / "core_library"
SOURCES = (HERE / "core", HERE / "core_build")
PROCESSORS = {"x86_64": "x86-64-v2", "arm64": "apple-m1", "aarch64": "generic"}
"""What LLVM calls the least processor that is served, by the family of the machine."""
SAME = {"amd64": "x86_64"}
BEGIN = "making the integrators' machine code; this text of them has none yet. About a minute ..."
WITHOUT_NUMBA = (
    "the integrators' sources have changed since tracewire was installed, and numba, which makes "
    "machine code of them, is not installed. Install again: pip install -e ."
)


def machine() -> str:
    """The family of processors, by one name on all systems."""
    family = platform.machine().lower()
    return SAME.get(family, family)


def file_name() -> str:
    """The name of the file for the sources as they are, and for this kind of machine."""
    digest = hashlib.sha256()
    files = [file for folder in SOURCES for file in folder.rglob("*")]
    for file in sorted(file for file in files if file.suffix in (".py", ".ll")):
        content = file.read_bytes()
        digest.update(f"{file.relative_to(HERE).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return f"core-{sys.platform}-{machine()}-{digest.hexdigest()[:16]}.o"


def object_code() -> bytes:
    """The content of the file; made where it is nowhere.

    Raises InstallationError where that cannot be.
    """
    name = file_name()
    return _packaged(name) or kept_or_made(name, _store(), make)


def is_there() -> bool:
    """Whether the object file need not be made."""
    name = file_name()
    return (_packaged(name) or _store().read(name)) is not None


def put_beside_sources() -> Path:
    """Where the file then lies in the package; those of other sources are removed."""
    name, content = file_name(), object_code()
    PACKAGED.mkdir(exist_ok=True)
    for file in PACKAGED.glob("*.o"):
        file.unlink()
    return write_file(PACKAGED / name, seal(name, content))


def _packaged(name: str) -> bytes | None:
    """The content beside the sources; None where there is none, or it is damaged."""
    try:
        return unseal(name, (PACKAGED / name).read_bytes())
    except OSError:
        return None


def kept_or_made(name: str, files: CodeStore, make: Callable[[], bytes]) -> bytes:
    """The content in the user's folder, or a new one, which is then kept there."""
    found = files.read(name)
    if found is not None:
        return found
    with files.alone():
        found = files.read(name)  # what another process has made meanwhile
        if found is None:
            found = make()
            files.write(name, found)
            files.forget_all_but(MEMORY.core_files)
    return found


def make() -> bytes:
    """Make the content, in processes of their own. Raises InstallationError."""
    if importlib.util.find_spec("numba") is None:
        raise InstallationError.one(WITHOUT_NUMBA)
    tell(BEGIN)
    began = time.monotonic()
    processor = PROCESSORS.get(machine(), "generic")
    with tempfile.TemporaryDirectory(prefix="tracewire-") as folder:
        file = Path(folder, "core.o")
        command = [sys.executable, str(HERE / "core_build"), str(file), processor]
        done = subprocess.run(command, stderr=subprocess.PIPE, check=False)
        if done.returncode:
            text = done.stderr.decode(errors="replace").strip()
            raise InstallationError.one(f"the integrators' machine code could not be made:\n{text}")
        content = file.read_bytes()
    tell(f"made in {time.monotonic() - began:.0f} s")
    return content


def _store() -> CodeStore:
    """The files in the user's folder for what can be made again."""
    folder = os.environ.get(CACHE) or platformdirs.user_cache_path("tracewire")
    return CodeStore(Path(folder) / "core")
