"""The font of all pictures, DejaVu Sans, and how wide a text is in it."""

from __future__ import annotations

from functools import cache, lru_cache
from importlib.util import find_spec
from pathlib import Path

from PIL import ImageFont

from tracewire.draw.limits import LETTER

FAMILY = "DejaVu Sans"


@cache
def font_file() -> Path:
    """The file of the font, which comes with matplotlib; that is not imported."""
    spec = find_spec("matplotlib")
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans.ttf"


@cache
def _font() -> ImageFont.FreeTypeFont:
    basic = ImageFont.Layout.BASIC
    return ImageFont.truetype(str(font_file()), LETTER.measured_at, layout_engine=basic)


@lru_cache(maxsize=10_000)
def text_width(text: str, size: float = LETTER.size) -> float:
    """The width of a line of text in px."""
    return float(_font().getlength(text)) * size / LETTER.measured_at


def shorten(text: str, most: float, size: float = LETTER.size) -> str:
    """The text, cut so that it is no wider than `most` px, with an ellipsis where it was cut."""
    text = " ".join(text[:500].split())
    if text_width(text, size) <= most:
        return text
    while text and text_width(f"{text}…", size) > most:
        text = text[:-1]
    return f"{text.rstrip()}…"
