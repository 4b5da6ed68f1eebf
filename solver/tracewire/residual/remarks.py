"""What is odd about a measured series beside its model: units, time scale, angles."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import cast

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model
from tracewire.data import Record, signal_remarks, time_remarks, usual_range
from tracewire.diagram import Channel, Diagram, Series
from tracewire.errors import DataError, Problem
from tracewire.formula import evaluate, names_of, quantity_hint, read_unit, two_digits
from tracewire.residual.endings import alike, endings
from tracewire.residual.inputs import line_error, looks_held, spline_if_smooth
from tracewire.residual.limits import INPUT, REMARK
from tracewire.residual.noise_estimate import noise_of_signal


def check_quantities(model: Model, series: Series, record: Record) -> None:
    """Raise DataError where a column measures another quantity than its signal or input."""
    wanted = {name: model.flat.units.get(name, "") for name in series.channels}
    wanted |= {f"input {name}": model.diagram.inputs[name].unit for name in series.inputs}
    problems = []
    for name, unit in wanted.items():
        given = record.unit(name).text
        if unit and given and unit != given and not alike(unit, given):
            channel = series.channels.get(name) or series.inputs[name.removeprefix("input ")]
            column = f"its column '{channel.column}'" if channel.column else "its measurement"
            what = f"'{name}' is in {unit} in the diagram, and {column} in {given}"
            told = "g" if record.unit(name) == read_unit("g") else channel.declared or given
            hint = quantity_hint(told, unit, "Name another column, or correct the unit.")
            problems.append(Problem(what, channel.place, hint=hint))
    if problems:
        raise DataError(problems)


def factor_of_column(record: Record, name: str, channel: Channel) -> float:
    """The factor to SI of the numbers that are said of a column."""
    return record.unit(name).factor if channel.declared is None else 1.0


def remarks_of(
    model: Model, series: Series, read: Record, values: Mapping[str, float], zero: float
) -> tuple[str, ...]:
    """What is odd about a record as it was read, in SI and in the file's own time, and its units.

    values: the parameters of the diagram; zero: the time in the file that is t = 0.
    """
    found = list(read.remarks)
    if series.time.every is None:
        found += time_remarks(read.t)
    for name, column in read.columns.items():
        exact = _is_command(series.inputs.get(name.removeprefix("input ")), column)
        cleaned, noise = name in _without_outliers(series), _declared_noise(series, read, name)
        unit, factor = _unit_of_column(series, read, name)
        found += signal_remarks(
            name, read.t, column / factor, unit, exact=exact, cleaned=cleaned, noise=noise / factor
        )
    found += _on_names(model, series, read)
    about_units = _on_span(model, series, read, values, zero) + _on_angles(
        model, series, read, values
    )
    found += about_units or _on_start(model, series, read, values, zero)
    found += _on_sigma(model, series, read)
    found += _on_rest(model, series, read)
    found += _on_hold(series, read)
    return tuple(found)


def _on_names(model: Model, series: Series, read: Record) -> list[str]:
    """Columns of which neither the diagram nor the header says a unit, and whose names end with
    another one than that in which they are read."""
    columns = [("the time", series.time.column, "s", series.time.unit or "")]
    for name, channel in {**series.inputs, **series.channels}.items():
        port = model.diagram.inputs.get(name)
        unit = port.unit if port is not None else model.flat.units.get(name, "")
        dimensionless = channel.declared == ""
        said = "1" if dimensionless else series.unit_of(channel)[0]
        columns.append((name, channel.column, unit, said))
    found = []
    for name, column, unit, said in columns:
        if said or (name == "the time" and read.time_unit.text != "s"):
            continue
        told = next((u for _, u in endings(column) if unit and alike(u, unit)), "")
        if told and read_unit(told).factor != 1.0:
            found.append(
                f"{name}: the column '{column}' is read in {unit}; where its name tells its unit, "
                f"say unit: {told}"
            )
    return found


def _on_wraps(name: str, t: Vector, column: Vector, unit: str, factor: float) -> list[str]:
    """An angle (N,) in SI that jumps by a turn from one sample to the next, once at least, and
    moves little in others: it is not said to come round."""
    steps = np.abs(np.diff(column))
    near = np.abs(steps - 2 * np.pi) < REMARK.near_turn
    if not near.any() or float(np.median(steps)) > REMARK.near_turn:
        return []
    turn = 2 * np.pi / factor
    return [
        f"{name} jumps by about {turn:.4g} {unit} {int(near.sum())} times, first at "
        f"t = {t[1:][near][0]:.6g} s: does the angle come round? Then say modulo: {turn:.4g}"
    ]


def _on_angles(
    model: Model, series: Series, read: Record, values: Mapping[str, float]
) -> list[str]:
    """Angles that may be in degrees, or counted from another line."""
    states, found = {state.name: state for state in model.flat.states}, []
    for name in series.channels:
        given = read.unit(name)
        angle = given.text or model.flat.units.get(name, "")
        if name not in read.columns or angle != "rad":
            continue
        column, (shown, factor) = read.columns[name], _unit_of_column(series, read, name)
        channel = series.channels[name]
        period = (channel.modulo or 0.0) * factor_of_column(read, name, channel) / factor
        if channel.modulo is None:
            found += _on_wraps(name, read.t, column, shown or "rad", factor)
        elif shown == "deg" and abs(period - 2 * math.pi) < REMARK.near_turn / 10:
            found.append(f"{name} has modulo: {period:.4g} in deg: a turn is modulo: 360")
        low, high = usual_range(column)
        scaled = series.channels[name].gain is not None  # a column of counts, or of volts
        said = bool(given.text) or scaled
        if given.factor == 1.0 and not said and high - low > REMARK.largest_angle:
            found.append(
                f"{name} goes from {column.min():.4g} to {column.max():.4g} rad: "
                "is the column in degrees? Then say unit: deg"
            )
        elif name in states and name not in series.start:
            start = evaluate(states[name].start, values)
            if abs(abs(float(column[0]) - start) - math.pi) < REMARK.near_pi:
                found.append(
                    f"{name} begins at {column[0]:.4g} rad, about pi from the diagram's start at "
                    f"{start:.4g} rad: is the angle measured from another line?"
                )
    return found


def _channel_of(series: Series, name: str) -> Channel | None:
    """The channel of a column by its name in a record."""
    return series.channels.get(name) or series.inputs.get(name.removeprefix("input "))


def _unit_of_column(series: Series, read: Record, name: str) -> tuple[str, float]:
    """The unit of a column, as the diagram or the file's header writes it, and its factor to SI;
    else that in SI."""
    channel = _channel_of(series, name)
    unit, factor = ("", 1.0) if channel is None else series.unit_of(channel)
    return (unit, factor) if unit else (read.unit(name).text, 1.0)


def _declared_noise(series: Series, read: Record, name: str) -> float:
    """The standard deviation that is declared of a column, in SI; 0 where nothing is said."""
    channel = _channel_of(series, name)
    if channel is None or channel.sigma is None:
        return 0.0
    return float(channel.sigma * factor_of_column(read, name, channel))


def _without_outliers(series: Series) -> set[str]:
    """The columns whose outliers are left out."""
    found: set[str] = set()
    for step in series.clean:
        signals = step.options["signals"] if step.step == "outliers" else ()
        found |= {signals} if isinstance(signals, str) else set(cast(tuple[str, ...], signals))
    return found


def _is_command(channel: Channel | None, column: Vector) -> bool:
    """Whether a column is an input whose values act as they stand there, steps and all."""
    return channel is not None and (
        channel.hold == "previous" or channel.sigma == 0.0 or looks_held(column)
    )


def _on_hold(series: Series, read: Record) -> list[str]:
    """Inputs of which nothing is said, that look held or have few samples a period."""
    found = []
    for name, channel in series.inputs.items():
        column = read.columns.get(f"input {name}")
        if channel.hold is not None or column is None:
            continue
        lost = line_error(read.t, column)
        if looks_held(column):
            found.append(
                f"the input {name} looks held: most of its samples repeat the one before; if it "
                "acts so, say hold: previous, if not, hold: linear"
            )
        elif lost > INPUT.lost and spline_if_smooth(read.t, column) is None:
            found.append(
                f"the input {name} has few samples a period: straight lines between them lose "
                f"{two_digits(100 * lost)} % of its amplitude; say hold: smooth where it is smooth "
                "between samples, hold: previous where each value acts until the next"
            )
    return found


def _on_sigma(model: Model, series: Series, read: Record) -> list[str]:
    """Signals whose declared noise is not that of their samples."""
    found = []
    for name, channel in series.channels.items():
        column = read.columns.get(name)
        if channel.sigma is None or column is None:
            continue
        unit, factor = _unit_of_column(series, read, name)
        unit = unit or model.flat.units.get(name, "")
        sigma = channel.sigma * factor_of_column(read, name, channel) / factor
        seen, spread = noise_of_signal(column / factor, read.t), float(np.std(column / factor))
        if seen.is_sure and seen.low > REMARK.noisier * sigma:
            what = f"its samples scatter by {seen.level:.3g} {unit}".rstrip()
            what += f", {two_digits(seen.level / sigma)} times that"
        elif 0 < spread < sigma:
            what = f"the whole signal varies by {spread:.3g} {unit}".rstrip() + " (rms)"
        else:
            continue
        declared = f"{sigma:.3g} {unit}".rstrip()
        found.append(
            f"{name} is declared with a noise of sigma = {declared}, and {what}: "
            "sigma is in the unit of the column; correct it, or leave it out to have it estimated"
        )
    return found


def begins_elsewhere(signal: str, measured: Vector, simulated: float) -> str:
    """What to say of a measured state (N,) whose run begins elsewhere, in SI; '' where it does
    not."""
    if not abs(measured[0] - simulated) > REMARK.elsewhere * float(np.ptp(measured)):
        return ""
    return (
        f"{signal} begins at {float(measured[0]):.4g}, and the run is at {simulated:.4g} there "
        f"(SI): where that is another start, say start: {{{signal}: free}}"
    )


def _on_start(
    model: Model, series: Series, read: Record, values: Mapping[str, float], zero: float
) -> list[str]:
    """Measured states that begin elsewhere than the diagram says, where the series says no start: a
    trace would look for what makes up for it."""
    begin = float(evaluate(model.flat.span[0], values))
    if series.start or series.preset or not np.isclose(read.t[0] - zero, begin):
        return []
    free = {name for name, parameter in model.flat.parameters.items() if parameter.fit is not None}
    found = []
    for state in model.flat.states:
        channel, column = series.channels.get(state.name), read.columns.get(state.name)
        if channel is None or column is None or channel.modulo is not None:
            continue
        plain = channel.gain is None and channel.offset is None
        if plain and free.isdisjoint(names_of(state.start)):
            found.append(begins_elsewhere(state.name, column, evaluate(state.start, values)))
    return [text for text in found if text]


def _on_rest(model: Model, series: Series, read: Record) -> list[str]:
    """Inputs that rest at exactly zero where a sign or a friction asks for their side."""
    found = []
    guards = {mode.text: mode.signal for mode in model.modes}
    for name in series.inputs:
        column = read.columns.get(f"input {name}")
        if column is None or name not in guards:
            continue
        still = np.concatenate(([0], (column == 0.0).astype(int), [0]))
        edges = np.flatnonzero(np.diff(still))
        first, last = edges[::2], edges[1::2] - 1
        if len(first) and (longest := int(np.argmax(last - first))) >= 0:
            a, b = int(first[longest]), int(last[longest])
            if b - a >= REMARK.resting:
                found.append(
                    f"the input {name} is exactly zero from {read.t[a]:g} to {read.t[b]:g} s: "
                    f"there '{guards[name]}' keeps one side, as if it moved; cut such stretches "
                    "off (from:), or do not count them (burn_in:)"
                )
    return found


def _on_span(
    model: Model, series: Series, read: Record, values: Mapping[str, float], zero: float
) -> list[str]:
    begin, end = (float(evaluate(side, values)) for side in model.flat.span)
    first, last = (float(t) - zero for t in (read.t[0], read.t[-1]))
    found = []
    if model.diagram.span is None and not begin <= first <= last <= end:
        found.append(
            f"the diagram says no span, so that a run takes {begin:g} to {end:g} s, and the record "
            f"is from {first:g} to {last:g} s: write span: [{first:g}, {last:g}]"
        )
    elif last - first > REMARK.much_longer * (end - begin) and series.time.every is None:
        found.append(
            f"the record is {last - first:g} s long, and the diagram's span {end - begin:g} s: "
            "is the time in ms? Then say time: {column: ..., unit: ms}"
        )
    formulas = [*model.flat.signals.values(), *(state.rate for state in model.flat.states)]
    timed = any("t" in names_of(formula) for formula in formulas)
    far = abs(first - begin) > REMARK.far * max(last - first, end - begin)
    if far and (timed or first > REMARK.epoch):
        found.append(
            f"the first sample is at t = {first:.6g} s, far from the begin of the diagram at "
            f"{begin:g} s: say which time is t = 0, as in time: {{column: ..., zero: ...}}"
        )
    return found


def sigma_problem(diagram: Diagram, present: Collection[str]) -> list[str]:
    """That a fit refuses the series, of which some signals have a noise and others have none."""
    given: dict[bool, list[Channel]] = {True: [], False: []}
    for name in present:
        series = diagram.measured[name]
        if "train" in (series.windows or {series.use}):
            for channel in series.channels.values():
                given[channel.sigma is not None].append(channel)
    if not (given[True] and given[False]):
        return []
    first = given[False][0]
    return [
        f"{first.place}: '{first.signal}' has no `sigma:` here, and other signals have one: a fit "
        "refuses that; give every measured signal a sigma, or none"
    ]
