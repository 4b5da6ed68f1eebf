"""`python -m tracewire.elk`: fetch the layout engine as `elk.lock.json` names it."""

from __future__ import annotations

import sys
from pathlib import Path

from tracewire.npm import fetch

FILES = {"package/lib/elk.bundled.js": "elk.bundled.js", "package/LICENSE.md": "LICENSE.md"}

if __name__ == "__main__":
    sys.stdout.write(fetch(Path(__file__).with_name("elk.lock.json"), FILES) + "\n")
