"""Icons: lines in a box from (-1, -1) to (1, 1), y upwards."""

from __future__ import annotations

import math

from tracewire.draw.graph import Line

ACROSS = tuple(n / 24 - 1 for n in range(49))


def _steps(*levels: float) -> Line:
    """A line that keeps each level for an equal time."""
    wide = 2 / len(levels)
    return tuple((n * wide - 1 + end * wide, y) for n, y in enumerate(levels) for end in (0, 1))


SINE: Line = tuple((x, 0.85 * math.sin(math.pi * x)) for x in ACROSS[::2])
SQUARE: Line = ((-1, -0.7), (-0.5, -0.7), (-0.5, 0.7), (0, 0.7), (0, -0.7), (0.5, -0.7), (0.5, 0.7),
                (1, 0.7))  # fmt: skip
PULSES: Line = ((-1, -0.7), (-0.8, -0.7), (-0.8, 0.7), (-0.5, 0.7), (-0.5, -0.7), (0.2, -0.7),
                (0.2, 0.7), (0.5, 0.7), (0.5, -0.7), (1, -0.7))  # fmt: skip
SAWTOOTH: Line = ((-1, -0.7), (0, 0.7), (0, -0.7), (1, 0.7), (1, -0.7))
TRIANGLE: Line = ((-1, -0.7), (-0.5, 0.7), (0, -0.7), (0.5, 0.7), (1, -0.7))
CHIRP: Line = tuple((x, 0.8 * math.sin(2.2 * (x + 1.3) ** 2)) for x in ACROSS)
MULTISINE: Line = tuple(
    (x, 0.45 * math.sin(math.pi * (x + 0.2)) + 0.4 * math.sin(3 * math.pi * x)) for x in ACROSS
)
LEVELS = _steps(0.2, -0.6, 0.8, -0.1, 0.5, -0.8)
BITS = _steps(0.7, -0.7, -0.7, 0.7, -0.7, 0.7, 0.7, -0.7)
NOISE: Line = tuple(
    (n / 8 - 1, y)
    for n, y in enumerate(
        (0.1, -0.4, 0.6, -0.2, 0.3, -0.8, 0.5, 0, -0.5, 0.9, -0.3, 0.2, -0.6, 0.4, -0.1, 0.7, -0.2)
    )
)
STEP: Line = ((-1, -0.6), (-0.2, -0.6), (-0.2, 0.7), (1, 0.7))
RAMP: Line = ((-1, -0.6), (-0.4, -0.6), (1, 0.8))
STAIRS: Line = ((-1, -0.8), (-0.6, -0.8), (-0.6, -0.2), (-0.2, -0.2), (-0.2, 0.5), (0.3, 0.5),
                (0.3, 0.8), (1, 0.8))  # fmt: skip
LADDER: Line = ((-1, -0.75), (-0.6, -0.75), (-0.6, -0.25), (0, -0.25), (0, 0.25), (0.6, 0.25),
                (0.6, 0.75), (1, 0.75))  # fmt: skip
ONE_PULSE: Line = ((-1, -0.7), (-0.4, -0.7), (-0.4, 0.7), (0.4, 0.7), (0.4, -0.7), (1, -0.7))
RISE: Line = ((-1, -0.7), (0, -0.7), (0, 0.7), (1, 0.7))
RISE_HEAD: Line = ((-0.25, -0.15), (0, 0.25), (0.25, -0.15))
COUNTED: Line = ((-1, -0.7), (-0.7, -0.7), (0.1, 0.7), (0.1, -0.7), (0.4, -0.7), (0.9, 0.2))
UP: Line = ((-1, -0.7), (0.45, -0.7), (0.45, 0.7), (1, 0.7))
DOWN: Line = ((1, 0.7), (-0.45, 0.7), (-0.45, -0.7), (-1, -0.7))
PLAY_UP: Line = ((-0.4, -0.8), (0.9, 0.8), (0.4, 0.8))
PLAY_DOWN: Line = ((0.4, 0.8), (-0.9, -0.8), (-0.4, -0.8))
ARM: Line = ((-1, 0.55), (-0.5, 0.55), (0.45, 0.05))
CONTACTS: tuple[Line, ...] = (((-1, -0.55), (-0.5, -0.55)), ((0.5, 0), (1, 0)))
WAYS: tuple[Line, ...] = (((-1, 0), (-0.5, 0)), ((-1, -0.55), (-0.5, -0.55)), ((0.5, 0), (1, 0)))
BOUND: Line = ((-1, -0.8), (-0.5, -0.8), (0.5, 0.8), (1, 0.8))
FALL: Line = ((-1, 0.9), (-0.75, 0.3), (-0.55, -0.8), (-0.2, 0.2), (0.1, -0.8), (0.35, -0.3),
              (0.6, -0.8), (1, -0.8))  # fmt: skip
LOOP: Line = tuple(
    (math.cos(math.pi * n / 12), 0.8 * math.sin(math.pi * n / 12 + 0.9)) for n in range(25)
)

# the gain over the frequency, and a response to a step
LOW_PASS: Line = ((-1, 0.6), (0, 0.6), (0.8, -0.8))
HIGH_PASS: Line = ((-0.8, -0.8), (0, 0.6), (1, 0.6))
BAND_PASS: Line = ((-0.9, -0.8), (-0.2, 0.6), (0.2, 0.6), (0.9, -0.8))
NOTCH: Line = ((-1, 0.6), (-0.25, 0.6), (0, -0.8), (0.25, 0.6), (1, 0.6))
RINGING: Line = ((-1, -0.8), *(
    (x, 0.3 - 1.1 * math.exp(-2 * (x + 0.8)) * math.cos(7 * (x + 0.8))) for x in ACROSS[5:]
))  # fmt: skip
