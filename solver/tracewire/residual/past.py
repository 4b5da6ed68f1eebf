"""What delayed signals were before a run that begins within a series, as its record tells."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from tracewire.array_types import Vector
from tracewire.compile import Model, compile
from tracewire.errors import Location, OptionError, Problem
from tracewire.formula import evaluate
from tracewire.residual.inputs import between_samples, looks_held
from tracewire.residual.measured import Measured
from tracewire.residual.starts import states_from_data
from tracewire.residual.unknowns import moved_by_fit
from tracewire.solve import Driving, Span, parameter_values, simulate_spans

MEASURE = "Measure '{0}': give its column under `signals:` of the series."


def longest_delay(model: Model, measured: Measured) -> float:
    """The longest delay of a model in s, with the values of a series; 0 where there is none."""
    if not model.lowered.delays:
        return 0.0
    values = parameter_values(model, measured.parameters, measured.preset)
    return max(float(evaluate(delay.most, values)) for delay in model.lowered.delays)


def with_past(
    model: Model, measured: Measured, what: str, free: Collection[str] | None = None
) -> Measured:
    """A series with the past of all delayed signals, which runs that begin within it need.

    A signal that is measured is taken from its channel. One that only reads inputs, parameters that
    no fit changes, and states that the data tell is computed at each sample. Samples are joined as
    those of inputs are. `what` begins within the series, for the message; `free` are the parameters
    of a fit, all with bounds unless given.

    Raises OptionError with every delayed signal that the record does not tell.
    """
    given = dict(measured.past)
    texts = dict.fromkeys(delay.text for delay in model.lowered.delays)
    for text in texts.keys() & measured.values.keys() - given.keys():
        sensor = measured.sensor(text)
        seen = sensor.signal(measured.values[text], measured.t - measured.zero)
        given[text] = _join(text, measured.t - sensor.delay, seen)
    open_ = [text for text in texts if text not in given]
    if not open_:
        return replace(measured, past=given) if given else measured
    told = states_from_data(model, measured, np.arange(len(measured.t)))
    moving = moved_by_fit(model, free)
    problems = [_why_undetermined(model, text, told, moving, given, what) for text in open_]
    if refused := [problem for problem in problems if problem is not None]:
        raise OptionError(refused)
    computed = _simulate_past(model, measured, open_, told, given)
    past = {text: _join(text, measured.t, values) for text, values in computed.items()}
    return replace(measured, past={**given, **past})


def _join(name: str, t: Vector, values: Vector) -> Driving:
    return between_samples(name, t, values, "previous" if looks_held(values) else None)[0]


def _why_undetermined(
    model: Model,
    text: str,
    told: Collection[str],
    moving: Collection[str],
    given: Collection[str],
    what: str,
) -> Problem | None:
    """Why a delayed signal cannot be computed from the record; None where it can."""
    low = model.lowered
    delay = next(delay for delay in low.delays if delay.text == text)
    read = [low.tape.entries[index] for index in low.tape.needed([delay.signal])]
    parameters = list(model.flat.parameters)
    states = [model.states[int(e.payload)] for e in read if e.op == "state"]
    modes = [model.modes[int(e.payload)] for e in read if e.op in ("mode", "hold")]
    unknown = [f"the state '{name}'" for name in states if name not in told]
    unknown += [f"the memory of '{m.signal}'" for m in modes if m.kind == "memory" or m.holds]
    delays = [low.delays[int(e.payload)].text for e in read if e.op == "history"]
    unknown += [f"'{name}' with a delay" for name in delays if name not in given]
    free = [parameters[int(e.payload)] for e in read if e.op == "param"]
    free = [name for name in free if name in moving]
    name = model.modes[delay.mode].signal
    block = model.flat.blocks.get(name)
    place = replace(block.place if block else Location(), block=name)
    said = f"{what} begins within the record, which must tell what '{text}' was before"
    if unknown:
        reads = f"it reads {', '.join(dict.fromkeys(unknown))}"
        return Problem(f"{said}: {reads}", place, (), MEASURE.format(text))
    if free:
        reads = f"it reads '{free[0]}', which a fit changes"
        hint = f"{MEASURE.format(text)} Or put the delay before what reads '{free[0]}'."
        return Problem(f"{said}: {reads}", place, (), hint)
    return None


def _simulate_past(
    model: Model,
    measured: Measured,
    names: Collection[str],
    told: Mapping[str, Vector],
    given: Mapping[str, Driving],
) -> dict[str, Vector]:
    """Signals (N,) at the samples of a series, from the states that its data tell."""
    model = compile(model.diagram, record=list(names), backend="quick")
    t, ends = measured.t, np.append(measured.t[1:], 2 * measured.t[-1] - measured.t[-2])
    spans = [
        Span(float(a), float(b), t[n : n + 1], {name: float(x[n]) for name, x in told.items()})
        for n, (a, b) in enumerate(zip(t, ends, strict=True))
    ]
    unread = {d.text: (t[[0, -1]], np.zeros(2)) for d in model.lowered.delays}
    runs = simulate_spans(
        model,
        spans,
        parameters=measured.parameters,
        preset=measured.preset,
        inputs=measured.inputs,
        past={**unread, **given},
    )
    for error in runs.errors.values():
        raise error
    return {name: runs[name] for name in names}
