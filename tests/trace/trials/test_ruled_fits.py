"""A fit to longer windows is not ruled by a few that its values and their starts hold astray."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tracewire.compile import compile
from tracewire.diagram import read
from tracewire.trace.options import TraceOptions
from tracewire.trace.trace import set_up_search

DEMO = Path(__file__).parents[3] / "diagrams/demo/pendulum.yaml"
ADDED = {
    "file: ": f"file: {DEMO.parent}/",
    "-contact]": "-contact, wound]",
    "\nsubsystems:": "  wound: {type: sided_spring, of: phi1, base: f_e, k: half}\n\nsubsystems:",
    "\nparameters:\n": "\nparameters:\n  half: {value: 0, unit: N m/rad, fit: [-1, 1]}\n",
}
VALUES = {
    "kappa1": 0.016937,
    "kappa2": 0.031008,
    "T_v1": 0.0045367,
    "T_s2": 0.0099468,
    "T_v2": 0.0,
    "k2": 0.79017,
    "c2": 0.021758,
    "half": -0.0033767,
}
"""A minimum of short windows; from there two of 21 longer ones hold all values."""


def test_two_windows_that_hold_all_values_are_left_out_first(tmp_path: Path) -> None:
    text = DEMO.read_text(encoding="utf-8")
    for old, new in ADDED.items():
        text = text.replace(old, new)
    file = tmp_path / "pendulum.yaml"
    file.write_text(text, encoding="utf-8")
    search = set_up_search(compile(read(file)), None, 1e-6, lambda _: None, TraceOptions())
    train, problem = search.data_split.train, search.problem
    short = problem.fit((), search.windows(train, 25), 25, VALUES)
    longer = problem.refit(short, search.windows(train, 75), 75)
    means = longer.windows.squares / [r.size for r in longer.windows.residuals]
    assert longer.reduced_chi2 < 1.5  # 2.2 from there
    assert np.max(means) < 3  # 14
