"""Diagrams: from a YAML file to a checked description, and edits of its text."""

from tracewire.diagram.builder import DiagramBuilder, Signal, SubsystemBuilder
from tracewire.diagram.changes import (
    AddBlock,
    AddOwn,
    AddSensorTerm,
    Change,
    PointsFile,
    SetValues,
    apply,
    patch,
)
from tracewire.diagram.completion import Proposal, complete, word_before
from tracewire.diagram.diagram import (
    Array,
    BlockUse,
    Channel,
    Cleaning,
    Clock,
    Condition,
    Crosses,
    Diagram,
    Event,
    Format,
    Hold,
    InputPort,
    Points,
    ScenePart,
    Series,
    Setting,
    Shown,
    Statement,
    Use,
    Value,
    Wire,
)
from tracewire.diagram.edit import (
    difference,
    with_addend,
)
from tracewire.diagram.edit_series import (
    path_text,
    replace_series,
    series_parts,
    with_series_of,
)
from tracewire.diagram.edit_values import written_units
from tracewire.diagram.effects import EffectType, effects_of
from tracewire.diagram.files import STDIN, absent_series, load_stdin
from tracewire.diagram.files import load as load_text
from tracewire.diagram.layout import lay_out
from tracewire.diagram.limits import LIMITS
from tracewire.diagram.loops import cycle_text, cycles
from tracewire.diagram.modeline import is_modeline, with_modeline
from tracewire.diagram.names import (
    element_name,
    find_parameter,
    find_recorded,
    find_signal,
    find_state,
    is_count,
    row_ends,
    signals,
    split_index,
    state_names,
    states,
)
from tracewire.diagram.packages import package_subsystems, who_has
from tracewire.diagram.quantity_names import EVENT_KINDS, is_quantity, quantity_problems
from tracewire.diagram.reader import read, read_readable, read_readable_text, read_text
from tracewire.diagram.rename import renamed
from tracewire.diagram.rewire import rewired
from tracewire.diagram.schema import schema_of, schema_text
from tracewire.diagram.writer import write, write_out
from tracewire.diagram.yaml_text import mapping_text, quote

__all__ = [
    "EVENT_KINDS",
    "LIMITS",
    "STDIN",
    "AddBlock",
    "AddOwn",
    "AddSensorTerm",
    "Array",
    "BlockUse",
    "Change",
    "Channel",
    "Cleaning",
    "Clock",
    "Condition",
    "Crosses",
    "Diagram",
    "DiagramBuilder",
    "EffectType",
    "Event",
    "Format",
    "Hold",
    "InputPort",
    "Points",
    "PointsFile",
    "Proposal",
    "ScenePart",
    "Series",
    "SetValues",
    "Setting",
    "Shown",
    "Signal",
    "Statement",
    "SubsystemBuilder",
    "Use",
    "Value",
    "Wire",
    "absent_series",
    "apply",
    "complete",
    "cycle_text",
    "cycles",
    "difference",
    "effects_of",
    "element_name",
    "find_parameter",
    "find_recorded",
    "find_signal",
    "find_state",
    "is_count",
    "is_modeline",
    "is_quantity",
    "lay_out",
    "load_stdin",
    "load_text",
    "mapping_text",
    "package_subsystems",
    "patch",
    "path_text",
    "quantity_problems",
    "quote",
    "read",
    "read_readable",
    "read_readable_text",
    "read_text",
    "renamed",
    "replace_series",
    "rewired",
    "row_ends",
    "schema_of",
    "schema_text",
    "series_parts",
    "signals",
    "split_index",
    "state_names",
    "states",
    "who_has",
    "with_addend",
    "with_modeline",
    "with_series_of",
    "word_before",
    "write",
    "write_out",
    "written_units",
]
