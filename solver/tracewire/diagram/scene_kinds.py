"""The kinds of parts that a scene may have, and what each needs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

COLORS = ("black", "blue", "orange", "green", "pink", "grey")


@dataclass(frozen=True)
class Kind:
    """What a part of a scene needs: its points and sizes, and sizes that may be left out.

    `usual` has those with their values; None: without it the part is drawn in its own way.
    """

    points: tuple[str, ...]
    sizes: tuple[str, ...]
    usual: Mapping[str, float | None]
    example: str

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys that a part of this kind may have."""
        return (*self.points, *self.sizes, *self.usual, "color")


KINDS = {
    "rod": Kind(("from", "to"), (), {}, "{from: [0, 0], to: [x, y]}"),
    "spring": Kind(("from", "to"), (), {"coils": 8.0, "width": None}, "{from: [0, 0], to: [x, 0]}"),
    "disc": Kind(("at",), ("radius",), {"angle": None}, "{at: [x, y], radius: 0.05}"),
    "box": Kind(
        ("at",), ("width", "height"), {"angle": 0.0}, "{at: [x, 0], width: 0.3, height: 0.2}"
    ),
    "ground": Kind(("at",), ("length",), {"angle": 0.0}, "{at: [0, 0], length: 2}"),
    "trace": Kind(("at",), (), {"seconds": None}, "{at: [x, y], seconds: 2}"),
}
