"""How traces show themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tracewire.show.presentation import Part, Presentation
from tracewire.show.trace_figures import plot_free_runs
from tracewire.show.trace_law import has_law, plot_law
from tracewire.show.trace_summary import headline_of, paragraph_of
from tracewire.show.trace_tables import trace_tables
from tracewire.show.trace_text import answer_lines, remarks_of, step_lines
from tracewire.trace import Found, data_of


def _parts(found: Found) -> list[Part]:
    return [
        "\n".join(answer_lines(found)),
        f"\n{paragraph_of(found)}\n",
        "\n".join(step_lines(found)),
        *trace_tables(found),
        *(f"note: {text}" for text in remarks_of(found)),
    ]


def _data(found: Found) -> dict[str, Any]:
    return data_of(found) | {"paragraph": paragraph_of(found)}


def _plot(found: Found, path: Path) -> Any:
    """Draw the law that was found; without one, the measured signals with the free runs."""
    return plot_law(found, path) if has_law(found) else plot_free_runs(found, path)


PRESENTATIONS = {
    Found: Presentation(lambda found: headline_of(found), _parts, _data, _plot),
}
