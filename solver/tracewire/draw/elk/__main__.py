"""`python -m tracewire.draw.elk`: fetch the layout engine as `elk.lock.json` names it.

It needs npm; nothing of what is fetched runs here.
"""

from __future__ import annotations

import base64
import hashlib
import json
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from tracewire.files import write_file

HERE = Path(__file__).parent
FILES = {"package/lib/elk.bundled.js": "elk.bundled.js", "package/LICENSE.md": "LICENSE.md"}


def integrity(content: bytes) -> str:
    """The digest of a package as npm writes it: SHA-512 in base64."""
    return "sha512-" + base64.b64encode(hashlib.sha512(content).digest()).decode("ascii")


def fetch() -> str:
    """Put the files of the locked version beside this one; what was done, in a sentence.

    Raises ValueError where the package is another than the lock file says.
    """
    lock = json.loads((HERE / "elk.lock.json").read_text(encoding="utf-8"))
    name = f"{lock['package']}@{lock['version']}"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", name, "--ignore-scripts"], cwd=folder, check=True)
        (archive,) = Path(folder).glob("*.tgz")
        digest = integrity(archive.read_bytes())
        if digest != lock["integrity"]:
            raise ValueError(f"{name} has the digest {digest}, not that of elk.lock.json")
        with tarfile.open(archive) as opened:
            for inside, own in FILES.items():
                member = opened.extractfile(inside)
                assert member is not None
                write_file(HERE / own, member.read())
    return f"{name}: {', '.join(FILES.values())}"


if __name__ == "__main__":
    sys.stdout.write(fetch() + "\n")
