"""From a model and measured series to fitted parameters."""

from tracewire.fit.criterion import Criterion, Segment, Unknown
from tracewire.fit.descent import Descent, descend
from tracewire.fit.fit import fit
from tracewire.fit.fminsearch import Minimum, fminsearch
from tracewire.fit.measured import Measured, load_measured
from tracewire.fit.optimset import Options, optimset
from tracewire.fit.result import Comparison, Fit
from tracewire.fit.search import Progress

__all__ = [
    "Comparison",
    "Criterion",
    "Descent",
    "Fit",
    "Measured",
    "Minimum",
    "Options",
    "Progress",
    "Segment",
    "Unknown",
    "descend",
    "fit",
    "fminsearch",
    "load_measured",
    "optimset",
]
