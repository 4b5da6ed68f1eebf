"""Quantities: what is told of a run, or of a motion, in a number, by its formula."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
