"""The sizes of a picture of a diagram, and how much of a text or a curve it shows.

All lengths are in px. The numbers are judgements: what can be read, and looks alike.
"""

from __future__ import annotations

from typing import Final


class LetterSizes:
    """Of letters and lines of text."""

    size: Final[float] = 11.0
    """Of names."""
    small: Final[float] = 9.0
    """Of what stands beside ports, and below names."""
    title: Final[float] = 13.0
    """Of the title of a picture."""
    measured_at: Final[int] = 100
    """Of the font whose letters are measured."""
    line_height: Final[float] = 1.3
    """Of a line in units of its letters."""
    most_port: Final[float] = 90.0
    """Of the name of a port; a longer one is shortened, as the others here."""
    most_name: Final[float] = 150.0
    """Of the name of a block, and of the words below a plot."""
    most_text: Final[float] = 190.0
    """Of a line in a block."""
    most_line: Final[float] = 110.0
    """Of a title in one line; a longer one has two."""
    most_gain: Final[float] = 74.0
    """Of the value in a triangle."""
    most_note: Final[float] = 900.0
    """Of a note below the picture."""


LETTER = LetterSizes()


class ShapeSizes:
    """Of blocks, arrows and the page."""

    pitch: Final[float] = 18.0
    """Between ports."""
    box: Final[tuple[float, float]] = (44.0, 40.0)
    """The least width and height of a block."""
    line: Final[float] = 14.0
    """Between lines in a block."""
    axes: Final[float] = 46.0
    """The side of a block with a curve."""
    plot: Final[tuple[float, float]] = (104.0, 60.0)
    """Of a plot below a block."""
    arrow_head: Final[tuple[float, float]] = (7.0, 3.2)
    """Its length and half width."""
    corner: Final[float] = 3.0
    """The radius of the corners of a block."""
    tip: Final[float] = 10.0
    """The length of the tip of a tag."""
    margin: Final[float] = 6.0
    """Around the picture."""
    note_line: Final[float] = 16.0
    """Between notes below the picture."""
    least_width: Final[float] = 160.0
    """Of the picture."""
    zoom: Final[float] = 2.0
    """Pixels of a PNG for one px."""
    most_pixels: Final[int] = 16_000
    """Of the longer side of a PNG."""


SHAPE = ShapeSizes()


class LayoutLimits:
    """From when on one layout is taken rather than another one."""

    most_compact: Final[int] = 70
    """Wires up to which a picture is compact; 70 take half a second."""
    enough_kept: Final[float] = 0.9
    """The share of pairs of blocks in their order of which a picture is like another one."""
    level: Final[float] = 20.0
    """Within which two blocks stand level."""


LAYOUT = LayoutLimits()


class WireLimits:
    """Of wires of two signals that lie on each other."""

    together: Final[float] = 0.5
    """Within which two lines look like one, and over which they may do so."""
    least_gap: Final[float] = 3.5
    """Between a line that is moved and another one."""
    steps: Final[tuple[float, ...]] = (4.0, -4.0, 8.0, -8.0, 12.0, -12.0, 16.0, -16.0)
    """By which one of them is moved sideways, the first that has room."""


WIRES = WireLimits()


class CurveLimits:
    """Of the curve of a law in its block. The heights are parts of that of the curve."""

    samples: Final[int] = 32
    """An even number: none is at 0, where a friction jumps."""
    coarse: Final[int] = 8
    """The same while its scale is looked for."""
    steep: Final[float] = 0.3
    """Of the largest step between two samples: so much less a bend counts, as a ramp between two
    limits shall look like one."""
    jump: Final[float] = 0.6
    """Between two samples: it is drawn upright."""
    straight: Final[float] = 1e-6
    """A bend of less is none."""
    flat: Final[float] = 1e-12
    """Of the values: a height of less is none."""


CURVE = CurveLimits()
