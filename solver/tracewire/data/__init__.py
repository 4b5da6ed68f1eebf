"""Measured data: columns of files, records and the steps that clean them, what is odd in them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
