"""The columns of a measured series, read and cleaned as the diagram says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from tracewire.data import STEPS, Record, read_record
from tracewire.diagram import Channel, Cleaning, Series
from tracewire.errors import DataError, OptionError
from tracewire.residual.remarks import factor_of_column

SAMPLE_BY_SAMPLE = ("sort", "trim", "calibrate")
"""The steps of `clean` that look at one sample at a time."""


def read_series(series: Series) -> Record:
    """The columns of a series in SI.

    A unit that is declared at a signal is that of its calibrated numbers: its column is as it
    stands in the file.
    """
    channels = _columns(series)
    calibrated = (str(s.options.get("signal")) for s in series.clean if s.step == "calibrate")
    clock, form = series.time, series.format
    return read_record(
        series.file,
        {name: channel.column for name, channel in channels.items()},
        clock.column or None,
        units={n: c.declared for n, c in channels.items() if c.declared is not None},
        time_unit=clock.unit,
        raw=[n for n in calibrated if n in channels and channels[n].declared is not None],
        delimiter=form.delimiter,
        decimal=form.decimal,
        comment=form.comment,
        every=clock.every,
        where=series.where,
        in_any_order=is_sorted(series),
        sparse=tuple(name for name in channels if name in series.channels),
        missing=form.missing,
        place=series.place,
    )


def is_sorted(series: Series) -> bool:
    """Whether the rows are put in the order of time, which is the first step where it is one."""
    return any(step.step == "sort" for step in series.clean)


def _columns(series: Series) -> dict[str, Channel]:
    """The channels that are columns of the file, by their names in the record."""
    inputs = {f"input {name}": channel for name, channel in series.inputs.items()}
    return {n: c for n, c in {**series.channels, **inputs}.items() if c.column}


def cleaned(series: Series, record: Record, steps: Sequence[Cleaning]) -> Record:
    """The record after some steps of `clean`."""
    channels = _columns(series)
    for step in steps:
        options: dict[str, object] = dict(step.options)
        try:
            if step.step not in SAMPLE_BY_SAMPLE:
                _refuse_blanks(record)
                record = _on_turns(series, record)
            if step.step == "calibrate":
                signal = str(options["signal"])
                gain, offset = (
                    cast(float, options.get(name, default))
                    for name, default in (("gain", 1.0), ("offset", 0.0))
                )
                unit = channels[signal].declared or ""
                record = record.calibrate(signal, gain, offset, unit)
                continue
            for name, option in STEPS[step.step].items():
                if option.kind == "size" and name in options:
                    factor = record.unit(str(options["signal"])).factor
                    options[name] = cast(float, options[name]) * factor
            record = record.clean(step.step, options)
        except OptionError as error:
            where = f"'{step.step}' of series '{series.name}'"
            problems = [
                replace(p, what=f"{where}: {p.what}", place=step.place) for p in error.problems
            ]
            raise DataError(problems) from None
    return record


def _refuse_blanks(record: Record) -> None:
    """Refuse, for a step that looks at several samples, rows without a value. Raises
    OptionError."""
    for name, column in record.columns.items():
        if count := int(np.isnan(column).sum()):
            what = f"'{name}' has no value in {count} of {len(column)} rows, the first at t = "
            what += f"{record.t[np.isnan(column)][0]:g} s"
            hint = "Leave out the step, or these rows of the file."
            raise OptionError.one(what, hint=hint)


def _on_turns(series: Series, record: Record) -> Record:
    """The record whose signals with a period go on from turn to turn: a step that looks at several
    samples would make something between the last one of a turn and the first one of the next."""
    columns = dict(record.columns)
    for name, channel in series.channels.items():
        if channel.modulo is not None and name in columns:
            period = channel.modulo * factor_of_column(record, name, channel)
            columns[name] = np.unwrap(columns[name], period=period)
    return replace(record, columns=columns)
