"""The look that all figures share, and how a figure becomes a file."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tracewire.errors import OptionError, unknown
from tracewire.files import replacing
from tracewire.show.limits import FIGURE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

ENDINGS = (".png", ".svg", ".pdf")

# told apart with every kind of colour vision (Okabe and Ito, 2008)
LINES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
MEASURED, BEFORE, AFTER = "#4D4D4D", "#E69F00", "#0072B2"
MARK, QUIET = "#B22222", "#8C8C8C"
STICK, EDGE = "#D9D4C7", "#A39A7E"
BAND, UNCOUNTED = "#E3EEF6", "#F1F1F1"
USES = {"train": "#CFE3F2", "gate": "#E4DAF0", "validate": "#D5EBDD"}

STYLE: dict[Any, Any] = {
    "figure.dpi": 110,
    "savefig.dpi": 110,
    "font.size": 9.5,
    "axes.titlesize": 10,
    "axes.labelsize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#666666",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E6E6E6",
    "grid.linewidth": 0.7,
    "xtick.color": "#444444",
    "ytick.color": "#444444",
    "lines.linewidth": 1.3,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-3, 4),
    "text.parse_math": False,  # a `$` in a user's title is a `$`
    "svg.hashsalt": "tracewire",  # the same run gives the same file
    "agg.path.chunksize": 0,  # a curve in pieces has a hole between each two
}

_SAVED: ContextVar[list[Figure] | None] = ContextVar("_SAVED", default=None)
_WRITING: ContextVar[bool] = ContextVar("_WRITING", default=True)


@contextmanager
def saved_figures() -> Iterator[list[Figure]]:
    """The figures that are saved meanwhile, for what takes more of them than their picture."""
    found: list[Figure] = []
    before = _SAVED.set(found)
    try:
        yield found
    finally:
        _SAVED.reset(before)


@contextmanager
def styled() -> Iterator[None]:
    """The style of tracewire's figures, for as long as one is drawn and saved."""
    import matplotlib

    with matplotlib.rc_context(STYLE), warnings.catch_warnings():
        # a title in letters that the font lacks is drawn with boxes
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)
        yield


def panels(
    heights: Sequence[float], title: str = "", sharex: bool = True
) -> tuple[Figure, list[Axes]]:
    """A figure with one panel above the other, of the given heights in inches."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(FIGURE.width, sum(heights) + 0.7), layout="constrained")
    grid = figure.subplots(
        len(heights), 1, sharex=sharex, squeeze=False, height_ratios=list(heights)
    )
    if title:
        figure.suptitle(title, fontsize=12, x=0.01, ha="left")
    return figure, list(grid[:, 0])


def save(figure: Figure, path: str | Path) -> Path:
    """Write a figure to .png, .svg or .pdf. Raises OptionError for another ending, and OSError."""
    path = Path(path)
    if path.suffix not in ENDINGS:
        raise OptionError([unknown("ending of a figure", path.suffix, ENDINGS)])
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    if _WRITING.get():
        with replacing(path) as file:
            _write(figure, file, format=path.suffix[1:], metadata=dated.get(path.suffix))
    saved = _SAVED.get()
    if saved is not None:
        saved.append(figure)
    return path


def _write(figure: Figure, file: IO[bytes], **given: Any) -> None:
    """Write a figure to a file, its curves in pieces where one is too long for the renderer."""
    import matplotlib

    try:
        figure.savefig(file, **given)
    except OverflowError:
        with matplotlib.rc_context({"agg.path.chunksize": FIGURE.piece}):
            figure.savefig(file, **given)


def drawn(draw: Callable[[Path], object]) -> Figure:
    """The figure that a function draws to a file, without the file; a notebook shows it."""
    from tracewire.show.picture import Picture

    token = _WRITING.set(False)
    try:
        with saved_figures() as found:
            draw(Path("figure.png"))
    finally:
        _WRITING.reset(token)
    figure = found[-1]
    figure.__class__ = Picture
    return figure


def fit_time(panel: Axes, t: NDArray[np.float64]) -> None:
    """Let the time axis end where the samples do."""
    if t[-1] > t[0]:
        panel.set_xlim(float(t[0]), float(t[-1]))


def with_gaps(
    t: NDArray[np.float64], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A curve y(t), (N,), that is not joined over gaps in its times: nobody knows it there."""
    if len(t) < 2:
        return t, y
    steps = np.diff(t)
    behind = np.flatnonzero(steps > FIGURE.gap * np.median(steps)) + 1
    return np.insert(t, behind, t[behind - 1]), np.insert(y, behind, np.nan)


def dots(count: int) -> dict[str, Any]:
    """Dots that are seen where there are few, and do not hide the lines where there are many."""
    return {
        "color": MEASURED,
        "linestyle": "",
        "marker": ".",
        "markersize": float(np.clip(60 / np.sqrt(max(count, 1)), 1.5, 5)),
        "alpha": 0.6,
    }


def shortened(title: str, count: int, most: int, kind: str) -> str:
    """A title that says so where only the first `most` of `count` things are drawn."""
    more = f"(the first {most} of {count} {kind})" if count > most else ""
    return " ".join(part for part in (title, more) if part)


def cut(name: str, most: int = 24) -> str:
    """A name that is too long for a figure, without its middle."""
    half = (most - 1) // 2
    return name if len(name) <= most else f"{name[:half]}…{name[-half:]}"


def align_ylabels(axes: Iterable[Axes]) -> None:
    """Put the labels of y below each other, left of any tick.

    matplotlib's own way looks at every panel for every other one: seconds for a dozen.
    """
    for panel in axes:
        panel.yaxis.set_label_coords(-0.083, 0.5)


def plain_numbers(*axes: Axis) -> None:
    """Write the numbers of axes without a common factor, whose place is above the panel."""
    for axis in axes:
        axis.set_major_formatter(lambda x, _: f"{x:.10g}".replace("-", "−"))


def plain_log(axis: Axis, low: float, high: float) -> None:
    """Write the numbers of a logarithmic axis plainly, over less than two decades 2 and 5, too."""
    from matplotlib.ticker import LogLocator, NullFormatter

    decades = np.log10(high / low) if 0 < low < high else 0.0
    if decades < 2:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if decades > 0.7 else range(1, 10)))
    axis.set_major_formatter(lambda x, _: f"{x:.4g}".replace("-", "−"))
    axis.set_minor_formatter(NullFormatter())


def with_unit(name: str, unit: str) -> str:
    """`name [unit]`, or the name alone."""
    return f"{name} [{unit}]" if unit else name
