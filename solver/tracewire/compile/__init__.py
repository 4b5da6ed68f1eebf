"""From a diagram to a model: flat equations, one tape, and functions written from the tape."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
