"""Block declarations: what a block is, and how a folder of block files becomes a library."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
