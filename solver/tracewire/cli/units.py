"""`tracewire units`: the units that a value may have, and what they are in SI."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug
from tracewire.cli.output import print_json, print_text

COMMON = {  # of each quantity the SI unit first
    "length": "m cm mm um km in ft",
    "angle": "rad deg mrad turn arcmin arcsec",
    "time": "s ms us min h day",
    "frequency": "Hz kHz",
    "rate": "rad/s deg/s rpm",
    "acceleration": "m/s^2 gravity",
    "mass": "kg g mg t lb",
    "force": "N mN kN kgf lbf",
    "torque": "Nm mNm",
    "pressure": "Pa kPa MPa bar mbar psi",
    "energy": "J kJ mJ kWh eV",
    "power": "W mW kW",
    "temperature": "K",
    "current": "A mA",
    "voltage": "V mV",
    "resistance": "Ohm kOhm",
    "capacity": "F uF nF",
    "inductance": "H mH",
    "number": "1 % ppm",
}


def units(
    unit: Annotated[
        str | None, typer.Argument(metavar="[UNIT]", help="A unit.", show_default=False)
    ] = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """List common units, or say what one is in SI.

    They stand behind a value, alone, multiplied, divided and in powers; so do all others that the
    library pint knows. Files and JSON are in SI; a run is printed and drawn in the units of the
    diagram, or of `run --unit`.

    \b
    Examples:
      tracewire units
      tracewire units "mN m s/deg"
    """
    from tracewire.formula import read_unit

    if unit is not None:
        found = read_unit(unit)
        if as_json:
            print_json({"unit": unit, "factor": found.factor, "si": found.text})
        else:
            print_text(f"1 {unit} = {found.factor:.12g} {found.text}".rstrip())
        return
    known = {
        what: {name: read_unit(name) for name in names.split()} for what, names in COMMON.items()
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
        print_text(f"{what + ':':14}{', '.join(told)}")
    print_text("Products, quotients and powers of them: kg m^2, N m s/rad, 1/s, m/s^2.")
