"""The files of the page, and what the browser may load for it: those alone."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tracewire.draw import STYLE
from tracewire.show import library_script, library_style, report_script, report_style

FOLDER = Path(__file__).parent / "page"
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}


def source_of(text: str) -> str:
    """A script or style sheet inside of a page, as a policy names it: by its digest."""
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
    return f"'sha256-{digest}'"


PICTURE = source_of(STYLE)
"""The digest of the style sheet inside of each picture of a diagram."""
CLOSED = ("default-src 'none'", "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'")
POLICY = "; ".join(
    (
        *CLOSED,
        "script-src 'self'",
        f"style-src 'self' {PICTURE}",
        "img-src 'self' data:",
        "connect-src 'self'",
    )
)


@dataclass(frozen=True)
class Asset:
    """A file of the page and its media type."""

    content: bytes
    kind: str


@cache
def report_policy() -> str:
    """What a report may do: run its own script, which asks this server for nothing."""
    styles = " ".join(source_of(report_style(zooming)) for zooming in (False, True))
    return "; ".join(
        (
            *CLOSED,
            "sandbox allow-scripts",
            f"script-src {source_of(report_script())}",
            f"style-src {styles}",
            "img-src data:",
        )
    )


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
