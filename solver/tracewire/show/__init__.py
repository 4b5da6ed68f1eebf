"""What a person looks at: tables, figures and reports; matplotlib is imported when drawn.

The names here are imported from their files when they are first used: a run needs no figures.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracewire.show.animation import animate, frame_times
    from tracewire.show.any_report import report
    from tracewire.show.bifurcation_figures import plot_bifurcation, plot_section
    from tracewire.show.comparison_figures import plot_comparisons
    from tracewire.show.diagnostic_figures import plot_diagnostics, plot_profiles
    from tracewire.show.diagram_picture import draw_trace
    from tracewire.show.document import Report, report_script, report_style
    from tracewire.show.event_rows import jump_times
    from tracewire.show.figures import group_signals, plot_run
    from tracewire.show.fit_tables import fit_text, fit_words
    from tracewire.show.library_page import library_report
    from tracewire.show.live import optimplotfit, optimplotfval, optimplotx
    from tracewire.show.parameter_figures import plot_convergence, plot_correlation, plot_parameters
    from tracewire.show.plane_figures import plot_orbit, plot_polar, plot_portrait
    from tracewire.show.presentation import Presentation, Presented, present
    from tracewire.show.scene import Moved, extent_of, moved_parts
    from tracewire.show.several_runs import plot_runs
    from tracewire.show.signal_figures import (
        plot_growth,
        plot_invariants,
        plot_lyapunov,
        plot_scalogram,
        plot_spectrum,
    )
    from tracewire.show.statements import (
        expected_text,
        measured_text,
        statement_data,
        statements_table,
    )
    from tracewire.show.sticking import held_intervals
    from tracewire.show.sweep_figures import plot_chart, plot_sweep
    from tracewire.show.table import Table, shown
    from tracewire.show.trace_summary import paragraph_of, sentences_of
    from tracewire.show.trace_words import value_words
    from tracewire.show.uplot import library_script, library_style

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

FILE_OF = {
    "animation": "animate frame_times",
    "bifurcation_figures": "plot_bifurcation plot_section",
    "comparison_figures": "plot_comparisons",
    "diagram_picture": "draw_trace",
    "diagnostic_figures": "plot_diagnostics plot_profiles",
    "document": "Report report_script report_style",
    "event_rows": "jump_times",
    "figures": "group_signals plot_run",
    "fit_tables": "fit_text fit_words",
    "library_page": "library_report",
    "live": "optimplotfit optimplotfval optimplotx",
    "parameter_figures": "plot_convergence plot_correlation plot_parameters",
    "plane_figures": "plot_orbit plot_polar plot_portrait",
    "any_report": "report",
    "scene": "Moved extent_of moved_parts",
    "several_runs": "plot_runs",
    "signal_figures": "plot_growth plot_invariants plot_lyapunov plot_scalogram plot_spectrum",
    "statements": "expected_text measured_text statement_data statements_table",
    "sticking": "held_intervals",
    "presentation": "Presentation Presented present",
    "table": "Table shown",
    "sweep_figures": "plot_chart plot_sweep",
    "trace_summary": "paragraph_of sentences_of",
    "trace_words": "value_words",
    "uplot": "library_script library_style",
}


def __getattr__(name: str) -> object:
    for file, names in FILE_OF.items():
        if name in names.split():
            return getattr(import_module(f"tracewire.show.{file}"), name)
    raise AttributeError(f"module 'tracewire.show' has no attribute '{name}'")


def __dir__() -> list[str]:
    return __all__
