"""What a model does beyond one run: orbits, their stability, charts, exponents, spectra."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
