from .criterion import LIMITS, Criterion, half_square
from .files import series_from_files
from .growing_parts import follow_growing_parts, is_out_of_step
from .initial_states import fit_initial_states, restart_from_others
from .input_noise import (
    InputCovariance,
    LikelyNoise,
    likely_input_noise,
    response_in_windows,
    run_noise,
)
from .input_response import InputNoise
from .inputs import looks_held
from .levenberg_marquardt import bounded_step, fit_windows
from .limits import DESCENT, WINDOW
from .linearisation import Linearisation, Projection, wrap_to_period
from .load import load_measured, measured_series, series_parameters
from .loss import LOSSES
from .measured import Measured, with_measured_signals
from .noise import degrees_of, noise_in, noise_of, noises_beside
from .noise_estimate import NoiseEstimate, noise_level, noise_of_signal
from .noise_of_channels import channel_noise, estimate_noise
from .past import longest_delay, with_past
from .remarks import begins_elsewhere, sigma_problem
from .segment import (
    OWN,
    Segment,
    Unknown,
    absolute_tolerances,
    is_of_sensor,
    of_diagram,
    parameter_in,
)
from .sensor import Sensor
from .starts import start_from_data, whole_segment
from .trust_region import solve_least_squares
from .unknowns import (
    chosen_unknowns,
    free_names,
    free_unknowns,
    own_unknowns,
    refuse_readers_of_free,
    sensor_unknowns,
)
from .windows import (
    Section,
    Windows,
    cut_windows,
    edges_within,
    evaluate_windows,
    project_out_initial_states,
    with_lead_in,
    with_memory,
)

__all__ = [
    "DESCENT",
    "LIMITS",
    "LOSSES",
    "OWN",
    "WINDOW",
    "Criterion",
    "InputCovariance",
    "InputNoise",
    "LikelyNoise",
    "Linearisation",
    "Measured",
    "NoiseEstimate",
    "Projection",
    "Section",
    "Segment",
    "Sensor",
    "Unknown",
    "Windows",
    "absolute_tolerances",
    "begins_elsewhere",
    "bounded_step",
    "channel_noise",
    "chosen_unknowns",
    "cut_windows",
    "degrees_of",
    "edges_within",
    "estimate_noise",
    "evaluate_windows",
    "fit_initial_states",
    "fit_windows",
    "follow_growing_parts",
    "free_names",
    "free_unknowns",
    "half_square",
    "is_of_sensor",
    "is_out_of_step",
    "likely_input_noise",
    "load_measured",
    "longest_delay",
    "looks_held",
    "measured_series",
    "noise_in",
    "noise_level",
    "noise_of",
    "noise_of_signal",
    "noises_beside",
    "of_diagram",
    "own_unknowns",
    "parameter_in",
    "project_out_initial_states",
    "refuse_readers_of_free",
    "response_in_windows",
    "restart_from_others",
    "run_noise",
    "sensor_unknowns",
    "series_from_files",
    "series_parameters",
    "sigma_problem",
    "solve_least_squares",
    "start_from_data",
    "whole_segment",
    "with_lead_in",
    "with_measured_signals",
    "with_memory",
    "with_past",
    "wrap_to_period",
]
