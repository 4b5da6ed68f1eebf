from .animation import animate, frame_times
from .any_report import report
from .bifurcation_figures import plot_bifurcation, plot_section
from .comparison_figures import plot_comparisons
from .diagnostic_figures import plot_diagnostics, plot_profiles
from .diagram_picture import draw_trace
from .document import Report, report_script, report_style
from .event_rows import jump_times
from .figures import group_signals, plot_run
from .fit_tables import fit_text, fit_words
from .library_page import library_report
from .live import optimplotfit, optimplotfval, optimplotx
from .parameter_figures import plot_convergence, plot_correlation, plot_parameters
from .plane_figures import plot_orbit, plot_polar, plot_portrait
from .presentation import Presentation, Presented, present
from .scene import Moved, extent_of, moved_parts
from .several_runs import plot_runs
from .signal_figures import (
    plot_growth,
    plot_invariants,
    plot_lyapunov,
    plot_scalogram,
    plot_spectrum,
)
from .statements import expected_text, measured_text, statement_data, statements_table
from .sticking import held_intervals
from .sweep_figures import plot_chart, plot_sweep
from .table import Table, shown
from .trace_summary import paragraph_of, sentences_of
from .trace_words import value_words
from .uplot import library_script, library_style

__all__ = [
    "Moved",
    "Presentation",
    "Presented",
    "Report",
    "Table",
    "animate",
    "draw_trace",
    "expected_text",
    "extent_of",
    "fit_text",
    "fit_words",
    "frame_times",
    "group_signals",
    "held_intervals",
    "jump_times",
    "library_report",
    "library_script",
    "library_style",
    "measured_text",
    "moved_parts",
    "optimplotfit",
    "optimplotfval",
    "optimplotx",
    "paragraph_of",
    "plot_bifurcation",
    "plot_chart",
    "plot_comparisons",
    "plot_convergence",
    "plot_correlation",
    "plot_diagnostics",
    "plot_growth",
    "plot_invariants",
    "plot_lyapunov",
    "plot_orbit",
    "plot_parameters",
    "plot_polar",
    "plot_portrait",
    "plot_profiles",
    "plot_run",
    "plot_runs",
    "plot_scalogram",
    "plot_section",
    "plot_spectrum",
    "plot_sweep",
    "present",
    "report",
    "report_script",
    "report_style",
    "sentences_of",
    "shown",
    "statement_data",
    "statements_table",
    "value_words",
]
