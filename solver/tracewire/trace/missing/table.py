"""A missing torque as a table: the text of its file, and a `table` block in the diagram."""

from __future__ import annotations

import numpy as np

from tracewire.diagram import AddBlock, Diagram, PointsFile
from tracewire.errors import OptionError
from tracewire.formula import number_text
from tracewire.trace.candidates.inside import diagram_at, local_name
from tracewire.trace.candidates.places import Place
from tracewire.trace.found import Missing


def missing_table(missing: Missing) -> str:
    """The text of a csv file of a missing torque, which a `table` block of a diagram can read.

    One column for the variable, one for the torque, in SI, and one for the samples near it. For two
    variables the file has one row for each pair: a `table` block has one input, and cannot read
    that. Points that no sample is near are left out. Raises OptionError: the torque depends on what
    is no number (history), or there are fewer than two points.
    """
    keys = [name.replace(" ", "_") for name in missing.variables]
    if not missing.grid:
        what = f"there is no table of a torque that depends on {' and '.join(missing.variables)}"
        raise OptionError.one(what, hint="A table is a function of one or two measured variables.")
    points = np.meshgrid(*missing.grid, indexing="ij")
    rows = [
        ", ".join(number_text(float(f"{x:.7g}")) for x in row)
        for row in zip(
            *(x.ravel().tolist() for x in (*points, missing.torque, missing.density)), strict=True
        )
        if row[-1] > 0
    ]
    if len(rows) < 2:
        raise OptionError.one("the missing torque is known at fewer than two points")
    return "\n".join(
        [
            f"# Empirical: the torque or force that is missing at '{missing.place}', in SI, as a",
            f"# smooth function of {' and '.join(missing.variables)} that the data ask for; it",
            f"# explains {missing.share:.0%} of what is unexplained. No law; of no use outside.",
            ", ".join((*keys, "torque", "samples")),
            *rows,
            "",
        ]
    )


def table_block(diagram: Diagram, place: Place, missing: Missing, file: str) -> AddBlock:
    """The missing torque as a `table` block that is added at its place, read from a csv file.

    file: the path of the text of `missing_table`, as the diagram names it: the file must be there.
    What free parameters can imitate is no part of the table: fit them again afterwards.
    Raises OptionError: the torque depends on more than one variable, or on none that a block can be
    wired to, or what is missing is no torque, but a sensor's.
    """
    signals = place.wires
    names = missing.variables
    if place.kind == "sensor":
        what = f"what is missing at '{place.name}' is no torque: a table cannot be added there"
        raise OptionError.one(what, hint="The map says how the sensor errs.")
    if len(names) != 1:
        what = f"the missing torque depends on {' and '.join(names)}; a table has one input"
        raise OptionError.one(what, hint="Write a block of your own for it.")
    if not signals.get(names[0]) or not missing.grid:
        known = ", ".join(name for name, signal in signals.items() if signal)
        what = f"a table cannot be wired to {names[0]}"
        raise OptionError.one(what, hint=f"At '{place.name}' it can be wired to {known}.")
    inside = diagram_at(diagram, place.within)
    taken = {*inside.blocks, *inside.parameters, *inside.inputs, *inside.subsystems}
    name = "missing"
    while name in taken:
        name += "_"
    column = names[0].replace(" ", "_")
    return AddBlock(
        name,
        "table",
        {"of": local_name(diagram, place.within, signals[names[0]])},
        {"points": PointsFile(file, column, "torque")},
        place.definition,
        place.kind == "drive",
        place.element,
        place.own,
        comment="empirical: no law",
    )
