"""Plot functions of `optimset`: pictures of a search while it runs, in a window or as files."""

from __future__ import annotations

import sys
import time
from abc import ABC, abstractmethod
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tracewire.array_types import Vector
from tracewire.fit import Comparison
from tracewire.fit.optimset import OptimValues
from tracewire.show.comparison_figures import draw_comparison
from tracewire.show.limits import FIGURE, LIVE
from tracewire.show.style import AFTER, QUIET, STYLE, align_ylabels, save

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class LivePlot(ABC):
    """A plot function f(x, values, state): x (n,) is the best point, state "init", "iter", "done".

    With an interactive backend of matplotlib it redraws one window, which stays open at the end.
    Without, it saves frames NAME_0001.png and so on into `folder`, in place of those of an earlier
    search, and the last one as NAME.png. Frames come at most ten times a second and 500 in all,
    and all pictures of a search take at most a tenth of its time; the last one is always drawn.
    What goes wrong is told once on stderr, and the search goes on.
    """

    name: str

    def __init__(self, folder: str | Path = "frames") -> None:
        self.folder = Path(folder)
        self._running = False
        self._iteration = 0
        self._given_up = self._told = False
        self._began = self._last = time.perf_counter()
        self._spent, self._cost = 0.0, LIVE.first_cost
        self._frames = 0
        self._window: int | str | None = None

    def __call__(self, x: Vector, values: OptimValues, state: str) -> None:
        """Take in the point, and draw where it is time."""
        try:
            again = values.iteration < self._iteration  # a search that was never told done
            if state == "init" or not self._running or again:
                self._begin()
            self._iteration = values.iteration
            if self._given_up:
                return
            self.remember(x, values)
            now = time.perf_counter()
            if state == "done" or self._may_draw(now):
                self._draw(x, values, last=state == "done")
                self._last = time.perf_counter()
                self._cost = self._last - now
                self._spent += self._cost
        except Exception as error:  # a picture must never end a search
            self._give_up(error)
        finally:
            if state == "done":
                self._running = False
                _RUNNING.discard(self)

    def forget(self) -> None:
        """Forget what was remembered of another search: nothing."""
        return

    def remember(self, x: Vector, values: OptimValues) -> None:
        """Keep what the picture needs of every iteration, drawn or not: nothing."""
        return

    @abstractmethod
    def paint(self, figure: Figure, x: Vector, values: OptimValues) -> bool:
        """Draw into an empty figure; False where there is nothing to draw."""

    def _begin(self) -> None:
        import matplotlib.figure  # noqa: F401 - once, and at the latest for the last picture

        self._running = True
        _RUNNING.add(self)
        self._began = self._last = time.perf_counter()
        self._spent, self._cost = 0.0, LIVE.first_cost
        self._frames = 0
        self._given_up = self._told = False
        self._window = None
        self.forget()

    def _may_draw(self, now: float) -> bool:
        elapsed = now - self._began
        share = LIVE.share / max(len(_RUNNING), 1)
        return (
            self._frames < LIVE.most_frames
            and now - self._last >= max(LIVE.soonest, LIVE.thinning * elapsed)
            and self._spent + self._cost <= share * elapsed
        )

    def _draw(self, x: Vector, values: OptimValues, last: bool) -> None:
        import matplotlib

        with matplotlib.rc_context(STYLE):
            if _interactive():
                self._redraw(x, values)
            else:
                self._save(x, values, last)

    def _redraw(self, x: Vector, values: OptimValues) -> None:
        from matplotlib import pyplot

        if self._window is not None and not pyplot.fignum_exists(self._window):
            self._given_up = True  # its window was closed
            return
        figure = pyplot.figure(self.name, figsize=(FIGURE.width, 4.5))
        figure.clear()
        if not self.paint(figure, x, values):
            pyplot.close(figure)
            return
        if self._window is None:
            figure.show()
        self._window = figure.number
        figure.canvas.draw_idle()
        figure.canvas.flush_events()

    def _save(self, x: Vector, values: OptimValues, last: bool) -> None:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(FIGURE.width, 4.5))
        if not self.paint(figure, x, values):
            return
        if self._frames == 0:
            self.folder.mkdir(parents=True, exist_ok=True)
            for old in self.folder.glob(f"{self.name}_[0-9][0-9][0-9][0-9].png"):
                old.unlink()
        if not last:
            self._frames += 1
        end = "" if last else f"_{self._frames:04d}"
        save(figure, self.folder / f"{self.name}{end}.png")
        if not self._told:
            self._told = True
            _tell(
                f"{self.name}: no display; the picture is saved as {self.folder / self.name}.png, "
                f"those on the way as {self.name}_0001.png and so on"
            )

    def _give_up(self, error: Exception) -> None:
        self._given_up = True
        reason = str(error) or type(error).__name__
        if isinstance(error, OSError):
            reason = f"'{self.folder}' cannot be written: {error.strerror or error}"
        _tell(f"{self.name} draws no more pictures: {reason}")


