"""The words of a run that cannot go on: block, signal, time, values, what to try."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tracewire.array_types import Matrix, Vector
from tracewire.compile import OF_THE_PAST, Model
from tracewire.errors import Location, Problem, SimulationError
from tracewire.solve.core.arrays import Arrays, Flow, Progress
from tracewire.solve.core.codes import (
    BAD_RESET,
    BEYOND,
    CARRIED,
    CHATTER,
    CHATTER_EVENTS,
    CURRENT,
    ENDLESS,
    LENGTH,
    LOG_HEAD,
    NO_END,
    NO_MODE,
    NO_SLIDE,
    TWO_WRITES,
    UNDEFINED,
    UNDERFLOW,
    T,
)
from tracewire.solve.core.methods import ROSENBROCK

HYSTERESIS = "A guard reads what its own mode changes: use hysteresis or a block with memory."


def place_of(model: Model, name: str) -> Location:
    """The place of the block behind a signal or a state."""
    block = model.flat.blocks.get(name)
    place = block.place if block else Location()
    return Location(place.file, place.line, place.column, name)


def stopped(
    model: Model, t: float, x: Vector, what: str, hint: str, name: str = ""
) -> SimulationError:
    """The error of a run that cannot go on: time, values, block and remedy."""
    place = place_of(model, name) if name else Location()
    text = f"the run stopped at t = {t:.9g} s: {what}; {_shown_states(model, x)}"
    return SimulationError([Problem(text, place, (), hint)])


def _shown_states(model: Model, x: Vector) -> str:
    """The values of the states (n,) in words."""
    states = zip(model.states, x.tolist(), strict=True)
    return ", ".join(f"{state} = {value:.6g}" for state, value in states)


def too_long(model: Model, arrays: Arrays, what: str, hint: str) -> SimulationError:
    """The error of a run that takes more steps or more time than it may: it names the state."""
    progress, name = arrays.progress, strictest(model, arrays)
    why = f", the smallest because of '{name}'" if name else ""
    return stopped(model, float(progress.now[T]), progress.x, what + why, hint, name)


def too_many_events(model: Model, rows: Matrix, limit: int) -> SimulationError:
    """The error of a log (events, LOG_HEAD + 2n) with more than `limit` events."""
    counts = np.bincount(rows[: limit + 1, 2].astype(np.int64), minlength=len(model.modes))
    often, last = int(np.argmax(counts)), rows[limit]
    mode = model.modes[often]
    what = (
        f"more than {limit} events, {counts[often]} of them where the guard '{mode.text}' crosses"
    )
    hint = "Give the block hysteresis, shorten the span, or raise the limit."
    n = len(model.states)
    after = last[LOG_HEAD + n : LOG_HEAD + 2 * n]
    return stopped(model, float(last[0]), after, what, hint, mode.signal)


def failure(model: Model, arrays: Arrays, status: int) -> SimulationError:
    """The error behind a status of the core."""
    progress = arrays.progress
    t, x = float(progress.now[T]), progress.x
    if status in (UNDERFLOW, UNDEFINED):
        return _no_step(model, arrays, status)
    info, which = progress.info, progress.which
    if status in (BAD_RESET, TWO_WRITES):
        return _bad_write(model, progress, status)
    guards = [int(i) for i in which[1 : 1 + which[0]]]
    if status == CHATTER:
        return _chatter(model, progress, guards[0])
    if status == CARRIED:
        return _carried(model, progress)
    if status == ENDLESS:
        return _endless(model, float(info[0]), (model.modes[guards[0]].signal,))
    if status == NO_END:
        mode = model.modes[guards[0]]
        what = f"the impacts of '{mode.text}' and its neighbours do not come to an end"
        return stopped(model, t, x, what, "Give one of them a restitution below 1.", mode.signal)
    words = {NO_MODE: "no consistent mode", NO_SLIDE: "no unique slide: modes multiply each other"}
    return _no_mode(model, float(info[0]), guards, words.get(status, ""))


def _no_mode(model: Model, t: float, guards: Sequence[int], what: str) -> SimulationError:
    modes = [model.modes[i] for i in guards]
    if any(mode.jumps for mode in modes):
        return _endless(model, t, tuple(dict.fromkeys(mode.signal for mode in modes)))
    if any(mode.kind == "memory" for mode in modes):
        names = ", ".join(f"'{mode.signal}'" for mode in modes)
        text = f"the transitions of {names} at t = {t:.9g} s lead back to where they began"
        hint = "Let the condition that leaves a mode be false where the mode is entered."
    elif what:
        texts = ", ".join(f"'{mode.text}' in {mode.signal}" for mode in modes)
        text, hint = f"{what} at t = {t:.9g} s for the guards {texts}", HYSTERESIS
    else:
        texts = ", ".join(f"'{mode.text}' in {mode.signal}" for mode in modes)
        text = f"no consistent mode at t = {t:.9g} s: {texts} changes with its own mode"
        hint = "A guard reads a signal that jumps with its mode: use hysteresis."
    place = place_of(model, modes[0].signal) if modes else Location()
    return SimulationError([Problem(text, place, (), hint)])


def _endless(model: Model, t: float, names: Sequence[str]) -> SimulationError:
    """Events whose guards jump, and that set each other off at one instant."""
    shown = ", ".join(f"'{name}'" for name in names)
    what = f"the events {shown} fire" if len(names) > 1 else f"the event {shown} fires"
    text = f"{what} again and again at t = {t:.9g} s"
    events = {event.block or event.name: event for event in model.flat.events}
    place = events[names[0]].place if names[0] in events else place_of(model, names[0])
    hint = "Let what they set not carry their guards back over zero, or give one 'crosses: up'."
    return SimulationError([Problem(text, place, (), hint)])


def _bad_write(model: Model, progress: Progress, status: int) -> SimulationError:
    t, value, other = (float(v) for v in progress.info[:3])
    state, reset, before = (int(v) for v in progress.which[:3])
    resets, which = model.lowered.resets, model.states[state]
    name = resets[reset].name
    if status == BAD_RESET:
        what = f"{name} sets '{which}' to {value}"
        return stopped(model, t, progress.x, what, "Correct its formula.", which)
    what = (
        f"two resets write '{which}' at t = {t:.9g} s: "
        f"{resets[before].name} gives {other:.6g}, {name} gives {value:.6g}"
    )
    place = place_of(model, which)
    return SimulationError([Problem(what, place, (), "Merge the two events.")])


def _carried(model: Model, progress: Progress) -> SimulationError:
    """A jump that carries a body over its stop."""
    t, before, after = (float(v) for v in progress.info[:3])
    reset, guard = (int(v) for v in progress.which[:2])
    mode, event = model.modes[guard], model.lowered.resets[reset].name
    what = (
        f"a jump carries '{mode.text}' from {before:.6g} to {after:.6g}, "
        f"over the contact of {event}"
    )
    hint = "Let no event set a position beyond a contact."
    return stopped(model, t, progress.x, what, hint, mode.signal)


def starts_beyond(model: Model, progress: Progress, start: Vector, t: float) -> SimulationError:
    """A run whose start (n,) at the time t lies beyond a contact, which no impact could reach."""
    reset = model.lowered.resets[int(np.argmax(progress.overlooked == BEYOND))]
    mode = model.modes[reset.trigger]
    what = (
        f"the start at t = {t:g} s lies beyond the contact of {reset.name}, where '{mode.text}' "
        f"has crossed zero; {_shown_states(model, start)}"
    )
    hint = "Start on the side where the body can be."
    return SimulationError([Problem(what, reset.place, (), hint)])


def _chatter(model: Model, progress: Progress, guard: int) -> SimulationError:
    t, within = (float(v) for v in progress.info[:2])
    mode = model.modes[guard]
    what = (
        f"the guard '{mode.text}' changed its mode again and again: "
        f"{CHATTER_EVENTS} events within {within:.3g} s"
    )
    hint = "Give the block hysteresis or a stick level, or let the contact lose its energy."
    return stopped(model, t, progress.x, what, hint, mode.signal)


def _no_step(model: Model, arrays: Arrays, status: int) -> SimulationError:
    """A step that became too small: not finite, or an error that stays large."""
    flow, progress, trial = arrays.flow, arrays.progress, arrays.trial
    t, x = float(progress.now[T]), progress.x
    if status == UNDEFINED:
        name, value = not_finite(model, flow, t, x)
        if not name:
            end = float(trial.ends[0] + trial.ends[1])
            name, value = not_finite(model, flow, end, trial.x_end)
        what = f"'{name}' is not finite ({value})" if name else "the rates are not finite"
        hint = "Look for a division by zero, the root of a negative number, or a run-away."
        hint = hint_of_loop(model, name) or hint
        return stopped(model, t, x, what, hint, name)
    name = strictest(model, arrays)
    smallest = max(1e-15 * progress.now[LENGTH], 16 * float(np.spacing(abs(t))))
    what = f"the step became smaller than {smallest:.3g} s because of '{name}'"
    hint = "The state may run away, or jump without a guard"
    other = "" if progress.ints[CURRENT] == ROSENBROCK else "; try the method 'rosenbrock'"
    hint = f"{hint}{other}."
    return stopped(model, t, x, what, hint, name)


def hint_of_loop(model: Model, name: str) -> str:
    """What to do about a signal that is not finite where it is in an algebraic loop; '' elsewhere.

    Newton's method divides by 1 less the gain round the loop.
    """
    for loop in model.flat.loops:
        if name in loop.names:
            return (
                f"It is in the algebraic loop {loop.text}, of which no solution was found there, "
                "as where the gain round it is 1: change that, give a `guess:` near a solution, or "
                "break the loop with a state, such as an integrator."
            )
    return ""


def strictest(model: Model, arrays: Arrays) -> str:
    """The state whose error is the largest in the last trial step; "" where no error is known."""
    progress, trial = arrays.progress, arrays.trial
    scale = progress.atol + np.maximum(np.abs(progress.x), np.abs(trial.x_end))
    part = np.abs(trial.error) / scale
    known = np.isfinite(part) & (part > 0)
    return model.states[int(np.argmax(np.where(known, part, 0.0)))] if known.any() else ""


def not_finite(model: Model, flow: Flow, t: float, x: Vector) -> tuple[str, float]:
    """The first signal that is not finite, in the order in which they are computed."""
    for name, value in zip(model.states, x.tolist(), strict=True):
        if not math.isfinite(value):
            return name, value
    given = len(model.parameters) + OF_THE_PAST * bool(model.lowered.delays)
    arrays = (x, flow.m, flow.c[:given], flow.k)
    names, values = model.all_signals(t, *(array.tolist() for array in arrays))
    for name, value in zip(names, values, strict=True):
        if not math.isfinite(value):
            return name, value
    return "", math.nan
