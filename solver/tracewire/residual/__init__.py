"""Measured data beside a model: residuals, their derivatives, and the noise they are judged by."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
