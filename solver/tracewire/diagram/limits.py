"""How large a diagram may be, so that a wrong or hostile file is refused rather than waited for.

The numbers are judgements: far above what people write, and what a run can still do with.
"""

from __future__ import annotations

from typing import Final


class DiagramLimits:
    """Limits of files, of texts, and of what stands in them; and what a message shows of it."""

    most_bytes: Final[int] = 1_000_000
    """Of a file."""
    longest_path: Final[int] = 4096
    """Characters of a path, as in Linux."""
    most_nesting: Final[int] = 60
    """Lists and mappings in each other."""
    longest_key: Final[int] = 100
    """Characters."""
    most_entries: Final[int] = 10_000
    """Of a vector or matrix: 100 x 100 compiles in seconds, 500 x 500 in hours."""
    most_levels: Final[int] = 30
    """Of diagrams that extend each other, and of files that include each other."""
    most_extended: Final[int] = 20_000
    """Values and lists of a subsystem that may be extended: those of 2000 blocks. A file that
    extends twice what another one does doubles with each file."""
    most_blocks: Final[int] = 100_000
    """Of a diagram, with all subsystems."""
    most_copies: Final[int] = 10_000
    """In a row."""
    most_parts: Final[int] = 200
    """Of a scene."""
    most_values: Final[int] = 100_000
    """Of an axis of a sweep."""
    most_samples: Final[int] = 1_000_000
    """That a run records."""
    most_problems: Final[int] = 100
    """That are told; of more only a count."""
    most_compared: Final[int] = 20_000
    """Names that a wrong one is compared with, in all: a tenth of a millisecond each."""
    longest_quote: Final[int] = 60
    """Characters of a text that a message quotes."""
    longest_loop: Final[int] = 100
    """Names of a loop that a message lists."""
    most_completions: Final[int] = 60
    """That an editor is offered."""


LIMITS = DiagramLimits()


class LayoutSizes:
    """Of a diagram as it is written, in characters."""

    indent: Final[int] = 2
    """Blanks for each level."""
    before_comment: Final[int] = 2
    """Blanks between a line and its comment."""
    width: Final[int] = 100
    """The longest line that a mapping in braces may take; a longer one gets a line for each
    entry."""


LAYOUT = LayoutSizes()
