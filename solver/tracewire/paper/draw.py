"""`draw`: a figure of a paper, with its caption, as a file or several."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tracewire.paper.figure import PaperFigure
from tracewire.paper.record_figures import beside_the_record
from tracewire.paper.setting import Amount, Task
from tracewire.paper.time_figures import contacts, lines_of, over_time, phase_portrait, polar_orbit
from tracewire.paper.triple_figures import attractor, branches, exponents, two_nearby, windows
from tracewire.show.style import save, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS: Mapping[str, Callable[[Task], Figure]] = {
    "time": over_time,
    "phase": phase_portrait,
    "polar": polar_orbit,
    "spectrum": lines_of,
    "record": beside_the_record,
    "contact": contacts,
    "window": windows,
    "apart": two_nearby,
    "bifurcation": branches,
    "attractor": attractor,
    "exponents": exponents,
}
COARSE: Mapping[str, str] = {
    "bifurcation": "Drawn with 160 of the paper's 800 frequencies.",
    "attractor": "Drawn with 8000 of the paper's 30 000 points.",
    "exponents": "Over 4000 s after 1000 s, a tenth of the paper's times.",
}
"""What a figure says of itself that is not drawn in full."""

LETTER = 0.066  # inch, of the caption
BELOW = 0.2  # inch, a line of the caption


def draw(
    figure: PaperFigure,
    paths: Sequence[str | Path],
    amount: Amount = "usual",
    *,
    dpi: float = 110.0,
    progress: Callable[[float, float], None] | None = None,
) -> None:
    """Draw a figure of a paper to .png, .svg or .pdf files, with its caption below.

    `amount` is "full" for as much as the paper computed; otherwise the caption says what is left
    out. Raises OptionError: another ending; OSError; what the diagram's run raises.
    """
    import matplotlib

    with styled(), matplotlib.rc_context({"text.parse_math": True, "savefig.dpi": dpi}):
        drawn = KINDS[figure.kind](Task(figure, amount, progress))
        wide, tall = drawn.get_size_inches()
        text = textwrap.fill(caption(figure, amount), int(wide / LETTER))
        drawn.set_size_inches(wide, tall + BELOW * (text.count("\n") + 1))
        drawn.supxlabel(text, x=0.01, ha="left", fontsize=8.5)
        for path in paths:
            save(drawn, path)


def caption(figure: PaperFigure, amount: Amount = "usual") -> str:
    """What stands below a figure: its number, the paper's caption, and what is different here."""
    coarse = COARSE.get(figure.kind, "") if amount == "usual" else ""
    parts = [f"Fig.\u00a0{figure.number} {figure.caption}", figure.remark, coarse]
    # lines do not break at an equals sign
    return " ".join(part for part in parts if part).replace(" = ", "\u00a0=\u00a0")
