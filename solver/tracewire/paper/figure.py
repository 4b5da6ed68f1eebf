"""`PaperFigure`: a figure of a paper that a shipped diagram can produce."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

PAPERS: Mapping[str, str] = {
    "a": "Semiempirical identification of nonlinear dynamics of a two-degree-of-freedom real "
    "torsion pendulum with a nonuniform planar stick-slip friction and elastic barriers",
    "b": "Experimental and numerical investigation of chaotic regions in the triple physical "
    "pendulum",
    "c": "On the modeling and simulation of variable-length pendulum systems: a review",
}
"""The titles of the papers, by their letter."""


@dataclass(frozen=True)
class PaperFigure:
    """A figure of a paper, and what draws it.

    `number` is the paper's, `kind` a way of drawing, `diagram` a file below `diagrams/papers`,
    `caption` what the paper writes under the figure. `panels` are the signals, those of one panel
    together; `across` is the signal of the other axis, where that is not time; `names` are those of
    lines that are not called by their signal. `presets` are those of the diagram, or the value of a
    parameter (`f=0.5`), one part of the figure each, by what the part is called. `span` in s and
    `every` in s are those of the diagram unless given. `iterations` of the simplex adapt the
    diagram to its record before it is drawn. `remark` says what differs from the paper's figure.
    """

    paper: str
    number: str
    kind: str
    diagram: str
    caption: str
    panels: tuple[tuple[str, ...], ...] = ()
    across: str = ""
    names: Mapping[str, str] = field(default_factory=dict)
    presets: Mapping[str, str] = field(default_factory=lambda: {"": ""})
    span: tuple[float, float] | None = None
    every: float | None = None
    iterations: int = 0
    remark: str = ""

    @property
    def stem(self) -> str:
        """The name of its files, without an ending: c_33."""
        return f"{self.paper}_{self.number.replace(' ', '').replace('-', '_')}"

    @property
    def signals(self) -> tuple[str, ...]:
        """All signals that it shows."""
        named = [name for panel in self.panels for name in panel]
        return tuple(dict.fromkeys([*named, *([self.across] if self.across else [])]))
