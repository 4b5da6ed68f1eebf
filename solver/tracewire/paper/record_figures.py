"""Figures of paper A: a stage of its model beside the record, after the simplex or without it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tracewire.data import read_record
from tracewire.fit import fit, optimset
from tracewire.paper.setting import Task, label
from tracewire.shipped import shipped
from tracewire.show.style import LINES, fit_time, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RECORD = "a_torsion/measured.csv"
EXPERIMENTAL, NUMERICAL = LINES[0], LINES[1]  # blue and red, as in the paper


def beside_the_record(task: Task) -> Figure:
    """The model's signals over the record's; rates of the record are backward differences.

    With `iterations` the simplex first adapts the free parameters to the disk's angle, as in the
    paper, and the criterion mean((measured - model)^2)/2 is told before and after.
    """
    rows = task.figure.panels
    angles = {name.removesuffix("_dot"): name.removesuffix("_dot") for row in rows for name in row}
    record = read_record(shipped("diagrams") / "papers" / RECORD, {**angles, "phi2": "phi2"}, "t")
    start = task.run(times=record.t)
    values, told = {}, ""
    if task.figure.iterations:
        steps = task.of(3, task.figure.iterations, task.figure.iterations)
        limit = optimset(MaxIter=steps, Display="off")
        found = fit(task.model, method="fminsearch", options=limit)
        values = dict(found.values)
        told = f"criterion {found.criterion_before:.3g} rad², after {found.iterations} iterations "
        told += f"of the simplex {found.criterion:.3g} rad²"
    run = task.run(times=record.t, values=values) if values else start
    if not told and ("phi2",) in rows:
        criterion = np.mean((record.columns["phi2"] - run["phi2"]) ** 2) / 2
        told = f"criterion {criterion:.3g} rad²"
    figure, axes = panels([2.6] * len(rows) if len(rows) > 1 else [3.2])
    for panel, (name,) in zip(axes, rows, strict=True):
        measured = record.columns[name.removesuffix("_dot")]
        if name.endswith("_dot"):
            measured = np.diff(measured, prepend=measured[0]) / np.diff(record.t, prepend=-np.inf)
        panel.plot(record.t, measured, color=EXPERIMENTAL, linewidth=3.0, label="record")
        panel.plot(run.t, run[name], color=NUMERICAL, linewidth=1.3, label="model")
        panel.set_ylabel(label(name, run))
    axes[0].set_title(told, loc="left", fontsize=9, color="#555555")
    axes[0].legend(loc="lower right", bbox_to_anchor=(1, 0.99), ncols=2, borderpad=0)
    axes[-1].set_xlabel("$t$ [s]")
    fit_time(axes[-1], record.t)
    figure.align_ylabels(axes)
    return figure
