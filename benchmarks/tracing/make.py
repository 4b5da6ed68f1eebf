"""From a case to files: a diagram with its measured section, five records, and the truth."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.tracing.cases import Case, Spec
from benchmarks.tracing.integrate import Drive, Motion
from benchmarks.tracing.laws import EFFECTS, At, Hidden
from benchmarks.tracing.plants import PLANTS, Plant, Values

Array = NDArray[np.float64]
SYSTEMS = Path(__file__).parent / "systems"
USES = ("train", "train", "train", "gate", "validate")
SIZES = (1.0, 0.6, 0.35, 0.75, 0.85)  # of drive and start, largest 1
MOST_DRAWS, FURTHER = 5, 1000
LEAD = 0.1  # s that a record begins after the motion where a sensor is late; memories start with it


@dataclass(frozen=True)
class Series:
    """One record: the drive, the start state, and its own phase of a disturbance."""

    use: str
    drive: Drive
    start: tuple[float, ...]
    phase: float


@dataclass(frozen=True, eq=False)
class Record:
    """Sample times [s] (N,), true states (N, n), and what a perfect sensor would show (N,)."""

    t: Array
    states: Array
    shown: dict[str, Array]
    u: Array


@dataclass(frozen=True, eq=False)
class Setup:
    """A case with numbers: parameters, hidden effects, series, sampling and noise."""

    case: Case
    plant: Plant
    values: Values
    hidden: tuple[Hidden, ...]
    series: tuple[Series, ...]
    times: Array
    channels: tuple[str, ...]
    sigma: dict[str, float]
    stated: bool


def _drives(case: Case, plant: Plant, rng: np.random.Generator) -> tuple[Series, ...]:
    found = []
    scale = rng.uniform(0.8, 1.0)
    low, high = plant.speed
    # spread over the range, in another order for every case
    speeds = low + (high - low) * (rng.permutation(5) + rng.uniform(0.2, 0.8, 5)) / 5
    for number, use in enumerate(USES):
        size = scale * SIZES[number]
        drive = Drive()
        if plant.drive:
            amplitude = plant.size[0] + (plant.size[1] - plant.size[0]) * (size - 0.28) / 0.72
            phase = float(rng.uniform(0, 2 * np.pi))
            drive = Drive((float(amplitude),), (float(speeds[number]),), (phase,))
        signs = rng.choice([-1.0, 1.0], len(plant.begin))
        part = rng.uniform(0.7, 1.0, len(plant.begin)) * size
        rate = size * rng.uniform(-1, 1, len(plant.begin)) * 2.0  # 1/s
        start = [*(signs * part * np.array(plant.begin)), *(rate * np.array(plant.begin))]
        found.append(Series(use, drive, tuple(map(float, start)), float(rng.uniform(0, 2 * np.pi))))
    return tuple(found)


def number(text: str, Q: float, V: float, U: float) -> float:
    """A number, or a multiple of the largest coordinate, the rms rate or the drive's amplitude."""
    sizes = {"Q": Q, "V": V, "U": U}
    return float(text[:-1]) * sizes[text[-1]] if text[-1] in sizes else float(text)


