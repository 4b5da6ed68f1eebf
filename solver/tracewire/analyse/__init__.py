"""What a model does beyond one run: orbits, their stability, charts, exponents, spectra."""

from tracewire.analyse.bifurcation_diagram import Bifurcation, Branch, bifurcation
from tracewire.analyse.chart import StabilityChart, stability_chart
from tracewire.analyse.floquet_multipliers import Floquet, floquet
from tracewire.analyse.growth import GrowthRate, growth_rate
from tracewire.analyse.invariants import Drift, invariant_drift
from tracewire.analyse.linearisation import Linear, linearise
from tracewire.analyse.lyapunov_exponents import Lyapunov, lyapunov
from tracewire.analyse.orbit import PeriodicOrbit, periodic_orbit
from tracewire.analyse.plane import Plane
from tracewire.analyse.poincare_section import PoincareSection, section
from tracewire.analyse.spectra import Line, Spectrum, spectrum
from tracewire.analyse.statements import (
    VERDICTS,
    Judge,
    Judged,
    Verdict,
    counts_of,
    judge,
)
from tracewire.analyse.steady_states import SteadyState, steady_state
from tracewire.analyse.sweeps import Sweep, sweep
from tracewire.analyse.wavelets import Scalogram, scalogram

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
