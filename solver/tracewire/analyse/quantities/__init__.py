"""Quantities: what is told of a run, or of a motion, in a number, by its formula."""

from tracewire.analyse.quantities.conditions import Conditions, conditions_of
from tracewire.analyse.quantities.evaluate import NOTHING_FURTHER, Further, is_of_run
from tracewire.analyse.quantities.measurement import ask, measure
from tracewire.analyse.quantities.subject import Recorder, Subject, silent

__all__ = [
    "NOTHING_FURTHER",
    "Conditions",
    "Further",
    "Recorder",
    "Subject",
    "ask",
    "conditions_of",
    "is_of_run",
    "measure",
    "silent",
]
