"""The arrays of a run: Python makes them, the core finds them by a table of addresses.

A function of the core is given the address of the table, and takes from it what it needs: the
arrays themselves, as arguments of every function, would make both the compiler and the calls slow.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from tracewire.solve.core.memory import floats_at, ints_at
from tracewire.solve.core.units import helper, reader

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Ints = NDArray[np.int64]
IntMatrix = NDArray[np.int64]


class Flow(NamedTuple):
    """The field of a model for one set of parameters, and the discrete state of a run.

    `address`: of the model's functions, in the order of FUNCTIONS. `m`: the modes (M,) and behind
    them, per mode, 1 while its guard is held at zero. `c`, `k`: constants and tables. `weights`: of
    the states in straight guards, term by term. `bound`: FREE, SLIDING or
    RESTING per mode. `push` (M, n): how the force of a contact acts on the rates. `grip`, per mode
    that slides: how the rate of its guard changes with the mode, where `held` was asked last.
    `counts`: evaluations, and how many guards slide and rest.
    """

    address: Ints
    m: Vector
    c: Vector
    k: Vector
    weights: Vector
    bound: Ints
    push: Matrix
    grip: Vector
    counts: Ints


class Plan(NamedTuple):
    """The modes, resets and transitions of a model.

    Per mode: `kind`, `at_zero`, `compares`, `can_hold`, `table`, `is_timed`; `timed` lists the
    timed modes.
    `resets` has rows (trigger mode, direction, first write, number of writes, event kind);
    `writes` the states that they set. `transitions` has rows (memory mode, source, trigger mode,
    target, reset, level of the trigger, at_zero). `direct` is, per
    recorded signal, the state that it is, or -1. `loop` is, per mode, the algebraic loop through
    it, or -1. `straight` is, per mode, 1 where its guard is a sum of states times what no run
    changes; `first_term` (M + 1,) is where its terms begin, whose states are in `term_state`.
    """

    kind: Ints
    at_zero: Ints
    compares: Ints
    can_hold: Ints
    table: Ints
    is_timed: Ints
    timed: Ints
    resets: IntMatrix
    writes: Ints
    transitions: IntMatrix
    direct: Ints
    loop: Ints
    straight: Ints
    first_term: Ints
    term_state: Ints


class Progress(NamedTuple):
    """How far a run is: time and step, states, counters, samples, log, and what an error says.

    `stiff` holds the mode combinations that were found stiff. `recent` holds (time, mode) of the
    last events. `flights` holds, per mode, the last flight of its contact (inf: none) and whether
    it was too short to be resolved. `info` and `which` say what an error is about. `overlooked`
    marks the resets whose guard is zero at the start and leaves it as if they fired (ON_GUARD), and
    the impacts whose guard is beyond zero there (BEYOND). `given` are the absolute tolerances that
    the user gave, 0 where `atol` follows from `largest`, what was seen of each state. `sizes` (2n,)
    is work space, and behind it of what size each state has been of late, at least `least`: one
    that passes through zero has the rounding errors of its size. `undetermined` (M,): since when
    the guard of a mode has rested at zero where nothing decides the mode although the rates differ
    with it; inf: never. `beyond` (n,) is what leads to the far side of a guard that is to cross,
    where the rates are not defined beyond it; 0 elsewhere.
    """

    now: Vector
    x: Vector
    atol: Vector
    ints: Ints
    times: Vector
    samples: Matrix
    log: Matrix
    stiff: Matrix
    recent: Matrix
    flights: Matrix
    info: Vector
    which: Ints
    overlooked: Ints
    given: Vector
    largest: Vector
    least: Vector
    sizes: Vector
    undetermined: Vector
    beyond: Vector


class Trial(NamedTuple):
    """A trial step from x over h: x_end and the rate there (n,), the error (n,), the dense output.

    `ends` holds t, h and h times the largest eigenvalue (0 where the method does not say);
    `stages` (16, n), `matrix` (n, n + 1), `factors` (n, n), `pivots` (n,), `at` (n,) and `guards`
    (M,) and `paces` (2,) are work space; `rate` (n,) is the rate where the step begins.
    """

    ends: Vector
    x: Vector
    x_end: Vector
    rate_end: Vector
    error: Vector
    inner: Matrix
    stages: Matrix
    matrix: Matrix
    factors: Matrix
    pivots: Ints
    rate: Vector
    at: Vector
    guards: Vector
    paces: Vector


class Watch(NamedTuple):
    """The margins to watch while one mode combination lasts: sign*(guard - level), positive.

    Of a fraction on a slide the margin is the distance to 0 or 1, of a contact its force. `to` is
    the mode beyond. A margin is `armed` once it has been positive: only then may it cross. `rows`
    (samples, margins) holds the margins over a step, `start` those where it begins, `found` where
    in the step they cross, `hit` which of them do. `grip`, per mode: that of a slide as it began.
    """

    mode: Ints
    kind: Ints
    to: Vector
    level: Vector
    sign: Vector
    armed: Ints
    rows: Matrix
    start: Vector
    found: Vector
    hit: Ints
    grip: Vector


class Crossings(NamedTuple):
    """What reached a level at an instant, per mode: `how` (-1: nothing), `to`, `up`.

    `how` is one of GUARD to WAITS (`codes`): a guard, the fraction of a slide, the force of a
    contact, a known time and so on; `to` is the mode beyond, `up` 1 where the guard went up.

    An instant has stages, each of which ends where all modes stand still and something writes
    states anew. `x` (n,), `m` and `bound`: how the last stage began; `known` (1,): 1 where it has
    begun. `due`, per reset: 1 where the writes of a stage have carried its guard over zero,
    CROSSED where the guard has crossed on its own in this stage, ARRIVED where in an earlier one.
    """

    how: Ints
    to: Vector
    up: Ints
    x: Vector
    m: Vector
    bound: Ints
    due: Ints
    known: Ints


class Sensitivity(NamedTuple):
    """How the states change with q numbers; q = 0: nobody asks.

    `address`: of the derivatives of the model's functions in the states, t and a parameters, w in
    all, in the order of DERIVATIVES. `chain` (a, q): of these parameters in the numbers. `s`
    (n, q): of the states at the time in `now`, but inside of an event the change of the states at
    the event, which moves by `moved` (q,) with it. `peak` (n, q): the largest values so far.
    `filled` (a, 2): where in each row of `chain` the numbers begin and end that are not zero;
    `reads` (n, 2): which parameters the rate of a state may read, unless something is held.
    `nodes` (4n, w): derivatives of the rates where the interval begins and at its nodes, `slopes`
    (4n, q): S' there, `change` (n, q): of S over the interval, `between` (n, q): S inside of it.
    `samples` (N, R*q), `times` (rows of the log, q). `push` (M, n*a): of the push of a contact in
    the parameters. `flags` and `flag_times`: per kind of FLAGS how often, the mode and the time of
    the first. `now` holds that time, the next interval, whether the first nodes are known, whether
    only tables of t go on to their next points, how long an interval may be inside of which S is
    known, too, the end and the length of one that is not yet taken (0: none is), the tolerance of
    the estimate, the error inside and its tolerance, and whether the first slopes are known.
    `instants` (M, q): how the instant moves at which each mode changes, of those that do so now.
    `bound` (M,): what was held after the last event. `steps`: what `trial` has of those that S has
    not followed yet, and the `methods` that made them; `kept`: how many, which one is in `trial`,
    and the first sample in them. `right`, `parts` (3n, q; at least three rows), `system` (3n, 3n),
    `pivots` (3n,), `order` (n + 2,), `weights`, `picks` and `at` (n,) are work space.
    """

    address: Ints
    chain: Matrix
    filled: IntMatrix
    reads: IntMatrix
    s: Matrix
    moved: Vector
    peak: Matrix
    nodes: Matrix
    samples: Matrix
    times: Matrix
    push: Matrix
    flags: IntMatrix
    flag_times: Vector
    now: Vector
    instants: Matrix
    bound: Ints
    change: Matrix
    slopes: Matrix
    between: Matrix
    right: Matrix
    parts: Matrix
    system: Matrix
    pivots: Ints
    order: Ints
    weights: Vector
    picks: Ints
    at: Vector
    steps: Matrix
    methods: Ints
    kept: Ints


class Spans(NamedTuple):
    """Runs of one model over many spans, each from a start of its own, one after the other.

    `at`: the number of the span, 1 while it has begun and not ended, the steps before a pause, the
    events that a span may have, the mode combinations that were found stiff. `ends` (W, 2): begin
    and end of each. `rows` (W + 1,): where its samples begin in `times` (M,), `samples` (M, R) and
    `answers` (M, R*q). `x` (W, n) and `s` (W, n*q): its start, and how that moves; `floor` (n, q)
    the least `peak`. `follows` (W,): 1 where the states that are 1 in `kept` (n,) go on from the
    span before, and with them how they move, but for columns that are 0 in `lasting` (q,), which
    stand for the start of that span. `final` (W, n), `final_s` (W, n*q) and `steps` (W,): the
    states at its end, how these move, and what it took.
    `first` is what `block` holds, which is all that a run changes, before it.
    """

    at: Ints
    ends: Matrix
    rows: Ints
    x: Matrix
    s: Matrix
    floor: Matrix
    follows: Ints
    kept: Ints
    lasting: Ints
    times: Vector
    samples: Matrix
    answers: Matrix
    final: Matrix
    final_s: Matrix
    steps: Ints
    block: Vector
    first: Vector


class History(NamedTuple):
    """What D delayed signals were, as pieces of polynomials; D = 0 where nothing is delayed.

    Per delay, `mode` is its mode; `order` (M + n, D): by how many orders the jump of a mode or a
    state is smoother in its signal; `seen` 1 where a guard reads it, so that steps follow its
    pieces; `size` the largest value so far; `points` (D, B) the times at which its signal has
    jumped, `ranks` (D, B) in which derivative, `shifts` (D, B*q) how the times move. `lag` (2D,):
    the delays at the time of the last question, and the longest; `node_lags` (4, D) at the nodes of
    sensitivities. `counts` (D, 2): how many points there are and how many were dropped; `along`:
    how many pieces of sensitivities, and their next node in this step. `pieces` are rows as
    `compile/past.py` tells; `moves` likewise of how the signals move: begin, middle, 2/length, the
    stretches, and of each signal and number 5 coefficients. `first` is the place of the address in
    the constants. `at` (9, max(D, D*q)) and `rows` (D, w) are work space.
    """

    mode: Ints
    order: IntMatrix
    seen: Ints
    lag: Vector
    size: Vector
    points: Matrix
    ranks: IntMatrix
    shifts: Matrix
    counts: IntMatrix
    along: Ints
    pieces: Matrix
    moves: Matrix
    first: Ints
    at: Matrix
    rows: Matrix
    node_lags: Matrix


class Arrays(NamedTuple):
    """All arrays of a run."""

    flow: Flow
    plan: Plan
    progress: Progress
    trial: Trial
    watch: Watch
    crossings: Crossings
    sensitivity: Sensitivity
    history: History


def table_of(groups: Arrays | Sequence[Spans]) -> Ints:
    """Address, rows and columns of each array, in the order of the classes and their fields."""
    rows = [
        (array.__array_interface__["data"][0], *array.shape, 1)[:3]
        for group in cast(Sequence[Sequence[NDArray[Any]]], groups)
        for array in group
    ]
    return np.array(rows, dtype=np.int64).ravel()


@helper
def copy(values: Vector, to: Vector) -> None:
    """Let `to` have these values: an assignment of arrays looks at their shapes, which is slow."""
    for i in range(len(values)):
        to[i] = values[i]


def _first_places() -> dict[type, int]:
    """The place of the first array of each group in its table; spans have a table of their own."""
    places: dict[type, int] = {Spans: 0}
    place = 0
    for group in (Flow, Plan, Progress, Trial, Watch, Crossings, Sensitivity, History):
        places[group] = place
        place += len(group._fields)
    return places


FIRST = _first_places()


def kinds_of(group: Any) -> dict[str, str]:
    """The names of the arrays of a group, and of each its kind: Vector, Matrix, Ints, IntMatrix."""
    return {name: hint.__forward_arg__ for name, hint in group.__annotations__.items()}


def _read(group: Any, address: int) -> Any:
    """The arrays of a group, by the address of the table."""
    kinds, place = kinds_of(group), FIRST[group]
    table = ints_at(address, (place + len(kinds), 3))
    found = []
    for hint, (data, rows, columns) in zip(kinds.values(), table[place:], strict=True):
        shape = (rows, columns) if hint.endswith("Matrix") else (rows,)
        found.append((ints_at if hint.startswith("Int") else floats_at)(data, shape))
    return group(*found)


@reader
def flow_of(core: int) -> Flow:
    """The field of a run."""
    return cast(Flow, _read(Flow, core))


@reader
def plan_of(core: int) -> Plan:
    """The modes, resets and transitions."""
    return cast(Plan, _read(Plan, core))


@reader
def progress_of(core: int) -> Progress:
    """How far the run is."""
    return cast(Progress, _read(Progress, core))


@reader
def trial_of(core: int) -> Trial:
    """The trial step."""
    return cast(Trial, _read(Trial, core))


@reader
def watch_of(core: int) -> Watch:
    """What is watched."""
    return cast(Watch, _read(Watch, core))


@reader
def crossings_of(core: int) -> Crossings:
    """What happens now."""
    return cast(Crossings, _read(Crossings, core))


@reader
def sensitivity_of(core: int) -> Sensitivity:
    """How the states change with what was asked for."""
    return cast(Sensitivity, _read(Sensitivity, core))


@reader
def history_of(core: int) -> History:
    """What the delayed signals were."""
    return cast(History, _read(History, core))


@reader
def spans_of(spans: int) -> Spans:
    """The spans."""
    return cast(Spans, _read(Spans, spans))


@helper
def is_sensitive(core: int) -> bool:
    """Whether sensitivities are asked for."""
    return len(sensitivity_of(core).moved) > 0
