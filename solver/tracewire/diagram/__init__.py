"""Diagrams: from a YAML file to a checked description, and edits of its text."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
