"""Measured data: columns of files, records and the steps that clean them, what is odd in them."""

from tracewire.data.checks import signal_remarks, time_remarks, usual_range
from tracewire.data.frame import read_frame
from tracewire.data.headings import Headings, read_headings
from tracewire.data.read import Columns, column_unit, read_columns, read_record, record_of
from tracewire.data.record import Record
from tracewire.data.steps import STEPS, Option

__all__ = [
    "STEPS",
    "Columns",
    "Headings",
    "Option",
    "Record",
    "column_unit",
    "read_columns",
    "read_frame",
    "read_headings",
    "read_record",
    "record_of",
    "signal_remarks",
    "time_remarks",
    "usual_range",
]
