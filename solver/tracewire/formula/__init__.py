"""The formula language: a small, checked subset of Python expressions.

A formula is arithmetic (`+ - * / **`), comparisons (`< <= > >=`), `and / or / not`, the choice
`a if c else b`, and the functions of `FUNCTIONS`. Nothing else parses, and text, depth and size are
bounded, so a formula from a stranger can do nothing but arithmetic. It is never given to `eval`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
