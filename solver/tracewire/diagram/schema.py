"""A JSON Schema of diagram files, for editors: made from the reader's keys and a library."""

from __future__ import annotations

import json
import keyword
from collections.abc import Mapping
from typing import Any

from tracewire.diagram.grammar import INSIDE, OF_A_BLOCK, OF_KINDS, SHAPES, TOP
from tracewire.diagram.shapes import (
    Anything,
    Either,
    Formula,
    Key,
    Listed,
    Mapped,
    Named,
    Number,
    Record,
    Shape,
    Text,
)
from tracewire.formula import CONSTANTS, FUNCTIONS, is_name
from tracewire.library import Block, Input, Library, Parameter, bounds_text, joined_doc, wiring

Schema = dict[str, Any]
DRAFT = "http://json-schema.org/draft-07/schema#"
"""The version that the YAML language server reads in every release."""
SCALAR = ["string", "number", "boolean"]
"""What a YAML reader may take a text for; a diagram has numbers and texts only."""


def schema_of(library: Library) -> Schema:
    """The JSON Schema (draft 7) of a diagram file, or of a file that others include.

    It knows keys, the types of blocks with their inputs, parameters and bounds, and words. Of a
    file that extends another it knows the names of sections alone. Names of signals and parameters
    it does not know: `tracewire check` does.
    """
    definitions: Schema = {name: _shape(shape) for name, shape in SHAPES.items()}
    definitions |= {_own(name): _key(key) for name, key in OF_A_BLOCK.items()}
    definitions["block"] = _block(library)
    definitions["subsystem"] = _changing(INSIDE, definitions["subsystem"])
    top = definitions["diagram"]
    own = [{"required": [key]} for key in ("subsystems", "include")]
    known = {"if": {"pattern": r"\."}, "else": {"enum": sorted(library)}}  # mylab.magnet has a dot
    types = {"additionalProperties": {"properties": {"type": known}}}
    files = [{"required": [key]} for key in ("blocks", "subsystems", "parameters", "presets")]
    whole = {
        **{key: value for key, value in top.items() if key != "required"},
        "anyOf": files,
        "if": {"not": {"anyOf": own}},
        "then": {"properties": {"blocks": types}},
    }
    return {
        "$schema": DRAFT,
        "title": "A tracewire diagram",
        "description": "https://json-schema.org for editors; `tracewire check` knows more.",
        **_changing(TOP, whole),
        "definitions": definitions,
    }


def _changing(keys: Mapping[str, Key], whole: Schema) -> Schema:
    """The sections of what may extend another one: a change of one has the same names."""
    names = _object({name: {"description": key.doc} for name, key in keys.items()})
    return {"if": {"required": ["extends"]}, "then": names, "else": whole}


def schema_text(schema: Schema) -> str:
    """A schema as the text of a file: a line for each definition, and for each type of a block."""
    return f"{_lines(schema, 4)}\n"


def _lines(value: Any, depth: int) -> str:
    """JSON with a line for each part, down to a depth."""
    if not depth or not isinstance(value, dict | list) or not value:
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[\n" + ",\n".join(_lines(part, depth - 1) for part in value) + "\n]"
    parts = (f"{json.dumps(key)}: {_lines(part, depth - 1)}" for key, part in value.items())
    return "{\n" + ",\n".join(parts) + "\n}"


def _shape(shape: Shape) -> Schema:
    match shape:
        case Named(name):
            return {"$ref": f"#/definitions/{name.replace(' ', '%20')}"}
        case Text(words, names):
            if words:
                return {"enum": list(words)}
            return {"type": "string"} if names not in ("", "unit") else {"type": SCALAR}
        case Number(words, above, low):
            bounds = {"exclusiveMinimum": above, "minimum": low}
            number = {"type": "number"} | {k: v for k, v in bounds.items() if v is not None}
            return {"anyOf": [number, {"enum": list(words)}]} if words else number
        case Formula():
            return {"type": ["number", "string"]}
        case Listed(of, count, alone):
            items: Schema = {"type": "array", "items": _shape(of)}
            if count is not None:
                items |= {"minItems": count, "maxItems": count}
            return {"anyOf": [_shape(of), items]} if alone else items
        case Either(shapes):
            return {"anyOf": [_shape(one) for one in shapes]}
        case Mapped(of, names, least):
            mapping: Schema = {"type": "object", "additionalProperties": _shape(of)}
            if names == "new":
                mapping["propertyNames"] = _name()
            return mapping | ({"minProperties": least} if least else {})
        case Record():
            return _record(shape)
        case Anything():
            return {}


