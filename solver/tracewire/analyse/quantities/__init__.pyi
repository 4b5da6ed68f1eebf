from .conditions import Conditions, conditions_of
from .evaluate import NOTHING_FURTHER, Further, is_of_run
from .measurement import ask, measure
from .subject import Recorder, Subject, silent

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
