"""Paper A's own strategy, steps M1 to M8, on a record that its final model generates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tracewire.compile import Model
from tracewire.fit import fit, optimset
from tracewire.paper.runs import Systems
from tracewire.residual import Measured
from tracewire.solve import simulate

NOISE = float(np.radians(0.05))
"""The standard deviation of the noise on both angles, rad."""
FLOOR = NOISE**2 / 2
"""The criterion that is left when only the noise is, rad²."""
SEED = 2021
SEARCH = {"TolX": 1e-9, "TolFun": 1e-12, "Display": "off"}

DISK = ("T_s2", "T_v2", "c2", "k2")
COLUMN = ("T_s1", "T_v1", "kappa1", "kappa2")
SIDES = ("T_s2_l", "T_s2_r", "T_v2_l", "T_v2_r", "c2", "k2")
SPRING = ("kappa1_l", "kappa1_r", "kappa2_l", "kappa2_r", "T_v1_l", "T_v1_r")
NINE = ("alpha", "beta", "T_s2_l", "T_02_l", "T_s2_r", "T_02_r", "k2", "c2_l", "c2_r")


@dataclass(frozen=True)
class Step:
    """A step of the strategy: which model, what it adapted to what, and the criteria it leaves.

    `disk` and `column` are mean((φ_exp - φ_num)²)/2 in rad² of φ2 and φ1; `before` is the disk's at
    the start of the step. `values` are the parameters that differ from the diagram's, in SI.
    """

    name: str
    stage: str
    did: str
    before: float
    disk: float
    column: float
    iterations: int = 0
    evaluations: int = 0
    values: Mapping[str, float] = field(default_factory=dict)


def identification(s: Systems) -> tuple[Step, ...]:
    """The steps, made once."""
    return s.kept("identification", lambda: _steps(s))


def step_of(s: Systems, name: str) -> Step:
    """A step by its name, such as M5."""
    return next(step for step in identification(s) if step.name == name)


def record(s: Systems) -> Measured:
    """Both angles of the final model, 401 samples in 4 s, with noise of 0.05 deg."""
    run = s.run("pendulum")
    rng = np.random.default_rng(SEED)
    values = {n: run[n] + NOISE * rng.standard_normal(run.t.size) for n in ("phi2", "phi1")}
    return Measured("generated", "train", run.t, values)


def criterion(model: Model, measured: Measured, signal: str, values: Mapping[str, float]) -> float:
    """mean((φ_exp - φ_num)²)/2 in rad², the objective of the paper's appendix."""
    run = simulate(model, parameters=values, times=measured.t)
    return float(np.mean((measured.values[signal] - run[signal]) ** 2) / 2)


def _steps(s: Systems) -> tuple[Step, ...]:
    measured = record(s)
    steps: list[Step] = []

    def step(
        name: str,
        diagram: str,
        did: str,
        values: Mapping[str, float],
        free: tuple[str, ...] = (),
        iterations: int = 0,
        signal: str = "phi2",
    ) -> dict[str, float]:
        """Adapt the free parameters from `values` on, and keep what came out."""
        s.tell(f"{name}: {did}")
        model = s.model(diagram)
        found, done, evaluations = dict(values), 0, 0
        before = criterion(model, measured, "phi2", values)
        if free:
            only = Measured(measured.name, "train", measured.t, {signal: measured.values[signal]})
            fitted = fit(
                model,
                [only],
                free=free,
                parameters=values,
                options=optimset(MaxIter=iterations, **SEARCH),
            )
            found |= fitted.values
            done, evaluations = fitted.iterations, fitted.evaluations
        disk, column = (criterion(model, measured, n, found) for n in ("phi2", "phi1"))
        stage = "S4" if diagram == "pendulum" else diagram.upper()
        steps.append(Step(name, stage, did, before, disk, column, done, evaluations, dict(found)))
        return found

    rough = step("M1", "s1", "rough guess", {})
    first = step("M2", "s1", "fit without eps, mu, B", rough, (*DISK, *COLUMN), 50)
    second = step(
        "M3", "s1", "and with eps1, eps2, mu", first, (*DISK, *COLUMN, "eps1", "eps2", "mu"), 50
    )
    third = step(
        "M4, M5",
        "s1",
        "and with B1, B2; 50 iterations",
        second,
        (*DISK, *COLUMN, "eps1", "eps2", "mu", "B1", "B2"),
        50,
    )
    rest = {name: third[name] for name in ("B1", "B2", "mu", "eps1", "eps2", *COLUMN)}
    sided = {"c2": third["c2"], "k2": third["k2"]}
    sided |= {f"{n}_{side}": third[n] for n in ("T_s2", "T_v2") for side in "lr"}
    sixth = step("M6", "s2", "the disk's friction has two sides", rest | sided, SIDES, 100)
    contact = {n: sixth[n] for n in (*SIDES, "eps2", "B1", "B2") if n != "c2"}
    contact |= {"c2_l": sixth["c2"], "c2_r": sixth["c2"]}
    column = {f"{n}_{side}": third[n] for n in ("kappa1", "kappa2", "T_v1") for side in "lr"}
    seventh = step(
        "M7",
        "s3",
        "the column, with two sides, to its own record",
        contact | column,
        SPRING,
        150,
        "phi1",
    )
    given = {n: seventh[n] for n in (*SPRING, "B1", "B2")} | {"T_02_l": 0.5, "T_02_r": 0.5}
    step("M8", "pendulum", "the final friction, nine parameters", given, NINE, 150)
    return tuple(steps)
