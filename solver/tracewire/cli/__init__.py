"""The command line: each verb is one small file, and `app` lists them."""

from tracewire.cli.app import main

__all__ = ["main"]
