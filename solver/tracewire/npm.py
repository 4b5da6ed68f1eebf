"""Scripts of others that are shipped: fetched from npm as a lock file beside them names them."""

from __future__ import annotations

import base64
import hashlib
import json
import subprocess
import tarfile
import tempfile
from collections.abc import Mapping
from pathlib import Path

from tracewire.files import write_file


def integrity(content: bytes) -> str:
    """The digest of a package as npm writes it: SHA-512 in base64."""
    return "sha512-" + base64.b64encode(hashlib.sha512(content).digest()).decode("ascii")


def fetch(lock_file: Path, files: Mapping[str, str]) -> str:
    """Put files of the locked version beside the lock file; what was done, in a sentence.

    files: names inside the package, and here. It needs npm; nothing of what is fetched runs here.
    Raises ValueError where the package is another than the lock file says.
    """
    lock = json.loads(lock_file.read_text(encoding="utf-8"))
    name = f"{lock['package']}@{lock['version']}"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", name, "--ignore-scripts"], cwd=folder, check=True)
        (archive,) = Path(folder).glob("*.tgz")
        digest = integrity(archive.read_bytes())
        if digest != lock["integrity"]:
            raise ValueError(f"{name} has the digest {digest}, not that of {lock_file.name}")
        with tarfile.open(archive) as opened:
            for inside, own in files.items():
                member = opened.extractfile(inside)
                assert member is not None
                write_file(lock_file.with_name(own), member.read())
    return f"{name}: {', '.join(files.values())}"
