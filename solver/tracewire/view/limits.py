"""How much the live page runs, keeps and sends."""

from __future__ import annotations

from typing import Final


class ViewLimits:
    """The numbers are judgements: what a page can draw, and a person wait for."""

    samples: Final[int] = 1501
    """Of a run, evenly over its span: more than a curve has pixels."""
    most_events: Final[int] = 100_000
    """Of a run, after which it ends."""
    sent_events: Final[int] = 2000
    """More of them are counted, and not sent."""
    most_dots: Final[int] = 3000
    """Samples of a series that are drawn; of more, evenly chosen ones."""
    quick: Final[float] = 0.5
    """Seconds that a run may take whose start is fitted: a page waits for some ten of them."""
    decades: Final[float] = 2.0
    """A range above zero that spans so many is logarithmic."""
    most_versions: Final[int] = 12
    """Of a diagram that are kept, compiled."""
    most_tabs: Final[int] = 100
    """Whose latest request is known."""
    most_of_body: Final[int] = 4_000_000
    """Bytes of the body of a request."""
    idle: Final[float] = 60.0
    """Seconds after which a connection without a request is closed."""


VIEW = ViewLimits()
