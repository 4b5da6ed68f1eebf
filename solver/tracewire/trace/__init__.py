"""From a diagram and measured series to the effect that the diagram lacks."""

from tracewire.trace.check.option_checks import check_options
from tracewire.trace.found import Found, FoundEffect
from tracewire.trace.options import TraceOptions
from tracewire.trace.saved import load, save
from tracewire.trace.thresholds import (
    CandidateOptions,
    CheckOptions,
    ExperimentOptions,
    MapOptions,
    ScreenOptions,
    SearchOptions,
    SplitOptions,
    TrialOptions,
)
from tracewire.trace.trace import trace

__all__ = [
    "CandidateOptions",
    "CheckOptions",
    "ExperimentOptions",
    "Found",
    "FoundEffect",
    "MapOptions",
    "ScreenOptions",
    "SearchOptions",
    "SplitOptions",
    "TraceOptions",
    "TrialOptions",
    "check_options",
    "load",
    "save",
    "trace",
]
