"""`python -m tracewire` is the command `tracewire`."""

from __future__ import annotations

import sys

from tracewire.cli import main

if __name__ == "__main__":
    sys.exit(main())
