"""The papers whose systems are shipped: figures, the page of their systems, reports."""

from tracewire.paper.figure import PAPERS, PaperFigure
from tracewire.paper.figures import figure_of, figures_of
from tracewire.paper.identification import with_identification

__all__ = ["PAPERS", "PaperFigure", "figure_of", "figures_of", "with_identification"]
