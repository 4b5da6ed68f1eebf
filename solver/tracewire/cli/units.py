"""`tracewire units`: the units that a value may have, and what they are in SI."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug
from tracewire.cli.output import print_json, print_text

QUANTITIES = {
    "m": "length",
    "rad": "angle",
    "s": "time",
    "Hz": "frequency",
    "rad/s": "rate",
    "m/s": "speed",
    "m/s^2": "acceleration",
    "kg": "mass",
    "kg m^2": "inertia",
    "N": "force",
    "N m": "torque",
    "N/m": "stiffness",
    "N s/m": "damping",
    "Pa": "pressure",
    "J": "energy",
    "W": "power",
    "K": "temperature",
    "A": "current",
    "V": "voltage",
    "C": "charge",
    "Ohm": "resistance",
    "S": "conductance",
    "F": "capacity",
    "H": "inductance",
    "Wb": "flux",
    "T": "flux density",
    "m^2": "area",
    "m^3": "volume",
    "m^3/s": "flow",
    "kg/m^3": "density",
    "mol": "amount",
    "mol/m^3": "concentration",
    "cd": "intensity",
    "sr": "solid angle",
    "1": "number",
}
"""What is measured in a unit of SI; the others stand under their own text."""


def units(
    unit: Annotated[
        str | None, typer.Argument(metavar="[UNIT]", help="A unit.", show_default=False)
    ] = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """List units, or say what one is in SI.

    They stand behind a value, alone, multiplied, divided and in powers; so do all others that the
    library pint knows. Files and JSON are in SI; a run is printed and drawn in the units of the
    diagram, or of `run --unit`.

    \b
    Examples:
      tracewire units
      tracewire units "mN m s/deg"
    """
    from tracewire.formula import PREFIXES, read_unit, unit_list

    if unit is not None:
        found = read_unit(unit)
        if as_json:
            print_json({"unit": unit, "factor": found.factor, "si": found.text})
        else:
            print_text(f"1 {unit} = {found.factor:.12g} {found.text}".rstrip())
        return
    listed = unit_list()
    order = [*QUANTITIES, *(base for base in listed if base not in QUANTITIES)]
    known = {
        QUANTITIES.get(base, base): {name: read_unit(name) for name in listed[base]}
        for base in order
    }
    if as_json:
        print_json(
            {
                what: {name: {"factor": one.factor, "si": one.text} for name, one in group.items()}
                for what, group in known.items()
            }
        )
        return
    for what, group in known.items():
        base, *others = group
        told = [base, *(f"{name} = {group[name].factor:.6g} {base}" for name in others)]
        print_text(f"{what + ':':15}{', '.join(told)}")
    print_text(f"All symbols but kg and cd may have a prefix, as nC or mmol: {PREFIXES}.")
    print_text("Products, quotients and powers of them: kg m^2, N m s/rad, 1/s, m/s^2, mol/L.")
