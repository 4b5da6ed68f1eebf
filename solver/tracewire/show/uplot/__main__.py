"""`python -m tracewire.show.uplot`: fetch uPlot as `uplot.lock.json` names it."""

from __future__ import annotations

import sys
from pathlib import Path

from tracewire.npm import fetch

FILES = {
    "package/dist/uPlot.iife.min.js": "uPlot.iife.min.js",
    "package/dist/uPlot.min.css": "uPlot.min.css",
    "package/LICENSE": "LICENSE",
}

if __name__ == "__main__":
    sys.stdout.write(fetch(Path(__file__).with_name("uplot.lock.json"), FILES) + "\n")
