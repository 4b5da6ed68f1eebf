"""Problems of NIST's Statistical Reference Datasets, nonlinear regression, from files as published.

The head of a file says in which lines its parts are; the model is a formula in words of its own:
square brackets, `arctan`, and an error e at the end.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
FOLDER = Path(__file__).parent / "nist"
NAMES = tuple(sorted(path.stem for path in FOLDER.glob("*.dat")))


@dataclass(frozen=True, eq=False)
class Problem:
    """A model y = formula(x, b1, b2, ...), its data, two starts, and the certified result.

    `x` (N,) by name of the predictor; `y` (N,) is what the formula gives (for Nelson the logarithm
    of the response). `errors` are standard deviations of the parameters, `rss` is the residual sum
    of squares.
    """

    name: str
    formula: str
    x: dict[str, Vector]
    y: Vector
    starts: tuple[dict[str, float], dict[str, float]]
    values: dict[str, float]
    errors: dict[str, float]
    rss: float


def problem(name: str) -> Problem:
    """The problem of one file."""
    text = (FOLDER / f"{name}.dat").read_text("ascii")
    lines = text.splitlines()
    table = [
        [float(number) for number in found[2].split()]
        for line in lines
        if (found := re.match(r"\s*(b\d)\s*=\s*(.+)", line))
    ]
    names = [f"b{number}" for number in range(1, len(table) + 1)]
    columns = [dict(zip(names, column, strict=True)) for column in zip(*table, strict=True)]
    first, last = map(int, re.findall(r"Data\s+\(lines (\d+) to (\d+)\)", text)[0])
    data = np.loadtxt(lines[first - 1 : last]).T
    logarithm, formula = _model(text)
    predictors = ["x"] if len(data) == 2 else [f"x{number}" for number in range(1, len(data))]
    return Problem(
        name=name,
        formula=formula,
        x=dict(zip(predictors, data[1:], strict=True)),
        y=np.log(data[0]) if logarithm else data[0],
        starts=(columns[0], columns[1]),
        values=columns[2],
        errors=columns[3],
        rss=float(re.findall(r"Residual Sum of Squares:\s+(\S+)", text)[0]),
    )


def _model(text: str) -> tuple[bool, str]:
    """Whether log[y] is modelled, and the formula in tracewire's words, without the error."""
    found = re.search(r"^ +(y|log\[y\]) +=(.+?)\+ +e$", text, re.MULTILINE | re.DOTALL)
    assert found, "no model in the file"
    formula = " ".join(found[2].split())
    for theirs, ours in (("[", "("), ("]", ")"), ("arctan", "atan")):
        formula = formula.replace(theirs, ours)
    return found[1] != "y", formula