def _sized(
    spec: Spec, plant: Plant, values: Values, series: Series, times: Array, factor: float
) -> Hidden:
    """The coefficient of an effect, from the motion of the declared system in its first series."""
    motion = Motion(plant, values, (), series.drive)
    states = motion.run(series.start, times, float(times[0]))
    n = len(plant.coordinates)
    if EFFECTS[spec.name].kind == "sensor":
        y = states[:, plant.coordinates.index(str(spec.place))]
        rms = float(np.sqrt(np.mean(y**2)))
        unit = {"sensor_offset": 1, "sensor_quad": rms**2, "sensor_drift": times[-1]}
        size = spec.absolute or spec.share * rms / unit[spec.name]
        return Hidden(spec.name, spec.place, factor * size)
    place = spec.place if isinstance(spec.place, int) else 0
    Q = float(np.max(np.abs(states[:, place])))
    V = float(np.sqrt(np.mean(states[:, n + place] ** 2)))
    U = sum(series.drive.amplitude)
    shapes = {name: number(text, Q, V, U) for name, text in spec.shapes}
    if spec.absolute:
        if spec.name.endswith("_harm"):
            shapes = {"size": series.drive.amplitude[0], "psi": shapes.get("psi", 0.0)}
        return Hidden(spec.name, spec.place, factor * spec.absolute, shapes)
    if spec.name in ("harmonic", "parametric"):
        shapes["phase"] = 0.0  # every series has its own
    hidden = Hidden(spec.name, place, 1.0, shapes, spec.width * V)
    effect, z = hidden.effect, 0.0
    outputs, forces = [], []
    dt = float(times[1] - times[0])
    for t, row in zip(times, states, strict=True):
        u, y = series.drive(float(t)), row.tolist()
        at: At = motion.at(float(t), y, place, u, z)
        if effect.memory:
            for _ in range(20):
                z += dt / 20 * effect.memory(at._replace(z=z), shapes)
            at = at._replace(z=z)
        law = effect.force or effect.level
        assert law is not None
        outputs.append(law(at, shapes))
        if plant.stiff:  # without the pin, whose torque is of another order
            forces.append(values["kappa1"] * (u - y[0]) if place == 0 else values["T_s2"])
        else:
            forces.append(plant.forces(values, y[:n], y[n : 2 * n], u)[place])
    acts = float(np.mean(np.square(outputs)))
    if acts == 0.0:
        raise ValueError(f"{spec.name} does nothing in {plant.name}: take another system")
    size = spec.share * float(np.sqrt(np.mean(np.square(forces)) / acts))
    return replace(hidden, coefficient=factor * size)


def set_up(case: Case) -> Setup:
    """Every number of a case, from its name alone."""
    rng = np.random.default_rng(case.seed)
    plant = PLANTS[case.system]
    values = dict(plant.true)
    for name in plant.scatter:
        values[name] *= rng.uniform(0.9, 1.1)
    every = float(rng.choice([0.01, 0.01, 0.01, 0.02, 0.005]))
    if plant.stiff:
        every = 0.01
    seconds = 0.3 if case.bad == "too_short" else case.seconds
    times = np.round(np.arange(round(seconds / every) + 1) * every, 6)
    series = _drives(case, plant, rng)
    hidden = tuple(
        _sized(s, plant, values, series[0], times, rng.uniform(0.8, 1.4)) for s in case.hidden
    )
    with_rates = rng.random() < 0.25
    ratio = float(np.exp(rng.uniform(np.log(200), np.log(2000))))
    stated = bool(rng.random() < 0.5)
    channels = (*plant.coordinates, *(plant.rates if with_rates else ()))
    made = Setup(case, plant, values, hidden, series, times, channels, {}, stated)
    shown = record(made, series[0]).shown
    sigma = {name: float(f"{np.std(shown[name]) / ratio:.2g}") for name in channels}
    return replace(made, sigma=sigma)


def record(setup: Setup, series: Series) -> Record:
    """The noise-free motion of one series."""
    plant, times = setup.plant, setup.times
    hidden = []
    for h in setup.hidden:
        shapes = dict(h.shapes)
        if h.name in ("harmonic", "parametric"):
            shapes["phase"] = series.phase
        if h.name.endswith("_harm"):
            shapes["size"] = series.drive.amplitude[0]
        hidden.append(replace(h, shapes=shapes))
    values, noise = dict(setup.values), None
    if setup.case.bad == "other_rig" and series is setup.series[1]:
        values["J"] *= 1.7
    if setup.case.bad == "process_noise":
        noise = _random_force(setup, series)
    motion = Motion(plant, values, hidden, series.drive, noise)
    delay = {h.place: h.coefficient for h in hidden if h.name == "sensor_delay"}
    late = np.unique(np.concatenate([times, *(times - d for d in delay.values())]))
    states = motion.run(series.start, late, -LEAD if delay else float(times[0]))
    n = len(plant.coordinates)
    columns = dict(zip((*plant.coordinates, *plant.rates), range(2 * n), strict=True))
    shown = {}
    for name in setup.channels:
        shift = times - delay.get(name, 0.0)
        y = states[np.searchsorted(late, shift), columns[name]]
        clean = y.copy()
        for h in hidden:
            if h.place == name:
                c = h.coefficient
                added = {
                    "sensor_offset": c, "sensor_gain": c * y, "sensor_quad": c * y**2,
                    "sensor_drift": c * times,
                }  # fmt: skip
                clean = clean + added.get(h.name, 0.0)
        shown[name] = clean
    u = np.array([series.drive(float(t)) for t in times])
    return Record(times, states[np.searchsorted(late, times), : 2 * n], shown, u)


