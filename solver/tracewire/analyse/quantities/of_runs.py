"""Functions of quantities that are numbers of a run: of its signals, conditions and events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import special

from tracewire.analyse.growth import growth_rate
from tracewire.analyse.limits import QUANTITY
from tracewire.analyse.quantities.evaluate import At, Value, full_name, of_states, other_of
from tracewire.analyse.signal import floor_of
from tracewire.analyse.spectra import spectrum
from tracewire.analyse.waves import rises
from tracewire.array_types import Vector
from tracewire.diagram import EVENT_KINDS, is_quantity
from tracewire.errors import AnalysisError, OptionError, Problem
from tracewire.formula import CONSTANTS, Call, Expression, is_condition, names_of, to_text
from tracewire.solve import Event, Run


def of_signal(reduce: Callable[[Vector, Vector], float]) -> Callable[[At, Call], Value]:
    """A function of the times and the values of a signal, at samples or at events."""

    def find(at: At, node: Call) -> float:
        t, values = _along(at, node.arguments[0])
        return reduce(t, values)

    return find


def _along(at: At, node: Expression) -> tuple[Vector, Vector]:
    """The times and values of a signal at the samples; of what is told of events, at these.

    Raises AnalysisError where a value is not finite, or there is no such event.
    """
    found = np.asarray(at.along.value(node), dtype=float)
    events = _events_in(node)
    times = at.subject.t
    if events is not None:
        times = np.array([event.time for event in _events(at, events)])
        if not len(times):
            raise AnalysisError([Problem(f"there is no event '{to_text(events)}'")])
    if not np.isfinite(found).all():
        raise AnalysisError([Problem(f"'{to_text(node)}' is not finite at each sample")])
    return times, np.broadcast_to(found, times.shape)


def _events_in(node: Expression) -> Expression | None:
    """The event of which a formula has `before` or `after`."""
    if not isinstance(node, Call):
        return None
    if node.function in ("before", "after"):
        return node.arguments[0]
    if is_quantity(node):
        return None
    return next((e for a in node.arguments if (e := _events_in(a)) is not None), None)


def _mean(t: Vector, v: Vector) -> float:
    return float(np.trapezoid(v, t) / (t[-1] - t[0]))


def _rms(t: Vector, v: Vector) -> float:
    return float(np.sqrt(np.trapezoid(v * v, t) / (t[-1] - t[0])))


def _at(at: At, node: Call) -> Value:
    signal, time = node.arguments
    wanted = at.value(time)
    times = np.atleast_1d(np.asarray(wanted, dtype=float))
    order = np.unique(times)
    found = np.broadcast_to(replace(at, times=order, state=None).value(signal), order.shape)
    values = found[np.searchsorted(order, times)]
    return values if np.ndim(wanted) else float(values[0])


def _drift(at: At, node: Call) -> float:
    _, values = _along(at, node.arguments[0])
    first = float(values[0])
    scale = at.along.number(node.arguments[1]) if len(node.arguments) > 1 else abs(first)
    off = float(np.max(np.abs(values - first)))
    if not scale > 0 and off:
        what = f"'{to_text(node.arguments[0])}' begins at 0: its drift needs a scale"
        raise AnalysisError([Problem(what, hint="Write drift(x, max(abs(y))).")])
    return off / scale if off else 0.0


def _period(at: At, node: Call) -> float:
    run, name, since = _from_begin(at, node.arguments[0])
    counts = run.t >= since
    found = rises(run.t[counts], run[name][counts], floor_of(run, name)[counts])
    whole = np.diff(found)
    whole = whole[np.isfinite(whole)]
    if len(whole) < QUANTITY.fewest_waves:
        what = f"'{name}' rises through the middle of its wave {np.isfinite(found).sum()} times"
        raise AnalysisError([Problem(what, hint="A period needs two: take a longer time.")])
    return float(whole.mean())


def _as_run(at: At, node: Expression) -> tuple[Run, str]:
    """A run whose only signal is a formula, for what works on runs."""
    t, values = _along(at, node)
    name = to_text(node)
    return replace(at.subject.run, t=t, signals={name: values}), name


def _from_begin(at: At, node: Expression) -> tuple[Run, str, float]:
    """The same from the begin of the run on, as what it resolves follows from all that was before;
    and since when samples count."""
    run, name = _as_run(at, node)
    since, early = float(run.t[0]), at.subject.early
    if _events_in(node) is None and len(early):
        before = np.asarray(replace(at, times=early, state=None).value(node), dtype=float)
        values = np.concatenate([np.broadcast_to(before, early.shape), run[name]])
        run = replace(run, t=np.concatenate([early, run.t]), signals={name: values})
    return run, name, since


def _growth(at: At, node: Call) -> float:
    run, name, since = _from_begin(at, node.arguments[0])
    return growth_rate(run, name, since=since).rate


def _line(at: At, node: Call) -> float:
    signal, n, count = node.arguments
    most = at.whole(count, QUANTITY.most_lines, "number of lines") + 1
    found = spectrum(*_as_run(at, signal), lines=most).lines
    return sorted(line.frequency for line in found)[at.whole(n, len(found), "line")]


def _cosine(at: At, node: Call) -> float:
    t, values = _along(at, node.arguments[0])
    rates = [at.number(argument) for argument in node.arguments[1:]]
    if not np.isfinite(rates).all():
        raise AnalysisError([Problem("an angular frequency of cosine(...) is not finite")])
    waves = [wave(w * t) for w in rates for wave in (np.cos, np.sin)]
    return float(np.linalg.lstsq(np.array(waves).T, values, rcond=None)[0][0])


# conditions and events


def _condition(at: At, node: Expression) -> NDArray[np.bool_]:
    return np.broadcast_to(np.asarray(at.along.value(node), dtype=bool), at.subject.t.shape)


def _becomes_true(at: At, node: Expression) -> Vector:
    """The times of the samples at which a condition becomes true; the first one is none."""
    true = _condition(at, node)
    return at.subject.t[1:][true[1:] & ~true[:-1]]


def _events(at: At, node: Expression) -> list[Event]:
    """The events of a kind, else of a block, else of a guard."""
    text = to_text(node)
    there = _all_events(at)
    if text in EVENT_KINDS:
        return [event for event in there if event.kind == text]
    return [e for e in there if e.block == text] or [e for e in there if e.guard == text]


def _all_events(at: At) -> list[Event]:
    """The events from when samples count to the end; a run that is read later goes on."""
    since, (_, end) = at.subject.conditions.since, at.subject.span
    first = -np.inf if since is None else since
    return [event for event in at.subject.run.events if first <= event.time <= end]


def _count(at: At, node: Call) -> float:
    if not node.arguments:
        return float(len(_all_events(at)))
    (what,) = node.arguments
    return float(len(_becomes_true(at, what) if is_condition(what) else _events(at, what)))


def _time(at: At, node: Call) -> float:
    what, *number = node.arguments
    if is_condition(what):
        times = _becomes_true(at, what).tolist()
        told = f"time at which '{to_text(what)}' becomes true, number"
    else:
        times = [event.time for event in _events(at, what)]
        told = f"event '{to_text(what)}' number"
    return float(times[at.whole(number[0], len(times), told) if number else _first(times, told)])


def _first(times: list[float], told: str) -> int:
    if not times:
        raise AnalysisError([Problem(f"there is no {told} 1: there are 0")])
    return 0


def _during(at: At, node: Call) -> Vector:
    """1 between an event of the first kind and one of the second; before the first of all, where
    the first of all is of the second kind."""
    begins, ends = ([e.time for e in _events(at, a)] for a in node.arguments)
    if ends and (not begins or ends[0] < begins[0]):
        begins = [-np.inf, *begins]
    found = np.zeros(at.t.shape)
    for begin in begins:
        end = next((time for time in ends if time > begin), np.inf)
        found[(at.t > begin) & (at.t < end)] = 1.0
    return found


def _beside_events(after: bool) -> Callable[[At, Call], Vector]:
    def find(at: At, node: Call) -> Vector:
        event, formula = node.arguments
        there = _events(at, event)
        states = [e.after if after else e.before for e in there]
        names = states[0] if states else {}
        state = {name: np.array([x[name] for x in states]) for name in names}
        times = np.array([e.time for e in there])
        inside = replace(at.along, times=times, state=state)
        if not after and (other := _other_signals(inside, formula, state)):
            what = f"before an event only states are known, and '{other}' is none"
            hint = "Write it as a formula of states, or after(...) of what stays."
            raise OptionError([Problem(what, hint=hint)])
        return np.broadcast_to(np.asarray(inside.value(formula), dtype=float), times.shape)

    return find


def _other_signals(at: At, node: Expression, state: dict[str, Vector]) -> str:
    """A signal in a formula that is no formula of states."""
    for name in names_of(node):
        if name in CONSTANTS or name == "t" or name in at.subject.parameters:
            continue
        full = full_name(at.subject.model, name)
        if state and full not in state and of_states(at.subject.model, full) is None:
            return name
    return ""


def _reference(at: At, node: Call) -> Value:
    return other_of(at).value(node.arguments[0])


def _special(function: Callable[..., Value]) -> Callable[[At, Call], Value]:
    return lambda at, node: function(*(at.value(argument) for argument in node.arguments))


OF_RUNS: dict[str, Callable[[At, Call], Value]] = {
    "end": of_signal(lambda t, v: float(v[-1])),
    "max": of_signal(lambda t, v: float(v.max())),
    "min": of_signal(lambda t, v: float(v.min())),
    "range": of_signal(lambda t, v: float(np.ptp(v))),
    "amplitude": of_signal(lambda t, v: float(np.ptp(v)) / 2),
    "mean": of_signal(_mean),
    "rms": of_signal(_rms),
    "std": of_signal(lambda t, v: float(np.std(v))),
    "integral": of_signal(lambda t, v: float(np.trapezoid(v, t))),
    "at": _at,
    "drift": _drift,
    "period": _period,
    "frequency": lambda at, node: 1.0 / _period(at, node),
    "growth_rate": _growth,
    "line": _line,
    "cosine": _cosine,
    "fraction": lambda at, node: float(np.mean(_condition(at, node.arguments[0]))),
    "count": _count,
    "time": _time,
    "during": _during,
    "before": _beside_events(after=False),
    "after": _beside_events(after=True),
    "reference": _reference,
    "bessel_j": _special(special.jv),
    "bessel_y": _special(special.yv),
    "elliptic_k": _special(special.ellipk),
    "mathieu_a": _special(special.mathieu_a),
    "mathieu_b": _special(special.mathieu_b),
}
