"""The thresholds of figures, reports and words: how much is shown, and what is worth a word.

The numbers are judgements: what can be read on a page, and what a file may weigh.
"""

from __future__ import annotations

from typing import Final


class FigureLimits:
    """Of all figures, and of those of runs. Sizes are in inches."""

    width: Final[float] = 9.0
    """Of a figure."""
    plane_side: Final[float] = 5.6
    """Of a figure of two states, which is square."""
    piece: Final[int] = 10_000
    """Points of a curve: a piece of one that is too long to be drawn as a whole."""
    many_points: Final[int] = 5000
    """A vector picture holds more points than this as pixels: its file would be slow to open."""
    gap: Final[float] = 20.0
    """Usual steps of the time between two samples that no line joins."""
    most_lines: Final[int] = 4
    """Signals in a panel."""
    most_panels: Final[int] = 16
    """Of a run."""
    most_strikes: Final[int] = 60
    """More lines than these through a panel would hide what they mark."""
    scale_apart: Final[float] = 20.0
    """Signals whose ranges differ by more than this would hide each other in one panel."""
    event_rows: Final[int] = 8
    """Blocks that have a row of events of their own."""
    apart: Final[int] = 700
    """Marks nearer to each other than this part of the span cannot be told apart: they are a bar,
    from the first mark to the last one, which are drawn, as a bar can be thinner than a pixel."""
    dense: Final[float] = 0.45
    """The opacity of such a bar, which would be the loudest part of the figure."""
    branch_panels: Final[int] = 8
    """Of a bifurcation diagram: states times branches."""
    most_bands: Final[int] = 3
    """Bands of irregular motion that are named, the widest."""
    floor: Final[float] = 1e-5
    """Of the largest amplitude of a spectrum: what a logarithmic axis shows."""
    most_labels: Final[int] = 6
    """Lines of a spectrum that are named."""
    scalogram_pixels: Final[int] = 4000
    """Along the time."""
    zoom_points: Final[int] = 4000
    """A curve of more is thinned to the least and the greatest value of each short stretch."""
    zoom_bytes: Final[int] = 4_000_000
    """Of the curves of one figure; a larger one stays a picture."""
    vector_bytes: Final[int] = 400_000
    """Up to which a figure is SVG; one of very many samples is smaller as PNG."""


FIGURE = FigureLimits()


class FitFigureLimits:
    """Of the figures of a fit."""

    most_comparisons: Final[int] = 12
    """Signals that are drawn beside the data."""
    far: Final[float] = 4.0
    """A model before the fit that is this many times as far away is left out of the axis' limits,
    and the residual after the fit has a strip of its own."""
    resolved: Final[float] = 1e-9
    """What changes by less than this part of its size is drawn as constant."""
    most_residuals: Final[int] = 12
    """Signals whose residuals are drawn."""
    residual_points: Final[int] = 4000
    """Of a residual: a vector picture holds more as pixels."""
    histogram: Final[float] = 4.5
    """It reaches this many root mean squares to each side."""
    most_profiles: Final[int] = 24
    """Likelihoods that are drawn."""
    most_parameters: Final[int] = 40
    """Rows of parameters, and of their correlation."""
    most_paths: Final[int] = 24
    """Parameters whose way through the search is drawn."""
    most_numbers: Final[int] = 16
    """Correlations of more parameters than this are colours without numbers."""
    strong: Final[float] = 0.995
    """A correlation from which on more digits are written: 1.00 would say that it is a tie."""
    correlated: Final[float] = 0.95
    """Two values whose errors are correlated more than this are told in a sentence ..."""
    most_pairs: Final[int] = 6
    """... and so many pairs of them by name."""


FIT = FitFigureLimits()


class LiveLimits:
    """Of the picture of a search that goes on. Times are wall time in s."""

    share: Final[float] = 0.1
    """The part of a search's time that all its pictures together may take."""
    first_cost: Final[float] = 0.15
    """What a picture is supposed to cost before one has been drawn."""
    soonest: Final[float] = 0.1
    """Between two frames, at least."""
    thinning: Final[float] = 0.02
    """The next frame waits for this part of the time so far: frames thin out in a long search."""
    most_frames: Final[int] = 500
    """That are drawn."""
    most_signals: Final[int] = 4
    """That are drawn, of the series to be fitted first."""


LIVE = LiveLimits()


class SceneLimits:
    """Of scenes and their films."""

    most_frames: Final[int] = 5000
    """Of a film."""
    widths: Final[tuple[int, int]] = (100, 2000)
    """Of a film, in pixels."""
    dots: Final[float] = 100.0
    """Pixels per inch: a text of 10 points is 14 pixels high."""
    tick: Final[float] = 0.01
    """Seconds: the pause between two pictures of a GIF is a multiple of it."""
    head: Final[float] = 0.45
    """Inches above the scene, for the title and the time."""
    least_height: Final[float] = 0.3
    """Of the scene, over its width."""
    most_height: Final[float] = 1.5
    """The same at most."""
    shades: Final[int] = 16
    """Of each colour in a GIF: the edge of a shape is mixed with the white around it."""
    letter: Final[float] = 6.3
    """Pixels that a letter of the title is wide."""
    spring: Final[float] = 0.05
    """The usual width of a spring as a part of the extent of the scene."""
    most_coils: Final[int] = 100
    """Of a spring."""
    largest: Final[float] = 1e100
    """In m: a scene beyond cannot be put into pixels."""
    hatches: Final[int] = 24
    """Strokes under a piece of ground."""


