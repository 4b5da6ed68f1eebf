"""Pictures of diagrams as SVG, PNG and Mermaid. No positions are stored: ELK lays them out."""

from tracewire.draw.drawing import ENDINGS, Drawing, draw
from tracewire.draw.needed import Needed
from tracewire.draw.svg import STYLE

__all__ = ["ENDINGS", "STYLE", "Drawing", "Needed", "draw"]
