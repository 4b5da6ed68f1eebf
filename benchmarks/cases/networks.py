"""Diagrams of many blocks: compile time by phase, time per evaluation, time per block and step."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import tracewire as tw
from tracewire.shipped import shipped

from benchmarks.cases.paper_a import DIAGRAM
from benchmarks.measure import Entrant, in_turn, least, seconds_of
from benchmarks.options import Options
from benchmarks.systems.hybrid import Vector
from benchmarks.systems.network import Network, network
from benchmarks.table import Promise, Result, ratio, seconds

SIZES = (1000, 10_000)
LENGTHS = (50, 200)
PROMISED = {0: 0.1, 1000: 0.5, 10_000: 10.0}  # s; 0 is the paper's model
POINTER = ctypes.POINTER(ctypes.c_double)
FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_double, *[POINTER] * 5)
CALLS = 20
PHASES = ("diagram", "read", "flatten, lower", "machine code of the rates", "first run - second")


def measure(options: Options) -> Iterator[Result]:
    """Compile times, then evaluations."""
    sizes = SIZES[:1] if options.quick else SIZES
    _phases(DIAGRAM.read_text(), 4.0, DIAGRAM)  # libraries and the engine are loaded here
    rows, promises, models = [], [], {}
    texts = {0: DIAGRAM.read_text()} | {size: network(size).text for size in sizes}
    for size, text in texts.items():
        name = f"{size} blocks" if size else "paper A"
        end, file = (0.05, None) if size else (4.0, DIAGRAM)
        tries = [_phases(text, end, file) for _ in range(1 if size > 1000 or options.quick else 3)]
        models[size] = tries[0][0]
        parts = [min(part) for part in zip(*(parts for _, parts in tries), strict=True)]
        total = sum(parts)
        rows.append((name, *map(seconds, parts), seconds(total)))
        promises.append(Promise(f"compile, {name}", total, PROMISED[size], "s", True))
    yield Result("Compile, by phase", (*PHASES, "sum"), rows, promises)
    yield _chains(options)
    rows = [row for size in sizes for row in _evaluations(models[size], network(size), options)]
    columns = ("rates of", "states", "time", "time / tracewire", "largest difference")
    yield Result("One evaluation of the right-hand side", columns, rows)


def _chains(options: Options) -> Result:
    """The chain of pendulums of the gallery, with more of them."""
    text = (shipped("diagrams") / "gallery" / "chain.yaml").read_text("utf-8")
    rows, promises = [], []
    for count in LENGTHS[:1] if options.quick else LENGTHS:
        model, parts = _phases(text.replace("n: 10 ", f"n: {count} "), 1.0, None)
        run = tw.simulate(model)
        time_of_run = least(partial(tw.simulate, model), options.seconds_each / 10)
        blocks, steps = len(model.flat.blocks), run.statistics.steps
        each = 1e9 * time_of_run / (blocks * steps)
        shown = (str(blocks), str(steps), seconds(time_of_run), f"{each:.0f} ns")
        rows.append((f"{count} pendulums", seconds(sum(parts)), *shown))
        promises.append(Promise(f"compile, {count} pendulums", sum(parts), 5.0, "s", True))
    columns = (
        "row",
        "to the first run",
        "blocks",
        "steps",
        "run of 40 s",
        "time per block and step",
    )
    return Result("A row of blocks", columns, rows, promises)


def _phases(text: str, end: float, file: Path | None) -> tuple[tw.Model, list[float]]:
    """The model and the seconds of each phase."""
    began = time.perf_counter()
    diagram = tw.read(file) if file else tw.read_text(text)
    read = time.perf_counter()
    model = tw.compile(diagram)
    lowered = time.perf_counter()
    model.routines.address("rhs")
    made = time.perf_counter()

    def run() -> None:
        tw.simulate(model, span=(0.0, end))

    first, second = seconds_of(run), least(run, 0.3)
    return model, [read - began, lowered - read, made - lowered, max(0.0, first - second)]


def _evaluations(model: tw.Model, wires: Network, options: Options) -> Iterator[tuple[str, ...]]:
    """The C function of the rates beside numpy and scipy.sparse, at one random point."""
    sizes = model.routines.sizes
    order = [int(name[1:]) for name in model.states]
    x = np.random.default_rng(1).normal(size=wires.cells)
    own_x = np.ascontiguousarray(x[order])
    modes, tables, constants = np.zeros(2 * sizes.modes), np.zeros(1), np.zeros(sizes.constants)
    # the diagram has numbers only, so that no parameter goes into `prepare`
    values = np.zeros(max(sizes.parameters, 1))
    _call(model, "prepare", values, modes, constants, tables, constants)
    guards, out = np.zeros(max(sizes.modes, 1)), np.zeros(wires.cells)
    _call(model, "guards", own_x, modes, constants, tables, guards)
    modes[: sizes.modes] = guards[: sizes.modes] >= 0
    rates = _bound(model, "rhs", own_x, modes, constants, tables, out)
    theirs = wires.rates()
    rates()
    difference = float(np.max(np.abs(out - theirs(0.3, x)[order])))

    def own() -> float:
        return seconds_of(lambda: [rates() for _ in range(CALLS)]) / CALLS

    def numpy() -> float:
        return seconds_of(lambda: [theirs(0.3, x) for _ in range(CALLS)]) / CALLS

    entrants = [Entrant("tracewire", own), Entrant("numpy, scipy.sparse", numpy)]
    in_turn(entrants, options.seconds_each / 100)
    base = entrants[0].seconds
    for entrant in entrants:
        yield (
            f"{wires.blocks} blocks: {entrant.name}",
            str(wires.cells),
            seconds(entrant.seconds),
            ratio(entrant.seconds / base),
            "" if entrant is entrants[0] else f"{difference:.1e}",
        )


def _bound(model: tw.Model, name: str, *arrays: Vector) -> Callable[[], None]:
    """A call of one of the model's C functions at t = 0.3."""
    function = FUNCTION(model.routines.compiled_address(name))
    pointers = [array.ctypes.data_as(POINTER) for array in arrays]

    def call() -> None:
        function(0.3, *pointers)

    return call


def _call(model: tw.Model, name: str, *arrays: Vector) -> None:
    _bound(model, name, *arrays)()
