"""Pictures of diagrams as SVG, PNG and Mermaid. No positions are stored: ELK lays them out."""

from tracewire.draw.drawing import ENDINGS, Drawing, draw

__all__ = ["ENDINGS", "Drawing", "draw"]
