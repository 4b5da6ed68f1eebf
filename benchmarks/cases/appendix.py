"""The fit of paper A's appendix: one evaluation beside Xcos, and what a search costs.

Nine parameters of the double torsion pendulum, criterion mean((phi2 measured - phi2)^2)/2 on the
shipped record, tolerance 1e-6, fminsearch with MaxIter 150. Real Xcos is timed where Scilab with
Xcos is installed (`scilab-adv-cli`, and `xvfb-run` where there is no display).
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np
import tracewire as tw
from tracewire.fit import Fit, Minimum, fminsearch, optimset
from tracewire.residual import Criterion, free_unknowns, load_measured, whole_segment
from tracewire.solve import parameter_values

from benchmarks.cases.paper_a import DIAGRAM
from benchmarks.cases.sensitivities import NINE
from benchmarks.measure import least
from benchmarks.options import Options
from benchmarks.peers.native import DOUBLES, build, compiler
from benchmarks.systems.hybrid import Vector
from benchmarks.systems.torsion import Torsion
from benchmarks.table import Promise, Result, ratio, seconds

SCRIPTS = Path(__file__).parents[1] / "scilab"
ITERATIONS = 150
TITLE = "Paper A's appendix"
MOST_SECONDS, GRACE = 900.0, 3.0
ROUGH, EXACT = 1e-3, 1e-10
TELLING = ("phi2", "evaluation", "simplex")  # how a script begins the lines that tell something
Told = list[list[str]]  # these, word by word
Value = Callable[[Vector], float]


def measure(options: Options) -> Iterator[Result]:
    """One evaluation; fminsearch beside Scilab's; least squares beside fminsearch."""
    model = tw.compile(tw.read(DIAGRAM))
    criterion = criterion_of(model, options.rtol)
    own, begin = in_parameters(criterion), criterion.initial_unknowns() * criterion.scales
    (series,) = criterion.segments
    data = np.column_stack([series.t, series.measured.values["phi2"]])
    library, _ = build("../scilab/appendix.c", Torsion.file) if compiler() else (None, "")
    by_c = in_c(library, data) if library is not None else None

    xcos, why = told_by_xcos(data, options)
    yield _evaluations(model, criterion, by_c, xcos, why, options)

    simplex = fminsearch(own, begin, optimset(MaxIter=ITERATIONS, Display="off"))
    yield _searches(simplex, by_c, begin, data, library, xcos)

    found = {
        method: tw.fit(model, method=method, free=NINE, options=limit, rtol=options.rtol)
        for method, limit in (
            ("fminsearch", optimset(MaxIter=ITERATIONS, Display="off")),
            ("least_squares", None),
        )
    }
    yield _methods(simplex, found)


def criterion_of(model: tw.Model, rtol: float) -> Criterion:
    """The fit's own criterion, in the appendix's order of the nine parameters."""
    (record,) = load_measured(model)
    values = parameter_values(model, {}, record.preset)
    unknowns = free_unknowns(model, NINE, values)
    return Criterion(model, [whole_segment(model, record)], unknowns, {}, rtol)


def in_parameters(criterion: Criterion) -> Value:
    """The criterion of the parameters themselves, as Scilab's fminsearch sees it."""
    return lambda u: criterion.value(u / criterion.scales)


def in_c(library: ctypes.CDLL, data: Vector) -> Value:
    """The same in C: the very function that Scilab links."""
    library.appendix.argtypes = [DOUBLES] * 7
    library.appendix.restype = None
    phi2, constants = np.ascontiguousarray(data[:, 1]), Torsion(120.0).constants
    count, end, rtol = (np.array([float(x)]) for x in (len(data), data[-1, 0], 1e-6))

    def value(u: Vector) -> float:
        out = np.zeros(1)
        library.appendix(np.ascontiguousarray(u), constants, phi2, count, end, rtol, out)
        return float(out[0])

    return value


