"""Pictures of results in a notebook: each is an image that has its data inside of it."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracewire.errors import OptionError
from tracewire.show.limits import FIGURE
from tracewire.show.style import STYLE, drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pictures_by(plot: Callable[[Any, Path], object]) -> Callable[[Any], str]:
    """What makes HTML of a result by a function that draws it to a file.

    It is empty where nothing can be drawn, as of a run that records nothing: the tables tell why.
    """

    def made(result: Any) -> str:
        try:
            return figure_image(drawn(lambda path: plot(result, path)))
        except OptionError:
            return ""

    return made


def figure_image(figure: Figure) -> str:
    """A figure of matplotlib as an HTML image: SVG, or PNG where that is smaller by much."""
    from matplotlib import rc_context

    title = getattr(figure, "_suptitle", None)
    words = title.get_text() if title is not None else "figure"
    with rc_context(STYLE):
        file = io.BytesIO()
        figure.savefig(file, format="svg", metadata={"Date": None})
        if file.tell() <= FIGURE.vector_bytes:
            return _image("svg+xml", file.getvalue(), words)
        file = io.BytesIO()
        figure.savefig(file, format="png")
    return _image("png", file.getvalue(), words)


def svg_image(svg: str, words: str) -> str:
    """A picture in SVG as an HTML image: what it names has no meaning outside of it."""
    return _image("svg+xml", svg.encode(), words)


def _image(kind: str, content: bytes, words: str) -> str:
    data = base64.b64encode(content).decode("ascii")
    source = f"data:image/{kind};base64,{data}"
    return f'<p><img src="{source}" alt="{html.escape(words)}" style="max-width:100%"></p>'
