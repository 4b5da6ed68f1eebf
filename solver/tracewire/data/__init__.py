"""Measured data: series in text files."""

from tracewire.data.read import Columns, read_columns

__all__ = ["Columns", "read_columns"]