def _evaluations(
    model: tw.Model,
    criterion: Criterion,
    by_c: Value | None,
    xcos: Told,
    why: str,
    options: Options,
) -> Result:
    """Every row with its largest error of phi2 at the start, in rad."""
    begin = criterion.initial_unknowns() * criterion.scales
    title = f"{TITLE}: one evaluation of the criterion"
    exact = phi2_of(model, EXACT)
    rows, took = [], {}
    for rtol in (options.rtol, ROUGH):
        own = in_parameters(criterion_of(model, rtol))
        value = own(begin)  # the first does not count
        took[rtol] = least(partial(own, begin), options.seconds_each)
        error = float(np.max(np.abs(phi2_of(model, rtol) - exact)))
        name = f"tracewire, the fit's criterion, rtol {rtol:.0e}"
        rows.append(_evaluation(name, took[rtol], took[options.rtol], error, value))
    once = took[options.rtol]
    if by_c is not None:
        by_hand = least(lambda: by_c(begin), options.seconds_each)
        rows.append(_evaluation("C, same algorithm, rtol 1e-06", by_hand, once, None, by_c(begin)))
    promises, remarks = [], []
    told = [tuple(map(float, numbers)) for word, *numbers in xcos if word == "evaluation"]
    if told:
        (angles,) = (np.array(numbers, dtype=float) for word, *numbers in xcos if word == "phi2")
        error = float(np.max(np.abs(angles - exact)))
        printed = min(whole for whole, _, _ in told)
        alone = min(whole - importing for whole, importing, _ in told)
        for name, spent in (
            ("Xcos, scicos_simulate(scs_m, Context), 1e-6", alone),
            ("Xcos, as printed: with importXcosDiagram", printed),
        ):
            rows.append(_evaluation(name, spent, once, error, told[0][2]))
        what = f"{TITLE}: Xcos, one evaluation as printed"
        promises = [
            Promise(f"{what}, equal rtol", printed / once, 500.0),
            Promise(f"{what}, rtol {ROUGH:.0e}", printed / took[ROUGH], 500.0),
        ]
        middle = float(np.median([whole for whole, _, _ in told]))
        remarks.append(f"Xcos' least of {len(told)}; its median is {seconds(middle)}")
    else:
        rows.append(("Xcos", "-", "-", "-", why))
    columns = ("evaluation", "time", "/ tracewire", "error", "criterion")
    return Result(title, columns, rows, promises, remarks)


def _evaluation(
    name: str, took: float, once: float, error: float | None, value: float
) -> tuple[str, ...]:
    shown = "" if error is None else f"{error:.1e}"
    return (name, seconds(took), ratio(took / once), shown, f"{value:.6e}")


def phi2_of(model: tw.Model, rtol: float) -> Vector:
    """The disk's angle at the samples, at the start of the fit."""
    return np.asarray(tw.simulate(model, preset="appendix", rtol=rtol)["phi2"])


def _searches(
    simplex: Minimum,
    by_c: Value | None,
    begin: Vector,
    data: Vector,
    library: ctypes.CDLL | None,
    xcos: Told,
) -> Result:
    """fminsearch of ours and Scilab's, on the same function and on models of their own."""
    rows = [_search("tracewire, own model", simplex.output.funcCount, simplex)]
    promises = []
    if by_c is not None and library is not None:
        ours = fminsearch(by_c, begin, optimset(MaxIter=ITERATIONS, Display="off"))
        rows.append(_search("tracewire, model in C", ours.output.funcCount, ours))
        linked = told_by_scilab(data, library)
        for word, count, iterations, fval, *_ in linked:
            if word == "simplex":
                rows.append(("Scilab, the same in C", count, iterations, f"{float(fval):.9e}"))
                for name, one in (("same function", ours), ("own model", simplex)):
                    evaluations = one.output.funcCount / float(count)
                    promises += [
                        Promise(
                            f"{name}: evaluations beside Scilab's fminsearch",
                            max(evaluations, 1 / evaluations),
                            1.05,
                            most=True,
                        ),
                        Promise(
                            f"{name}: minimum beside Scilab's fminsearch",
                            max(one.fval / float(fval), float(fval) / one.fval),
                            1.001,
                            most=True,
                        ),
                    ]
    for word, count, iterations, fval, *took in xcos:
        if word == "simplex":
            name = f"Scilab, Xcos (in {seconds(float(took[0]))})"
            rows.append((name, count, iterations, f"{float(fval):.9e}"))
    columns = ("fminsearch, from the appendix's start", "evaluations", "iterations", "criterion")
    return Result(f"{TITLE}: fminsearch, MaxIter {ITERATIONS}", columns, rows, promises)