SCENE = SceneLimits()


class TraceFigureLimits:
    """Of the figures of a trace."""

    most_curves: Final[int] = 8
    """Signals whose residual is drawn."""
    most_candidates: Final[int] = 10
    """Of a step that are drawn, the best."""
    unlike: Final[float] = 8.0
    """Where the largest residuals differ by more than this, that after has a panel of its own
    below."""
    least_error: Final[float] = 0.1
    """In units of the noise: errors of less, as of a body at rest, are drawn here."""
    named_series: Final[int] = 12
    """So many series have their names over the blocks."""
    most_forces: Final[int] = 3
    """Places whose law is drawn."""
    most_dots: Final[int] = 4000
    """Samples of a law that are drawn."""
    bins: Final[int] = 24
    """Of the means of a law ..."""
    least_in_bin: Final[int] = 8
    """... with so many samples in each."""
    fine: Final[int] = 60
    """Bins in which it is asked whether the law is a function of one variable."""
    tight: Final[float] = 0.04
    """A law is drawn as a line where it varies by less than this part of its range ..."""
    mostly: Final[float] = 0.9
    """... in this part of the bins."""
    spikes: Final[float] = 0.05
    """Of the samples at each end that are cut to the quantile there, before means are taken."""
    noisy: Final[float] = 0.5
    """Samples that scatter by more than this part of the axis are noise, and are not drawn."""
    far: Final[float] = 3.0
    """Means with an error of more than this many median errors set no limits."""
    title_width: Final[int] = 90
    """Letters of a title that is as wide as a figure."""
    law_points: Final[int] = 80
    """Of a line in a plot of the diagram, which is 100 px wide."""
    among: Final[tuple[float, ...]] = (0.1, 0.5, 0.9)
    """Quantiles of a second variable at which a law is drawn there."""


TRACE = TraceFigureLimits()


class MapLimits:
    """Of the maps of a trace: what stands in for what, and what an experiment would tell."""

    dark: Final[float] = 0.6
    """Of the darkest colour: from here on numbers are white."""
    most_nines: Final[float] = 3.0
    """The darkest likeness: 0.999."""
    tied: Final[float] = 0.985
    """Likenesses above it are outlined."""
    most_alike: Final[int] = 16
    """Effects in such a map."""
    most_experiments: Final[int] = 3
    """That are drawn."""
    alike_everywhere: Final[float] = 0.1
    """Where the best experiment separates two effects by less sigma than this, its map is empty."""
    short: Final[int] = 9
    """Letters of a label that stands level below its column; longer ones are slanted."""
    most_ticks: Final[int] = 5
    """Steps of the axis of a map; numbers with many digits do not touch then."""
    few: Final[float] = 0.05
    """Where the density of samples is less than this part of its largest, a map is pale."""
    crowded: Final[float] = 10.0
    """A body that rests piles samples up: no density counts as more than this many times the
    median."""


MAP = MapLimits()


class WordLimits:
    """Of sentences and tables: how much they tell, and what is worth a word."""

    nothing: Final[float] = 1e-6
    """An error of less than this part of the noise is 0."""
    astray: Final[float] = 30.0
    """A free run that is off by so many times the error in windows tells little."""
    runaway: Final[float] = 1e9
    """What grows this many times within a run has most likely a force with the wrong sign."""
    most_names: Final[int] = 4
    """In a heading, before it says that there are more."""
    most_rows: Final[int] = 100
    """Runs in a table."""
    most_events: Final[int] = 40
    """Rows of the log of events in a report."""
    most_told: Final[int] = 3
    """Things of a kind that a sentence names."""
    most_channels: Final[int] = 4
    """Lines of a kind in the text of a trace."""
    most_powers: Final[int] = 12
    """Rows of what would have been seen; a report has all."""
    most_where: Final[int] = 8
    """Rows of where the residual depends on what; a report has all."""
    report_rows: Final[int] = 10_000
    """Rows of these in a report."""
    tiny: Final[float] = 1e-12
    """Probabilities of less are written as less."""
    nearly_all: Final[float] = 0.995
    """From here on a share would round to 100 %, which it is not."""
    worth_telling: Final[float] = 0.01
    """A parameter that moved by less than this part of itself is not worth a word."""
    most_digits: Final[int] = 10
    """Of a number."""
    plain: Final[tuple[float, float]] = (1e-4, 1e6)
    """Numbers between these are written without an exponent."""
    grown: Final[float] = 2.0
    """How many times larger a declared parameter is with an effect, to be asked for."""
    alike: Final[float] = 0.02
    """Of the excess: variables whose shares differ by less explain as much."""
    alike_places: Final[float] = 0.1
    """Of the excess: places whose shares differ by less may each lack the effect ..."""
    left_elsewhere: Final[float] = 2.0
    """... if they leave no more than so many times as much. On step responses of strangers a sensor
    led with 96 % and 69 %, where the sum of a heater and of a motor had 96 % and 60 %."""
    little: Final[float] = 0.5
    """The share of the excess below which the variables found explain little of it."""
    out_of_reach: Final[float] = 0.3
    """The part of the declared model's rms error that no smooth force takes away, from which on the
    excess needs a word about how much of the error it is."""
    far: Final[float] = 2.0
    """Times the noise from which on a null needs a word about what the noise is not."""
    left: Final[float] = 1.2
    """Times the noise from which on a run shows that something is missing still."""
    least_separation: Final[float] = 0.1
    """In sigma; one of less needs no number."""


WORD = WordLimits()
