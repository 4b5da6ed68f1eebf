"""A picture as PNG: the same on each machine, with the font that comes with matplotlib."""

from __future__ import annotations

from tracewire.draw.font import FAMILY, font_file
from tracewire.draw.limits import SHAPE


def png_of(svg: str, longest: float) -> bytes:
    """The picture in two pixels for each of SVG, fewer where it is very long."""
    import resvg_py

    return bytes(
        resvg_py.svg_to_bytes(
            svg_string=svg,
            background="#ffffff",
            zoom=min(SHAPE.zoom, SHAPE.most_pixels / longest),
            skip_system_fonts=True,
            font_files=[str(font_file())],
            font_family=FAMILY,
            sans_serif_family=FAMILY,
        )
    )
