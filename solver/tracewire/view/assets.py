"""The files of the page, and what the browser may load for it: those alone."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tracewire.draw import STYLE
from tracewire.show import library_script, library_style

FOLDER = Path(__file__).parent / "page"
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
PICTURE = base64.b64encode(hashlib.sha256(STYLE.encode()).digest()).decode("ascii")
"""The digest of the style sheet inside of each picture of a diagram."""
POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        f"style-src 'self' 'sha256-{PICTURE}'",
        "img-src 'self' data:",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)


@dataclass(frozen=True)
class Asset:
    """A file of the page and its media type."""

    content: bytes
    kind: str


@cache
def assets() -> Mapping[str, Asset]:
    """The files by the name in the address; the page itself has an empty one."""
    found = {
        path.name: Asset(path.read_bytes(), KINDS[path.suffix])
        for path in FOLDER.iterdir()
        if path.suffix in KINDS
    }
    found["uplot.js"] = Asset(library_script().encode(), KINDS[".js"])
    found["uplot.css"] = Asset(library_style().encode(), KINDS[".css"])
    found[""] = found.pop("index.html")
    return found
