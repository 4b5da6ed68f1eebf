from .check_effects import Face, check_effect
from .declare import Block
from .description import (
    bounds_text,
    describe,
    describe_formulas,
    describe_json,
    describe_origin,
    describe_parts,
    effect_rows,
    effect_table,
    joined_doc,
    palette,
    wiring,
)
from .effect import SCALES, SYMBOLS, Effect, Scale, Shape, Symbol, Tone, Where
from .load import Library, load_library
from .packages import (
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
from .parts import Event, Input, Mode, Output, Parameter, State, Transition
from .sensor import SENSOR_TERMS
from .sensor_description import sensor_effect
from .synonyms import find_instead, find_synonym

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
    "effect_rows",
    "effect_table",
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
    "sensor_effect",
    "subsystem_files",
    "wiring",
]
