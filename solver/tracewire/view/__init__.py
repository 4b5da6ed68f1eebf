"""The live page: a diagram in a browser of this machine, whose curves follow its parameters.

`server` takes requests and lets only those of its own page through; `service` answers them, over
the `Version` of a text that a request names. `page/` has what the browser gets.
"""

from tracewire.view.server import open_server
from tracewire.view.service import Service

__all__ = ["Service", "open_server"]