def _record(record: Record) -> Schema:
    found = _object({name: _key(key) for name, key in record.keys.items()})
    needed = [name for name, key in record.keys.items() if key.required]
    if needed:
        found["required"] = needed
    if record.one:
        found |= {"minProperties": 1, "maxProperties": 1}
    if record.some:
        found["oneOf" if record.apart else "anyOf"] = [{"required": [n]} for n in record.some]
    return found


def _object(properties: Mapping[str, Schema]) -> Schema:
    return {"type": "object", "properties": dict(properties), "additionalProperties": False}


def _key(key: Key) -> Schema:
    return {"description": key.doc} | _shape(key.shape)


def _name() -> Schema:
    """What a part of a diagram may be called."""
    words = {*keyword.kwlist, *CONSTANTS, *FUNCTIONS, "t"}
    reserved = sorted(word for word in words if not is_name(word))
    return {"pattern": "^(?!__)[A-Za-z_][A-Za-z0-9_]*$", "not": {"enum": reserved}}


def _block(library: Library) -> Schema:
    """A block: its type, and by that its inputs and parameters."""
    types = [{"const": name, "description": library[name].doc} for name in sorted(library)]
    type_doc = OF_A_BLOCK["type"].doc
    return {
        "type": "object",
        "required": ["type"],
        "properties": {
            "type": {"description": type_doc, "anyOf": [*types, {"type": "string"}]},
        },
        "allOf": [
            {
                "if": {"properties": {"type": {"const": name}}, "required": ["type"]},
                "then": _use(name, library[name]),
            }
            for name in sorted(library)
        ],
    }


def _use(name: str, block: Block) -> Schema:
    """What stands on the line of a block of this type."""
    properties: dict[str, Schema] = {"type": {"const": name, "description": block.doc}}
    properties |= {port.name: _port(port) for port in block.inputs}
    properties |= {parameter.name: _parameter(parameter) for parameter in block.parameters}
    for own in OF_A_BLOCK:
        if own != "place" or name == "sum":
            properties.setdefault(own, {"$ref": f"#/definitions/{_own(own)}"})
    needed = [port.name for port in block.inputs if port.default is None]
    needed += [p.name for p in block.parameters if p.default is None]
    # an editor offers all that is required at once, by the title
    found = {"title": name, "properties": properties, "additionalProperties": False}
    if not needed:
        return found
    # of a row the first and the last block may have inputs of their own
    is_row = {"required": ["replicate"]}
    return found | {"if": {"not": is_row}, "then": {"required": needed}}


def _own(key: str) -> str:
    """The definition of a key that blocks of all types have, to which each of them refers."""
    return f"block.{key}"


def _port(port: Input) -> Schema:
    shape = _shape(Named("wires" if port.many else "wire"))
    return {"description": joined_doc(port.doc, _unit(port.unit), wiring(port))} | shape


def _parameter(parameter: Parameter) -> Schema:
    doc = joined_doc(parameter.doc, _unit(parameter.unit), bounds_text(parameter))
    found: Schema = {"description": doc}
    bounds = {
        "minimum": parameter.low,
        "maximum": parameter.high,
        "exclusiveMinimum": parameter.above,
    }
    given = {name: bound for name, bound in bounds.items() if bound is not None}
    if isinstance(parameter.default, int | float) or parameter.default:
        found["default"] = parameter.default
    shape = _shape(Named(OF_KINDS[parameter.kind]))
    if not given or parameter.kind != "number":
        return found | shape
    # a bound holds for a number alone, which is in SI, and for those in a list
    return found | {"allOf": [shape, given | {"items": given}]}


def _unit(unit: str) -> str:
    return f"in {unit}" if unit else ""
