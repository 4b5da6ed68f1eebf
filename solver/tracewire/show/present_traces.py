"""How traces show themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tracewire.show.diagram_picture import caption_of, draw_trace
from tracewire.show.notebook import pictures_by, svg_image
from tracewire.show.presentation import Part, Presentation
from tracewire.show.trace_figures import plot_free_runs, plot_residuals
from tracewire.show.trace_law import has_law, plot_law
from tracewire.show.trace_summary import headline_of, paragraph_of
from tracewire.show.trace_tables import trace_tables
from tracewire.show.trace_text import answer_lines, remarks_of, step_lines
from tracewire.trace import Found, data_of


def _parts(found: Found) -> list[Part]:
    return [
        "\n".join(answer_lines(found)) + "\n",
        "\n".join(step_lines(found)) + "\n",
        *trace_tables(found),
        *(f"note: {text}" for text in remarks_of(found)),
    ]


def _data(found: Found) -> dict[str, Any]:
    return data_of(found) | {"paragraph": paragraph_of(found)}


def _plot(found: Found, path: Path) -> Any:
    """Draw the law that was found; without one, the measured signals with the free runs."""
    return plot_law(found, path) if has_law(found) else plot_free_runs(found, path)


def _pictures(found: Found) -> str:
    """The diagram with what the trace says of it, and the law, or what is left of the residual."""
    figures = pictures_by(plot_law if has_law(found) else plot_residuals)(found)
    return f"{svg_image(draw_trace(found).svg, caption_of(found))}\n{figures}".strip()


PRESENTATIONS = {
    Found: Presentation(lambda found: headline_of(found), _parts, _data, _plot, _pictures),
}
