"""The declared diagram as text, in SI or in other units: the same physics with scaled numbers.

Lengths and angles are multiplied by `length`, times by `time`, forces and torques by `force`. The
scaled diagram has no units: a trace must not depend on what one is.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from benchmarks.tracing.make import SYSTEMS

ANGLES = (180 / np.pi, 1000.0, 1 / (2 * np.pi))
LENGTHS = (1000.0, 100.0, 1e6)
TIMES = (1000.0, 1.0, 1 / 60)
FORCES = (1000.0, 1e-3, 1.0, 1e5)
EXPONENTS = {  # of force, length, time by unit
    "kg m^2": (1, -1, 2),
    "kg": (1, -1, 2),
    "N m": (1, 0, 0),
    "N": (1, 0, 0),
    "N m/rad": (1, -1, 0),
    "N/m": (1, -1, 0),
    "N/m^3": (1, -3, 0),
    "N m s/rad": (1, -1, 1),
    "N s/m": (1, -1, 1),
    "m/s": (0, 1, -1),
}
PARAMETER = re.compile(
    r"^  (?P<name>\w+): \{value: (?P<value>[^,}]+), unit: (?P<unit>[^,}]+)"
    r"(, fit: \[(?P<low>[^,]+), (?P<high>[^\]]+)\])?\}"
)


@dataclass(frozen=True)
class Units:
    """Factors from SI."""

    length: float = 1.0
    time: float = 1.0
    force: float = 1.0

    @property
    def plain(self) -> bool:
        """Whether they are SI."""
        return self == Units()

    def factor(self, exponents: tuple[int, int, int]) -> float:
        """Of a quantity with exponents of force, length and time."""
        force, length, time = exponents
        return float(self.force**force * self.length**length * self.time**time)


def draw_units(angle: bool, rng: np.random.Generator) -> Units:
    """Units of a case; not SI."""
    lengths = ANGLES if angle else LENGTHS
    return Units(*(float(rng.choice(options)) for options in (lengths, TIMES, FORCES)))


def diagram(
    system: str,
    units: Units,
    given: dict[str, float],
    control: tuple[float, float] | None,
) -> str:
    """The text of a declared diagram. `given` are values other than those of the file; with
    `control` (kp, kd) the drive is the reference of a controller that the diagram has."""
    lines = []
    coordinate, rate = "", ""
    for line in (SYSTEMS / f"{system}.yaml").read_text().splitlines():
        if match := PARAMETER.match(line):
            lines.append(_parameter(match, units, given))
            continue
        if found := re.match(r"  (\w+): \{type: integrator, of: (\w+)", line):
            coordinate, rate = coordinate or found[1], rate or found[2]
        if line == "parameters:" and control:
            kp, kd = control
            line += f"\n  kp: {{value: {kp * units.factor((1, -1, 0)):.9g}}}"
            line += f"\n  kd: {{value: {kd * units.factor((1, -1, 1)):.9g}}}"
        if control and "type: sum" in line:
            formula = f"kp*(u - {coordinate}) - kd*{rate}"
            lines.append(f"  control: {{type: expression, formula: {formula}}}")
            line = line.replace("[u,", "[control,")
        if control and line.startswith("inputs"):
            line = "inputs: {u: {}}  # the reference of the controller"
        if not units.plain:
            line = _scaled(line, units)
        lines.append(line)
    return "\n".join(lines) + "\n"


def _parameter(match: re.Match[str], units: Units, given: dict[str, float]) -> str:
    size = units.factor(EXPONENTS[match["unit"].strip()])
    value = given.get(match["name"], float(match["value"])) * size
    text = f"  {match['name']}: {{value: {value:.9g}"
    if units.plain:
        text += f", unit: {match['unit']}"
    if match["low"]:
        low, high = (float(match[key]) * size for key in ("low", "high"))
        text += f", fit: [{low:.9g}, {high:.9g}]"
    return text + "}"


def _scaled(line: str, units: Units) -> str:
    """A line without units, its numbers scaled."""
    line = re.sub(r", unit: [^,}]+", "", re.sub(r"\{unit: [^}]+\}", "{}", line))
    if line.startswith("span"):
        return f"span: [0, {10 * units.time:.9g}]"
    if match := re.search(r"start: ([\d.]+)", line):
        return line.replace(match[0], f"start: {float(match[1]) * units.length:.9g}")
    if "type: sin" in line:
        return f"  height: {{type: expression, formula: sin(phi/{units.length:.17g})}}"
    return line
