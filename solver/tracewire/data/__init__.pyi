from .checks import input_remarks, signal_remarks, time_remarks, usual_range
from .frame import read_frame
from .headings import Headings, read_headings
from .read import Columns, column_unit, read_columns, read_curve, read_record, record_of
from .record import Record
from .steps import STEPS, Option

__all__ = [
    "STEPS",
    "Columns",
    "Headings",
    "Option",
    "Record",
    "column_unit",
    "input_remarks",
    "read_columns",
    "read_curve",
    "read_frame",
    "read_headings",
    "read_record",
    "record_of",
    "signal_remarks",
    "time_remarks",
    "usual_range",
]
