from .bifurcation_diagram import Bifurcation, Branch, bifurcation
from .chart import StabilityChart, stability_chart
from .floquet_multipliers import Floquet, floquet
from .growth import GrowthRate, growth_rate
from .invariants import Drift, invariant_drift
from .linearisation import Linear, linearise
from .lyapunov_exponents import Lyapunov, lyapunov
from .orbit import PeriodicOrbit, periodic_orbit
from .plane import Plane
from .poincare_section import PoincareSection, section
from .spectra import Line, Spectrum, spectrum
from .statements import VERDICTS, Judge, Judged, Verdict, counts_of, judge
from .steady_states import SteadyState, steady_state
from .sweeps import Sweep, sweep
from .wavelets import Scalogram, scalogram

__all__ = [
    "VERDICTS",
    "Bifurcation",
    "Branch",
    "Drift",
    "Floquet",
    "GrowthRate",
    "Judge",
    "Judged",
    "Line",
    "Linear",
    "Lyapunov",
    "PeriodicOrbit",
    "Plane",
    "PoincareSection",
    "Scalogram",
    "Spectrum",
    "StabilityChart",
    "SteadyState",
    "Sweep",
    "Verdict",
    "bifurcation",
    "counts_of",
    "floquet",
    "growth_rate",
    "invariant_drift",
    "judge",
    "linearise",
    "lyapunov",
    "periodic_orbit",
    "scalogram",
    "section",
    "spectrum",
    "stability_chart",
    "steady_state",
    "sweep",
]
