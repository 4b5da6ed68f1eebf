"""Diagrams with some effects added, fitted to windows, and the numbers by which they are judged."""
