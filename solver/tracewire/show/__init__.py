"""What a person looks at: tables, figures and reports; matplotlib is imported when drawn."""

from tracewire.show.document import Report
from tracewire.show.figures import plot_run
from tracewire.show.fit_figures import plot_fit, plot_residual
from tracewire.show.report import report

__all__ = ["Report", "plot_fit", "plot_residual", "plot_run", "report"]