class ValuePlot(LivePlot):
    """The criterion over the iterations, as Scilab's optimplotfval draws it."""

    name = "optimplotfval"

    def __init__(self, folder: str | Path = "frames") -> None:
        super().__init__(folder)
        self._iterations: list[int] = []
        self._values: list[float] = []

    def forget(self) -> None:
        """Forget the values of another search."""
        self._iterations, self._values = [], []

    def remember(self, x: Vector, values: OptimValues) -> None:
        """Keep the best value of each iteration."""
        if self._iterations and self._iterations[-1] == values.iteration:
            self._values[-1] = values.fval
        else:
            self._iterations.append(values.iteration)
            self._values.append(values.fval)

    def paint(self, figure: Figure, x: Vector, values: OptimValues) -> bool:
        """Draw the criterion over the iterations; on a logarithmic axis where it falls far."""
        panel = figure.subplots()
        _leave_margins(figure)
        found = np.array(self._values)
        many = len(found) > 60
        panel.plot(self._iterations, found, "-" if many else "o-", color=AFTER, markersize=4)
        finite = found[np.isfinite(found)]
        if len(finite) and finite.min() > 0 and finite.max() > 30 * finite.min():
            panel.set_yscale("log")
            panel.yaxis.set_major_formatter(lambda y, _: f"{y:g}")
        panel.set_xlabel("Iteration")
        panel.set_ylabel("Function value")
        panel.set_title(f"Current Function Value: {values.fval:g}")
        return True


class PointPlot(LivePlot):
    """The current point as bars, as Scilab's optimplotx draws it."""

    name = "optimplotx"

    def paint(self, figure: Figure, x: Vector, values: OptimValues) -> bool:
        """Draw a bar for each variable."""
        from matplotlib.ticker import MaxNLocator

        panel = figure.subplots()
        _leave_margins(figure)
        point = np.atleast_1d(np.asarray(x, dtype=float))
        panel.bar(np.arange(1, len(point) + 1), point, color=AFTER)
        panel.axhline(0.0, color=QUIET, linewidth=0.8)
        panel.xaxis.set_major_locator(MaxNLocator(integer=True))
        panel.set_xlabel(f"Number of variables: {len(point)}")
        panel.set_ylabel("Current point")
        panel.set_title(f"Current Point, iteration {values.iteration}")
        return True


class FitPlot(LivePlot):
    """Measured against simulated with the best values so far; only inside of a fit."""

    name = "optimplotfit"

    def paint(self, figure: Figure, x: Vector, values: OptimValues) -> bool:
        """Draw the first measured signals, those for training first."""
        if values.comparisons is None:
            _tell(f"{self.name} works in a fit only: a search of a function has no measured data")
            self._given_up = True
            return False
        shown = _chosen(values.comparisons())
        figure.set_size_inches(FIGURE.width, 3.1 * len(shown) + 0.9)
        axes: Any = figure.subplots(
            2 * len(shown), 1, squeeze=False, height_ratios=[2.3, 1.0] * len(shown)
        )[:, 0]
        _leave_margins(figure, top=0.65)
        for n, compared in enumerate(shown):
            draw_comparison(axes[2 * n], axes[2 * n + 1], compared, now="now")
        axes[-1].set_xlabel("t [s]")
        figure.suptitle(f"Iteration {values.iteration}: criterion {values.fval:g}",
                        fontsize=11, x=0.01, ha="left")  # fmt: skip
        align_ylabels(axes)
        return True


def _leave_margins(figure: Figure, top: float = 0.4) -> None:
    """Room for titles and labels; measuring them would cost as much as the picture."""
    wide, high = figure.get_size_inches()
    figure.subplots_adjust(
        left=1.05 / wide, right=1 - 0.15 / wide, bottom=0.55 / high, top=1 - top / high, hspace=0.55
    )


def _chosen(comparisons: tuple[Comparison, ...]) -> list[Comparison]:
    ordered = sorted(comparisons, key=lambda c: c.use != "train")
    return [compared.as_shown for compared in ordered[: LIVE.most_signals]]


def _interactive() -> bool:
    """Whether matplotlib has a window to draw in."""
    import matplotlib
    from matplotlib.backends.registry import BackendFilter, backend_registry

    backend = matplotlib.get_backend().lower()
    names = backend_registry.list_builtin(BackendFilter.INTERACTIVE)  # type: ignore[no-untyped-call]
    return backend in {name.lower() for name in names} or "ipympl" in backend


def _tell(text: str) -> None:
    with suppress(OSError):  # a full stderr must not end a search, either
        sys.stderr.write(f"{text}\n")


_RUNNING: set[LivePlot] = set()
"""The plots of searches that run now, which share the time for pictures."""

optimplotfval = ValuePlot()
optimplotx = PointPlot()
optimplotfit = FitPlot()
