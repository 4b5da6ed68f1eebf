"""Where the folders that come with tracewire are: beside the package, or in the checkout."""

from __future__ import annotations

from pathlib import Path

HERE = Path(__file__).parent


def shipped(room: str) -> Path:
    """The folder `room` ("blocks", "diagrams") that came with this tracewire.

    An installation has it inside the package; a checkout, and an editable install of one, has it at
    the root, two folders above the package.
    """
    inside = HERE / room
    return inside if inside.exists() else HERE.parents[1] / room
