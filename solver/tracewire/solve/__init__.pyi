from .held import Driving, Held, values_at, with_points
from .history import refuse_delays
from .integrator import Integrator
from .interrupt import Interrupted, StopFlag, until_interrupted
from .limits import Limits, beyond_budget
from .many import simulate_many
from .observers import Section, guard_crossings
from .options import START, Options, refuse_unknown_options, with_options, with_row
from .parallel import WorkerEnded, carry_out, cores
from .parameters import parameter_bounds, parameter_values
from .passage import Passage
from .problem import InitialValueProblem, initial_value_problem
from .progress import PartProgress, ProgressCallback
from .run import Event, Run, Sensitivities, Statistics
from .runs import Runs
from .sampling import DEFAULT_SAMPLES, even_times, sample_times
from .simulation import simulate
from .spans import Span, SpanProblem, SpanRuns, simulate_spans, span_problem
from .workspace import release

__all__ = [
    "DEFAULT_SAMPLES",
    "START",
    "Driving",
    "Event",
    "Held",
    "InitialValueProblem",
    "Integrator",
    "Interrupted",
    "Limits",
    "Options",
    "PartProgress",
    "Passage",
    "ProgressCallback",
    "Run",
    "Runs",
    "Section",
    "Sensitivities",
    "Span",
    "SpanProblem",
    "SpanRuns",
    "Statistics",
    "StopFlag",
    "WorkerEnded",
    "beyond_budget",
    "carry_out",
    "cores",
    "even_times",
    "guard_crossings",
    "initial_value_problem",
    "parameter_bounds",
    "parameter_values",
    "refuse_delays",
    "refuse_unknown_options",
    "release",
    "sample_times",
    "simulate",
    "simulate_many",
    "simulate_spans",
    "span_problem",
    "until_interrupted",
    "values_at",
    "with_options",
    "with_points",
    "with_row",
]