def _search(name: str, evaluations: int, found: Minimum) -> tuple[str, ...]:
    return (name, str(evaluations), str(found.output.iterations), f"{found.fval:.9e}")


def _methods(simplex: Minimum, found: Mapping[str, Fit]) -> Result:
    """What least squares needs to pass below the best of fminsearch."""
    rows = [
        (
            name,
            str(one.evaluations),
            str(one.iterations),
            f"{one.criterion:.4e}",
            seconds(one.seconds),
        )
        for name, one in found.items()
    ]
    best = min(found["fminsearch"].criterion, simplex.fval)
    lower = [at.evaluations for at in found["least_squares"].history if at.criterion < best]
    share = (lower[0] if lower else np.inf) / simplex.output.funcCount
    what = f"{TITLE}: evaluations of least_squares to a lower criterion, of fminsearch's"
    remarks = (
        f"least_squares is below fminsearch's best after {lower[0] if lower else 'no'} evaluations;"
        f" fminsearch's search has {simplex.output.funcCount}",
        "a run with nine sensitivities counts as ten",
    )
    columns = ("fit, method", "evaluations", "iterations", "criterion", "time")
    return Result(
        f"{TITLE}: methods", columns, rows, [Promise(what, share, 0.1, most=True)], remarks
    )


def told_by_xcos(data: Vector, options: Options) -> tuple[Told, str]:
    """What appendix_xcos.sce tells, or why there is no Xcos."""
    scilab = shutil.which("scilab-adv-cli")
    screen = [] if os.environ.get("DISPLAY") else [shutil.which("xvfb-run") or "", "-a"]
    if scilab is None:
        return [], "not installed (scilab-adv-cli)"
    if "" in screen:
        return [], "needs a display, or xvfb-run"
    iterations = 0 if options.quick else ITERATIONS
    head = f"runs = {5 if options.quick else 15}; iterations = {iterations};"
    told = _told([*screen, scilab], "appendix_xcos.sce", head, data)
    return told, "" if told else "Xcos did not run"


def told_by_scilab(data: Vector, library: ctypes.CDLL) -> Told:
    """What appendix_simplex.sce tells; nothing without Scilab's command line."""
    scilab = shutil.which("scilab-cli")
    if scilab is None:
        return []
    constants = ", ".join(repr(float(value)) for value in Torsion(120.0).constants)
    head = f'library = "{library._name}"; p = [{constants}]; iterations = {ITERATIONS};'
    return _told([scilab], "appendix_simplex.sce", head, data)


def _told(command: list[str], script: str, head: str, data: Vector) -> Told:
    """The lines that a script tells until it is done; then its process is ended with its children,
    because Scilab with Xcos may hang at its exit."""
    with tempfile.TemporaryDirectory(prefix="tracewire-benchmark-") as folder:
        table, file = Path(folder) / "measured.csv", Path(folder) / "run.sce"
        np.savetxt(table, data, delimiter=",", fmt="%.17g")
        own = f'file = "{folder}/torsion.zcos"; measured = csvRead("{table}", ",", ".");\n'
        file.write_text(own + head + "\n" + (SCRIPTS / script).read_text())
        process = subprocess.Popen(
            [*command, "-nb", "-f", str(file)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
            env={**os.environ, "TMPDIR": folder},
        )
        late = threading.Timer(MOST_SECONDS, _end, [process])
        late.start()
        told = []
        assert process.stdout is not None
        for line in process.stdout:
            if line.startswith("done"):
                break
            told.append(line.split())
        late.cancel()
        _end(process)
        process.wait()
    return [words for words in told if words and words[0] in TELLING]


def _end(process: subprocess.Popen[str]) -> None:
    """Asked first, so that a virtual display tidies up."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(GRACE)
        time.sleep(1.0)  # for its children
        os.killpg(process.pid, signal.SIGKILL)
