"""Writes the page of names to stdout: `python -m tracewire.library > blocks/README.md`."""

from __future__ import annotations

import sys

from tracewire.library.load import load_library
from tracewire.library.names_page import names_page

sys.stdout.write(names_page(load_library()))
