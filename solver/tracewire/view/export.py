"""What one sees on the page as a file: a figure, or a Python script that makes the same run."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from threading import Lock

from tracewire.show import plot_run
from tracewire.solve import Run
from tracewire.view.setting import Setting

DRAWING = Lock()
"""Matplotlib's settings are those of the whole process: one figure is drawn at a time."""

SCRIPT = '''\
"""The run that the live page of {name} has shown."""

import tracewire as tw

model = tw.compile(tw.read({path!r}))
{series}run = tw.simulate(
    model,
    parameters={given!r},  # in SI
    preset={preset!r},
    span={span!r},{conditions}
)
for name, values in run.signals.items():
    print(f"{{name}}: from {{values.min():.6g}} to {{values.max():.6g}}")
run.save({output!r})
'''
SERIES = """\
measured = tw.load_measured(model, driving=True, series=[{name!r}])[0]
"""
CONDITIONS = """
    start={start!r},
    inputs=measured.inputs,"""


def figure_of(setting: Setting, run: Run, shown: tuple[str, ...]) -> str:
    """The figure of a run as SVG, with the samples of its measured series."""
    kept = {name: values for name, values in run.signals.items() if name in shown}
    measured = None if setting.series is None else setting.series.measured
    with DRAWING, tempfile.TemporaryDirectory() as folder:
        path = plot_run(replace(run, signals=kept), Path(folder) / "run.svg", measured)
        return path.read_text(encoding="utf-8")


def script_of(setting: Setting, file: Path) -> str:
    """A Python script that makes the run of a setting from the diagram file."""
    series = conditions = ""
    if setting.series is not None:
        series = SERIES.format(name=setting.series.measured.series)
        conditions = CONDITIONS.format(start=dict(setting.series.segment.start))
    return SCRIPT.format(
        name=file.name.replace("\\", "/").replace('"', "'"),
        path=str(file),
        series=series,
        given=dict(setting.given),
        preset=setting.preset,
        span=setting.span,
        conditions=conditions,
        output=f"{file.stem}_run.csv",
    )
