"""What else could pass for a hidden effect: every law of the library, to first order.

Each law is a force along the recorded motion, pushed through the declared plant; what starts and
free parameters reach is projected out. The share that it takes of a residual is its score.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.tracing.floor.fields import MASSES, Now, Numbers, force_of
from benchmarks.tracing.floor.refits import Refit, model_path
from benchmarks.tracing.floor.windows import Array, Indices, System, Trajectory, run
from benchmarks.tracing.laws import Hidden

GAPS = (0.3, 0.45, 0.6, 0.75, 0.85)
PARTS = (0.1, 0.25, 0.5)
SPEEDS = (0.15, 0.35, 0.8)
PITCHES = (2, 1, 2 / 3, 0.5, 0.4, 1 / 3, 0.25, 0.2, 1 / 6, 1 / 8, 1 / 10, 1 / 12)
PERIODS = (4, 2, 1, 1 / 2, 1 / 3, 1 / 4, 1 / 5, 1 / 6, 1 / 8)
PLAIN = (
    "bias", "coulomb", "viscous", "quad_drag", "cubic_damping", "asym_viscous", "disp_friction",
    "stiffness", "cubic_stiffness", "quad_stiffness", "asym_stiffness", "stiffness_drift",
    "viscous_drift", "friction_drift",
)  # fmt: skip
EACH = ("harmonic", "parametric")  # have a phase and size of their own in each series
SMOOTH = 0.1  # width of the smoother dry friction, of rms(v)


@dataclass(frozen=True, eq=False)
class Laws:
    """The laws beside a refitted model: orthonormal bases (samples, n) of what each can do."""

    system: System
    terms: Sequence[Hidden]
    model: Trajectory
    rows: Indices  # of the model's points in the data
    found: Refit
    bases: list[tuple[str, Array]]


def laws_beside(system: System, terms: Sequence[Hidden], data: Trajectory, found: Refit) -> Laws:
    """Every law of the library beside a refitted model, with shapes of a grid."""
    model, rows = model_path(system, terms, data, found)
    edges = np.array([*data.first, len(data.t)])
    series = np.searchsorted(edges, found.lanes, side="right") - 1
    forces, groups = _forces(system, model)
    laws = Laws(system, terms, model, rows, found, [])
    columns = _pushed(laws, forces)
    for name, members in groups:
        own = columns[..., members]
        if name in EACH:
            each = [own * (series == k)[:, None, None] for k in range(int(series[-1]) + 1)]
            own = np.concatenate(each, axis=-1)
        g = _free_of(found, own)
        raw = np.sum(own**2, axis=(0, 1))
        kept = np.sum(g**2, axis=(0, 1)) > 1e-6 * raw
        if np.any(kept):
            matrix = g[..., kept].reshape(-1, int(np.sum(kept)))
            laws.bases.append((name, np.linalg.qr(matrix / np.linalg.norm(matrix, axis=0))[0]))
    return laws


def responses(laws: Laws, forces: Sequence[Array]) -> tuple[Array, Array]:
    """The responses to forces on the data's grid without what starts and parameters reach, one
    column (samples,) each, and their shares of the whole responses (in squares)."""
    columns = _pushed(laws, [force[laws.rows] for force in forces])
    free = _free_of(laws.found, columns)
    raw = np.maximum(np.sum(columns**2, axis=(0, 1)), 1e-300)
    return free.reshape(-1, len(forces)), np.sum(free**2, axis=(0, 1)) / raw


def shares(laws: Laws, target: Array, skip: Sequence[str] = ()) -> dict[str, float]:
    """The share of a target (samples,) that each law takes, best shapes counted."""
    total = float(target @ target)
    taken: dict[str, float] = {}
    for name, basis in laws.bases:
        if name not in skip:
            inside = basis.T @ target
            taken[name] = max(float(inside @ inside) / total, taken.get(name, 0.0))
    return taken


def left_by(laws: Laws) -> Array:
    """What the refitted model leaves (samples,), without what starts and parameters reach."""
    return _free_of(laws.found, laws.found.residual[..., None]).ravel()


def _free_of(found: Refit, columns: Array) -> Array:
    """Columns (windows, samples, n) without what starts and free parameters reach."""
    out = np.empty_like(columns)
    for w, q in enumerate(found.basis):
        out[w] = columns[w] - q @ (q.T @ columns[w])
    shared = found.columns.reshape(-1, found.columns.shape[-1])
    flat = out.reshape(-1, columns.shape[-1])
    flat = flat - shared @ np.linalg.lstsq(shared, flat, rcond=1e-10)[0]
    return np.asarray(flat.reshape(columns.shape))


def _forces(
    system: System, data: Trajectory
) -> tuple[list[Array | tuple[Array, str]], list[tuple[str, list[int]]]]:
    """Forces on the grid, or what a sensor adds, and which of them make a law."""
    Q, V = float(np.max(np.abs(data.q))), float(np.sqrt(np.mean(data.v**2)))
    T = 2 * np.pi * float(np.std(data.q)) / V
    width = 0.01 * float(np.max(np.abs(data.v)))
    now = Now(data.t, data.q, data.v, data.q, data.phase, np.asarray(width))
    soft = now._replace(width=np.asarray(SMOOTH * V))
    forces: list[Array | tuple[Array, str]] = []
    groups: list[tuple[str, list[int]]] = []

    def add(name: str, *members: Array | tuple[Array, str]) -> None:
        groups.append((name, list(range(len(forces), len(forces) + len(members)))))
        forces.extend(members)

    def law(name: str, at: Now = now, **shapes: float) -> Array:
        s: Numbers = {key: np.asarray(value) for key, value in shapes.items()}
        return force_of(name, at, s)

    for name in PLAIN:
        add(name, law(name))
    add("coulomb", law("coulomb", soft))
    add("asym_coulomb", law("asym_coulomb", width=0.05 * V))
    for part in SPEEDS:
        add("stribeck", law("stribeck", s=part * V))
        add("stribeck", law("stribeck", soft, s=part * V))
    for part in PARTS:
        add("backlash", law("backlash", s=part * Q))
    for part in GAPS:
        for name in ("barrier", "barrier_hi", "barrier_lo"):
            add(name, law(name, s=part * Q))
    for part in (0.05, 0.15, 0.4):
        add("hysteresis", -_bristle(data, part * Q))
    for pitch in PITCHES:
        n = 2 * np.pi / (pitch * Q)
        add("cogging", np.sin(n * data.q), np.cos(n * data.q))
    for pitch in (1.0, 2.0, 4.0):
        n, rub = 2 * np.pi / (pitch * Q), law("coulomb")
        add("position_friction", rub * np.sin(n * data.q), rub * np.cos(n * data.q))
    ends = (*data.first[1:], len(data.t))
    for period in PERIODS:
        for name, factor in (("harmonic", np.ones_like(data.q)), ("parametric", data.q)):
            members = (
                factor * wave(2 * np.pi * data.t / (period * T)) for wave in (np.sin, np.cos)
            )
            add(name, *members)
    if np.any(data.u):
        gain = system.control[0] or 1.0
        add("drive_gain", gain * data.u)
        slope = np.concatenate(
            [np.gradient(data.u[a:b], data.half) for a, b in zip(data.first, ends, strict=True)]
        )
        add("drive_lag", -gain * slope)
        if np.any(data.tone):
            for k in (2, 3):
                waves = (data.tone * np.sin(k * data.phase), data.tone * np.cos(k * data.phase))
                add(f"drive_{'2nd' if k == 2 else '3rd'}_harm", *waves)
    a = np.concatenate(
        [np.gradient(data.v[i:j], data.half) for i, j in zip(data.first, ends, strict=True)]
    )
    add("inertia", -a)
    q = data.q
    add("sensor_offset", (np.ones_like(q), "shown"))
    add("sensor_gain", (q, "shown"))
    add("sensor_delay", (-data.v, "shown"))
    add("sensor_quad", (q**2, "shown"))
    add("sensor_drift", (data.t, "shown"))
    return forces, groups


def _bristle(data: Trajectory, s: float) -> Array:
    z = np.zeros_like(data.q)
    starts = set(data.first)
    steps = np.diff(data.q, prepend=data.q[0]).tolist()
    value = 0.0
    for k, step in enumerate(steps):
        value = 0.0 if k in starts else value + (step - abs(step) * value) / s
        z[k] = value
    return z


def _pushed(laws: Laws, forces: Sequence[Array | tuple[Array, str]]) -> Array:
    """The columns (windows, samples, forces): responses of the sensor per unit of each force."""
    system, data, found = laws.system, laws.model, laws.found
    columns = np.empty((len(found.lanes), found.samples, len(forces)))
    acting = [k for k, f in enumerate(forces) if not isinstance(f, tuple)]
    lanes = np.array(data.first)
    rows = lanes[:, None] + data.every * np.arange(found.samples)
    for k, f in enumerate(forces):
        if isinstance(f, tuple):
            columns[..., k] = f[0][rows]
    grid = np.stack([np.asarray(forces[k]) for k in acting], axis=1)
    declared = float(np.std(data.q)) * float(np.mean(data.v**2) / np.mean(data.q**2))
    mass = system.values[MASSES[system.name]]
    small = 1e-4 * declared * mass / np.maximum(np.sqrt(np.mean(grid**2, axis=0)), 1e-300)
    grid = np.concatenate([np.zeros((len(grid), 1)), grid * small], axis=1)
    which = np.repeat(np.arange(grid.shape[1]), len(found.lanes))
    values = {n: np.full(len(which), x) for n, x in found.values.items()}
    shown = run(
        system,
        laws.terms,
        data,
        np.tile(lanes, grid.shape[1]),
        found.samples,
        values,
        np.tile(found.starts, (1, grid.shape[1])),
        (grid, which),
    ).reshape(grid.shape[1], len(found.lanes), found.samples)
    for row, k in enumerate(acting):
        columns[..., k] = (shown[row + 1] - shown[0]) / small[row]
    return columns
