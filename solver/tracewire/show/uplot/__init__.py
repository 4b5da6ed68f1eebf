"""uPlot, which draws the curves of an HTML report that zoom, and the script that hands them to it.

`zoom.js` reads the curves that `tracewire.show.zoom` took from a figure, and puts them in place of
its picture. Without script the picture stays.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

__all__ = ["library_script", "library_style", "scripts", "style"]

HERE = Path(__file__).parent


@cache
def style() -> str:
    """The style sheet of uPlot, and that of what stands around it, for a page."""
    return "".join(
        (HERE / name).read_text(encoding="utf-8") for name in ("uPlot.min.css", "zoom.css")
    )


@cache
def scripts() -> str:
    """uPlot and the script that draws the curves of a page with it."""
    return "\n".join(
        (HERE / name).read_text(encoding="utf-8") for name in ("uPlot.iife.min.js", "zoom.js")
    )


@cache
def library_script() -> str:
    """uPlot alone, which a page then calls by `uPlot`."""
    return (HERE / "uPlot.iife.min.js").read_text(encoding="utf-8")


@cache
def library_style() -> str:
    """The style sheet of uPlot alone."""
    return (HERE / "uPlot.min.css").read_text(encoding="utf-8")
