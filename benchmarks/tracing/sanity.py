"""Is a case a case? The declared model refitted by scipy alone must leave what is hidden.

`python -m benchmarks tracing --sanity`: s2 = RSS/(N - parameters - states) on windows of 1 s with
free start states, 1 at the noise. An effect that the refit absorbs is no case.
"""

from __future__ import annotations

from benchmarks.tracing.cases import Case
from benchmarks.tracing.floor.drawing import draw_rig
from benchmarks.tracing.refit import residual


def sanity(case: Case) -> str:
    """What refits by scipy and numpy leave of a case, in words."""
    if case.group not in ("floor", "floor-null"):
        return f"s2 {residual(case):10.4g}"
    _, s = draw_rig(case)
    return (
        f"truth {s.truth:.3f} of the excess, {s.truth_long:.3f} in long windows; excess "
        f"{s.excess:.2g} of the signal, floor {s.left:.2g}; {s.rival or 'no rival'} leaves "
        f"{s.apart:.3g} times as much; a law takes {s.known:.2f} of the floor; draw {s.attempt + 1}"
    )
