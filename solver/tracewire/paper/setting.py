"""What the figures of the papers are drawn from: models and runs, and how much of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tracewire.compile import Model, compile
from tracewire.diagram import read
from tracewire.paper.figure import PaperFigure
from tracewire.shipped import shipped
from tracewire.solve import Run, simulate

Amount = Literal["quick", "usual", "full"]
"""How much is computed: enough to see that it works, to see the figure, as much as the paper."""

RTOL = 1e-8
GREEK = {"phi": r"\varphi", "psi": r"\psi"}
SYMBOLS = {"reach": "l_1 + l_2", "analytic": "x"}


@dataclass(frozen=True)
class Task:
    """A figure that is to be drawn, how much is computed for it, and whom to tell."""

    figure: PaperFigure
    amount: Amount = "usual"
    progress: Callable[[float, float], None] | None = None

    @property
    def model(self) -> Model:
        """The model of its diagram, which records what it shows."""
        return _model(self.figure.diagram, self.figure.signals)

    def chosen(self, part: str) -> tuple[str, dict[str, float]]:
        """The preset and the parameters of a part."""
        name, equals, value = self.figure.presets[part].partition("=")
        return ("", {name: float(value)}) if equals else (name, {})

    def of(self, quick: int, usual: int, full: int) -> int:
        """The number for the amount that is asked for."""
        return {"quick": quick, "usual": usual, "full": full}[self.amount]

    def run(
        self,
        part: str = "",
        times: ArrayLike | None = None,
        values: Mapping[str, float] | None = None,
    ) -> Run:
        """The run of a part over the figure's span, at its samples or at `times` (N,) in s."""
        figure = self.figure
        preset, parameters = self.chosen(part)
        if times is None and figure.every is not None and figure.span is not None:
            begin, end = figure.span
            times = begin + figure.every * np.arange(round((end - begin) / figure.every) + 1)
        run = simulate(
            self.model,
            preset=preset,
            parameters={**parameters, **(values or {})},
            span=figure.span if times is None else None,
            times=times,
            rtol=RTOL,
        )
        if times is None and figure.every is not None:
            count = round((run.t[-1] - run.t[0]) / figure.every)
            fine = np.linspace(run.t[0], run.t[-1], count + 1)
            return self.run(part, fine, values)
        return run


@cache
def _model(diagram: str, signals: tuple[str, ...]) -> Model:
    source = read(shipped("diagrams") / "papers" / diagram)
    return compile(source, record=[name for name in signals if name not in source.record])


def symbol(name: str) -> str:
    r"""A signal as mathematics: phi1_dot is $\dot{\varphi}_1$."""
    if name in SYMBOLS:
        return f"${SYMBOLS[name]}$"
    base, dot, _ = name.partition("_dot")
    letter = base.rstrip("0123456789")
    number = base.removeprefix(letter)
    sign = GREEK.get(letter, letter)
    sign = rf"\dot{{{sign}}}" if dot else sign
    return f"${sign}_{{{number}}}$" if number else f"${sign}$"


def label(name: str, run: Run) -> str:
    """A signal as mathematics, with its unit."""
    unit = run.units.get(name, "")
    return f"{symbol(name)} [{unit}]" if unit else symbol(name)
