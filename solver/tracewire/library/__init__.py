"""Block declarations: what a block is, and how a folder of block files becomes a library."""

from tracewire.library.check_effects import Face, check_effect
from tracewire.library.declare import Block
from tracewire.library.description import (
    bounds_text,
    describe,
    describe_formulas,
    describe_json,
    describe_origin,
    describe_parts,
    joined_doc,
    palette,
    wiring,
)
from tracewire.library.effect import SCALES, SYMBOLS, Effect, Scale, Shape, Symbol, Tone, Where
from tracewire.library.load import Library, load_library
from tracewire.library.packages import (
    OWN,
    Package,
    find_package,
    folder_of,
    installed_packages,
    package_blocks,
    package_file,
    packages_with,
    subsystem_files,
)
from tracewire.library.parts import Event, Input, Mode, Output, Parameter, State, Transition
from tracewire.library.sensor import SENSOR_TERMS
from tracewire.library.synonyms import find_instead, find_synonym

__all__ = [
    "OWN",
    "SCALES",
    "SENSOR_TERMS",
    "SYMBOLS",
    "Block",
    "Effect",
    "Event",
    "Face",
    "Input",
    "Library",
    "Mode",
    "Output",
    "Package",
    "Parameter",
    "Scale",
    "Shape",
    "State",
    "Symbol",
    "Tone",
    "Transition",
    "Where",
    "bounds_text",
    "check_effect",
    "describe",
    "describe_formulas",
    "describe_json",
    "describe_origin",
    "describe_parts",
    "find_instead",
    "find_package",
    "find_synonym",
    "folder_of",
    "installed_packages",
    "joined_doc",
    "load_library",
    "package_blocks",
    "package_file",
    "packages_with",
    "palette",
    "subsystem_files",
    "wiring",
]
