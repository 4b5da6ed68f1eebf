"""A run as the page draws it: a head in JSON, and behind it all arrays as numbers."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracewire.array_types import Vector
from tracewire.errors import TracewireError
from tracewire.show import Moved, extent_of, group_signals, held_intervals, jump_times, moved_parts
from tracewire.solve import Run
from tracewire.view.limits import VIEW


class Arrays:
    """Arrays in a row, each known by its number: of 4 bytes, and where they are exact of 8."""

    def __init__(self) -> None:
        self.all: list[NDArray[np.generic]] = []

    def keep(self, values: Any, exact: bool = False) -> int:
        """Put an array at the end of the row; its number. Times are exact."""
        self.all.append(np.ascontiguousarray(values, dtype="<f8" if exact else "<f4"))
        return len(self.all) - 1

    def keep_moved(self, values: Vector) -> int:
        """Put what a scene reads at the end of the row: one value where it does not move."""
        still = len(values) and (values == values[0]).all()
        return self.keep(values[:1] if still else values)


def pack_frame(head: Mapping[str, Any], arrays: Arrays) -> bytes:
    """The length of the head in 4 bytes, the head, the arrays; each part fills a multiple of 8.

    The head gets `arrays`, of each the number of its values and their bytes.
    """
    sizes = [[len(array), array.itemsize] for array in arrays.all]
    text = json.dumps(dict(head) | {"arrays": sizes}, separators=(",", ":"), allow_nan=False)
    content = text.encode()
    content += b" " * (-(len(content) + 4) % 8)
    parts = (array.tobytes() for array in arrays.all)
    filled = (part + bytes(-len(part) % 8) for part in parts)
    return struct.pack("<I", len(content)) + content + b"".join(filled)


def panels_of(run: Run, shown: Sequence[str]) -> list[list[str]]:
    """The signals to draw, in panels of one unit and of like range."""
    kept = [[name for name in group if name in shown] for group in group_signals(run)]
    return [group for group in kept if group]


def frame_of(run: Run, panels: Sequence[Sequence[str]], arrays: Arrays) -> dict[str, Any]:
    """The head of a run: its panels, events and scene, with the numbers of its arrays."""
    head: dict[str, Any] = {"t": arrays.keep(run.t, exact=True)}
    held = held_intervals(run)
    head["panels"] = [
        {
            "unit": run.look(names[0]).unit,
            "jumps": jump_times(run, names)[: VIEW.sent_events],
            "lines": [
                {
                    "name": name,
                    "label": run.look(name).label,
                    "values": arrays.keep(run.as_shown(name)),
                    "held": held.get(name, [])[: VIEW.sent_events],
                }
                for name in names
            ],
        }
        for names in panels
    ]
    head["events"] = [
        {"t": event.time, "kind": event.kind, "block": event.block}
        for event in run.events[: VIEW.sent_events]
    ]
    head["event_count"] = len(run.events)
    head["warnings"] = list(run.warnings)
    head["run_seconds"] = run.statistics.seconds
    if run.model is not None and run.model.scene:
        head["scene"] = _scene(run, arrays)
    return head


def _scene(run: Run, arrays: Arrays) -> dict[str, Any]:
    """The parts of the scene, and what it covers in m; what is wrong where it cannot be drawn."""
    try:
        parts = moved_parts(run)
        extent = extent_of(parts)
    except TracewireError as error:
        return {"problem": str(error.problems[0])}
    return {"parts": [_part(part, arrays) for part in parts], "extent": extent}


def _part(part: Moved, arrays: Arrays) -> dict[str, Any]:
    return {
        "kind": part.kind,
        "color": part.color,
        "points": {
            key: [arrays.keep_moved(points[:, 0]), arrays.keep_moved(points[:, 1])]
            for key, points in part.points.items()
        },
        "sizes": {key: arrays.keep_moved(values) for key, values in part.sizes.items()},
    }
