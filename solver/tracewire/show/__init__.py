"""What a person looks at: tables, figures and reports; matplotlib is imported when drawn."""

from tracewire.show.comparison_figures import plot_comparisons
from tracewire.show.diagnostic_figures import plot_diagnostics, plot_profiles
from tracewire.show.document import Report
from tracewire.show.figures import plot_run
from tracewire.show.fit_figures import plot_fit, plot_residual
from tracewire.show.live import optimplotfit, optimplotfval, optimplotx
from tracewire.show.parameter_figures import plot_convergence, plot_correlation, plot_parameters
from tracewire.show.report import report

__all__ = [
    "Report",
    "optimplotfit",
    "optimplotfval",
    "optimplotx",
    "plot_comparisons",
    "plot_convergence",
    "plot_correlation",
    "plot_diagnostics",
    "plot_fit",
    "plot_parameters",
    "plot_profiles",
    "plot_residual",
    "plot_run",
    "report",
]
