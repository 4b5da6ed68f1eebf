"""From a model and measured series to fitted parameters."""

from tracewire.fit.diagnostics import Diagnosis, diagnose
from tracewire.fit.fit import fit
from tracewire.fit.fminsearch import Minimum, fminsearch
from tracewire.fit.optimset import Options, optimset
from tracewire.fit.profile import Profile, profile
from tracewire.fit.result import Comparison, Fit
from tracewire.fit.search import Progress
from tracewire.fit.uncertainty import Uncertainty, describe_undetermined

__all__ = [
    "Comparison",
    "Diagnosis",
    "Fit",
    "Minimum",
    "Options",
    "Profile",
    "Progress",
    "Uncertainty",
    "describe_undetermined",
    "diagnose",
    "fit",
    "fminsearch",
    "optimset",
    "profile",
]
