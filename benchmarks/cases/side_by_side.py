"""One problem, all peers: matched in accuracy, timed in turn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from benchmarks.accuracy import Match, Reference, error_of, match, timed
from benchmarks.measure import Entrant, in_turn
from benchmarks.options import Options
from benchmarks.peers.native import Native
from benchmarks.peers.pathsim_peer import PathSim
from benchmarks.peers.peer import Peer, Problem, Solve
from benchmarks.peers.scilab import Scilab
from benchmarks.peers.scipy_peer import Scipy
from benchmarks.peers.sundae import Sundae
from benchmarks.peers.tracewire_peer import Tracewire
from benchmarks.table import Promise, Result, ratio, seconds

PEERS: tuple[Peer, ...] = (
    Native(),
    Native(name="C, leaner", source="lean.c", case="torsion.h"),
    Native("BDF"),
    Native("Adams"),
    Sundae("BDF"),
    Sundae("Adams"),
    Scipy("LSODA"),
    Scipy("RK45"),
    Scipy("DOP853"),
    Scipy("Radau"),
    PathSim(),
    Scilab(),
)
SLOW = ("scipy Radau", "PathSim", "Scilab ode()")
COLUMNS = ("solver", "rtol", "error", "steps", "time", "/ tracewire", "")


def compare(
    problem: Problem,
    reference: Reference,
    options: Options,
    promised: dict[str, tuple[float, bool]],
    remarks: Sequence[str] = (),
) -> Result:
    """The table of one problem.

    `promised`: for peers by name the ratio peer/tracewire that is promised as the least; where the
    flag is set it is tracewire/peer, as the most.
    """
    own = Tracewire()
    solve = own.prepare(problem)
    _, first = timed(solve, options.rtol)
    answer, once = timed(solve, options.rtol)
    target = error_of(answer, problem, reference)
    found: dict[str, Match] = {}
    found[own.name] = Match(options.rtol, target, once, True, steps=answer.steps)
    solves: dict[str, Solve] = {own.name: solve}
    inner = Tracewire(alone=True)
    solves[inner.name] = inner.prepare(problem)
    timed(solves[inner.name], options.rtol)
    found[inner.name] = replace(found[own.name], seconds=timed(solves[inner.name], options.rtol)[1])
    absent = {}
    for peer in PEERS:
        absent[peer.name] = peer.missing(problem)
        if options.quick and peer.name in SLOW:
            absent[peer.name] = absent[peer.name] or "left out by --quick"
        if not absent[peer.name]:
            solves[peer.name] = peer.prepare(problem)
            found[peer.name] = match(
                solves[peer.name],
                problem,
                reference,
                target,
                options.rtol,
                options.search_seconds,
            )
    entrants = {
        name: Entrant(name, _run(solves[name], at.rtol), [at.seconds])
        for name, at in found.items()
        if not at.why
    }
    in_turn(list(entrants.values()), options.seconds_each)
    base = entrants[own.name].seconds
    rows = []
    for name in (own.name, inner.name, *absent):
        if absent.get(name):
            rows.append((name, *[""] * 5, absent[name]))
        elif name not in entrants:
            rows.append((name, *[""] * 5, found[name].why))
        else:
            at, took = found[name], entrants[name].seconds
            note = "" if at.equal else "not of equal accuracy"
            steps = "" if at.steps is None else str(at.steps)
            rows.append(
                (
                    name,
                    f"{at.rtol:.1e}",
                    f"{at.error:.1e}",
                    steps,
                    seconds(took),
                    ratio(took / base),
                    note,
                )
            )
    promises = [
        Promise(
            f"{problem.title}: {name}",
            base / entrants[name].seconds if most else entrants[name].seconds / base,
            bound,
            most=most,
        )
        for name, (bound, most) in promised.items()
        # a peer that is less accurate than asked has had an advantage
        if name in entrants and (found[name].equal or (found[name].error > target and not most))
    ]
    inside = "inside: the integration alone, as run.statistics tells it"
    warm = f"the first run of tracewire took {seconds(first)} and does not count"
    return Result(problem.title, COLUMNS, rows, promises, (*remarks, inside, warm))


def _run(solve: Solve, rtol: float) -> Callable[[], float]:
    def run() -> float:
        return timed(solve, rtol)[1]

    return run