def _random_force(setup: Setup, series: Series) -> Callable[[float], float]:
    """White in effect: a new level every 20 ms."""
    rng = np.random.default_rng([setup.case.seed, setup.series.index(series)])
    size = 0.5 * max(series.drive.amplitude)
    steps = size * rng.standard_normal(2000)
    return lambda t: float(np.interp(t + LEAD, np.arange(2000) * 0.02, steps))


def make(case: Case, folder: Path) -> Path:
    """Write the files of a case into a folder of its own and return the diagram's path.

    A draw whose body runs away, as over the top of a bent spring, is drawn again.
    """
    home = folder / case.name.replace("/", "_").replace("@", "_at_")
    diagram = home / f"{case.system}.yaml"
    said = json.dumps(asdict(case))
    known = home / "truth.json"
    if known.exists() and json.dumps(json.loads(known.read_text())["case"]) == said:
        return diagram
    home.mkdir(parents=True, exist_ok=True)
    for again in range(MOST_DRAWS):
        try:
            truth = _written(set_up(replace(case, draw=case.draw + FURTHER * again)), home, diagram)
        except RuntimeError:
            if again == MOST_DRAWS - 1:
                raise
        else:
            known.write_text(json.dumps({"case": asdict(case), **truth}))
            break
    return diagram


def _written(setup: Setup, home: Path, diagram: Path) -> dict[str, Any]:
    """Write the series and the diagram; returns what is true of them."""
    case = setup.case
    rng = np.random.default_rng([case.seed, 1])
    lines = ["measured:"]
    clean: dict[str, Any] = {}
    for number, series in enumerate(setup.series):
        name = f"{series.use}_{number + 1}" if series.use == "train" else series.use
        made = record(setup, series)
        shown = {c: y + setup.sigma[c] * rng.standard_normal(len(y)) for c, y in made.shown.items()}
        u = made.u
        if case.bad == "constant":
            shown = {c: 0.3 + setup.sigma[c] * rng.standard_normal(len(u)) for c in shown}
        if case.bad == "wrong_units":
            shown = {c: np.degrees(y) for c, y in shown.items()}
        if case.bad == "misaligned":
            u = np.array([series.drive(float(t) - 0.35) for t in made.t])
        columns = {"t": made.t, **({setup.plant.drive: u} if setup.plant.drive else {}), **shown}
        text = np.column_stack(list(columns.values()))
        np.savetxt(home / f"{name}.csv", text, "%.9g", ",", header=",".join(columns), comments="")
        lines += _measured(setup, name, series.use)
        if series.use == "validate":
            clean = {
                "t": made.t.tolist(),
                "u": made.u.tolist(),
                "start": made.states[0].tolist(),
                "shown": {c: y.tolist() for c, y in made.shown.items()},
            }
    declared = (SYSTEMS / f"{case.system}.yaml").read_text()
    diagram.write_text(declared + "\n".join(lines) + "\n")
    return {
        "values": setup.values,
        "hidden": [asdict(h) | {"place": place_name(setup.plant, h)} for h in setup.hidden],
        "sigma": setup.sigma,
        "validate": clean,
    }


def place_name(plant: Plant, hidden: Hidden) -> str:
    """The place as a trace names it."""
    if hidden.effect.kind == "sensor":
        return f"sensor.{hidden.place}"
    return plant.places[hidden.place] if isinstance(hidden.place, int) else hidden.place


def _measured(setup: Setup, name: str, use: str) -> list[str]:
    def channel(c: str) -> str:
        return f"{c}: {{column: {c}, sigma: {setup.sigma[c]:g}}}" if setup.stated else f"{c}: {c}"

    signals = ", ".join(map(channel, setup.channels))
    free = ", ".join(f"{s}: free" for s in (*setup.plant.coordinates, *setup.plant.rates))
    lines = [f"  {name}:", f"    file: {name}.csv", f"    use: {use}", "    time: t"]
    lines += [f"    signals: {{{signals}}}"]
    if setup.plant.drive:
        lines += [f"    inputs: {{{setup.plant.drive}: {setup.plant.drive}}}"]
    return [*lines, f"    start: {{{free}}}"]
