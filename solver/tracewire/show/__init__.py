"""What a person looks at: tables, figures and reports; matplotlib is imported when drawn.

The names here are imported from their files when they are first used: a run needs no figures.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
