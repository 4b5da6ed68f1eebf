"""From a model and measured series to fitted parameters."""

from tracewire.fit.criterion import Criterion
from tracewire.fit.descent import Descent, descend
from tracewire.fit.diagnostics import Diagnosis, diagnose
from tracewire.fit.files import series_from_files
from tracewire.fit.fit import fit
from tracewire.fit.fminsearch import Minimum, fminsearch
from tracewire.fit.measured import Measured, load_measured
from tracewire.fit.noise_estimate import NoiseEstimate, estimate_noise
from tracewire.fit.optimset import Options, optimset
from tracewire.fit.profile import Profile, profile
from tracewire.fit.result import Comparison, Fit
from tracewire.fit.search import Progress
from tracewire.fit.segment import Segment, Unknown
from tracewire.fit.sensor import Sensor
from tracewire.fit.uncertainty import Uncertainty

__all__ = [
    "Comparison",
    "Criterion",
    "Descent",
    "Diagnosis",
    "Fit",
    "Measured",
    "Minimum",
    "NoiseEstimate",
    "Options",
    "Profile",
    "Progress",
    "Segment",
    "Sensor",
    "Uncertainty",
    "Unknown",
    "descend",
    "diagnose",
    "estimate_noise",
    "fit",
    "fminsearch",
    "load_measured",
    "optimset",
    "profile",
    "series_from_files",
]
