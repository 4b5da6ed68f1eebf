"""Measured data beside a model: residuals, their derivatives, and the noise they are judged by."""

from tracewire.residual.criterion import LIMITS, Criterion, half_square
from tracewire.residual.descent import descend
from tracewire.residual.files import series_from_files
from tracewire.residual.input_noise import (
    InputCovariance,
    likely_input_noise,
    response_in_windows,
    run_noise,
)
from tracewire.residual.input_response import InputNoise
from tracewire.residual.levenberg_marquardt import CREEPS, LEAST_DAMPING, bounded_step, descended
from tracewire.residual.linearised import Linearised, Projection, around
from tracewire.residual.loss import LOSSES
from tracewire.residual.measured import (
    Measured,
    load_measured,
    measured_series,
    series_parameters,
    with_measured_signals,
)
from tracewire.residual.noise import degrees_of, noise_in, noise_of, noises_beside
from tracewire.residual.noise_estimate import (
    NoiseEstimate,
    channel_noise,
    estimate_noise,
    noise_level,
)
from tracewire.residual.past import longest_delay, with_past
from tracewire.residual.segment import (
    OWN,
    SENSED,
    Segment,
    Unknown,
    absolute_tolerances,
    of_diagram,
    parameter_in,
)
from tracewire.residual.sensor import Sensor
from tracewire.residual.settling import SETTLING, settled
from tracewire.residual.starts import start_from_data, whole_segment
from tracewire.residual.unknowns import (
    chosen_unknowns,
    free_names,
    free_unknowns,
    own_unknowns,
    refuse_readers_of_free,
    sensor_unknowns,
)
from tracewire.residual.windows import (
    Section,
    Windows,
    begun_before,
    cut,
    eliminated,
    opened,
)

__all__ = [
    "CREEPS",
    "LEAST_DAMPING",
    "LIMITS",
    "LOSSES",
    "OWN",
    "SENSED",
    "SETTLING",
    "Criterion",
    "InputCovariance",
    "InputNoise",
    "Linearised",
    "Measured",
    "NoiseEstimate",
    "Projection",
    "Section",
    "Segment",
    "Sensor",
    "Unknown",
    "Windows",
    "absolute_tolerances",
    "around",
    "begun_before",
    "bounded_step",
    "channel_noise",
    "chosen_unknowns",
    "cut",
    "degrees_of",
    "descend",
    "descended",
    "eliminated",
    "estimate_noise",
    "free_names",
    "free_unknowns",
    "half_square",
    "likely_input_noise",
    "load_measured",
    "longest_delay",
    "measured_series",
    "noise_in",
    "noise_level",
    "noise_of",
    "noises_beside",
    "of_diagram",
    "opened",
    "own_unknowns",
    "parameter_in",
    "refuse_readers_of_free",
    "response_in_windows",
    "run_noise",
    "sensor_unknowns",
    "series_from_files",
    "series_parameters",
    "settled",
    "start_from_data",
    "whole_segment",
    "with_measured_signals",
    "with_past",
]
