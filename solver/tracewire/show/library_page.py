"""The page of a library: its blocks with formulas, ports, parameters and source; its subsystems."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tracewire.diagram import Diagram, Value
from tracewire.draw import draw
from tracewire.formula import Number, to_text
from tracewire.library import Library, describe_formulas, describe_origin, describe_parts
from tracewire.show.document import Figure, Report, Section
from tracewire.show.table import Table, shown


def library_report(
    title: str, library: Library, subsystems: Mapping[tuple[str, str], Diagram]
) -> Report:
    """The page of the blocks of a library, and of its subsystems by what a diagram includes and
    the name there.
    """
    names = sorted(library, key=lambda name: (library.families.get(name, ""), name))
    rows = tuple((library.families.get(name, ""), name, library[name].doc) for name in names)
    tables = [Table("", ("family", "block", "what it is"), rows)] if rows else []
    if subsystems:
        inside = tuple((*key, diagram.title) for key, diagram in subsystems.items())
        tables.append(Table("", ("include", "subsystem", "what it is"), inside))
    sections = [Section("What there is", tables=tuple(tables))]
    sections += [_of_block(library, name) for name in names]
    sections += [_of_subsystem(*key, diagram) for key, diagram in subsystems.items()]
    return Report(title, tuple(sections))


def _of_block(library: Library, name: str) -> Section:
    block = library[name]
    return Section(
        name,
        (block.doc,),
        tuple(Table("", p.head, p.rows).without_empty() for p in describe_parts(block)),
        code="\n".join(describe_formulas(block)),
        points=tuple(describe_origin(name, block)),
    )


def _of_subsystem(file: str, name: str, diagram: Diagram) -> Section:
    inputs = tuple(
        (port.name, port.unit, "a wire is needed" if port.default is None else _value(port.default))
        for port in diagram.inputs.values()
    )
    outputs = tuple((output, wire.signal) for output, wire in diagram.outputs.items())
    parameters = tuple((p, v.unit, _value(v)) for p, v in diagram.parameters.items())
    tables = (
        Table("", ("input", "unit", "default"), inputs),
        Table("", ("parameter", "unit", "value"), parameters),
        Table("", ("output", "signal"), outputs),
    )
    stem = f"{Path(file.replace(':', '_')).stem}_{name}"
    picture = Figure(f"{stem}.svg", f"The subsystem {name}", draw(diagram).write)
    return Section(
        name,
        (diagram.title,) if diagram.title else (),
        tuple(table.without_empty() for table in tables if table.rows),
        code=f"include: {file}",
        figures=(picture,),
    )


def _value(value: Value) -> str:
    """A value in SI."""
    if isinstance(value.formula, Number):
        return shown(value.formula.value * value.factor)
    return to_text(value.formula)
