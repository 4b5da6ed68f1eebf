"""Paper A's own strategy, steps M1 to M8, on a record that its final model generates.

`identification(M8, disk)` of a statement is what is measured here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from tracewire.analyse import Judge
from tracewire.compile import Model
from tracewire.errors import AnalysisError, unknown
from tracewire.fit import fit, optimset
from tracewire.paper.statements import folder_of
from tracewire.residual import Measured
from tracewire.solve import simulate

NOISE = float(np.radians(0.05))
"""The standard deviation of the noise on both angles, rad."""
FLOOR = NOISE**2 / 2
"""The criterion that is left when only the noise is, rad²."""
SEED = 2021
RTOL = 1e-9
STAGES = {
    "S1": "s1_symmetric",
    "S2": "s2_sided_contact",
    "S3": "s3_sided_column",
    "S4": "pendulum",
    "S5": "s5_restitution",
}
"""The file of each stage of the model."""
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


class Identification:
    """The steps, done when they are first asked for."""

    def __init__(self, judge: Judge) -> None:
        self.judge = judge

    def model(self, stage: str) -> Model:
        """The model of a stage, such as S1."""
        return self.judge.model(folder_of("a") / f"{STAGES[stage]}.yaml")

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """The steps in their order."""
        return _steps(self.model, self.judge.tell)

    def __getitem__(self, name: str) -> Step:
        """A step by its name, such as M8. Raises AnalysisError: there is none."""
        for step in self.steps:
            if name in step.name.split(", "):
                return step
        raise AnalysisError([unknown("step", name, [step.name for step in self.steps])])

    def measure(self, step: str, what: str) -> float:
        """The criterion of the `disk` or the `column` after a step, or of the disk `before` it, in
        rad²; of the step `noise` what is left when only the noise is. Raises AnalysisError."""
        criteria = ("before", "disk", "column")
        if what not in criteria:
            raise AnalysisError([unknown("criterion", what, criteria)])
        return FLOOR if step == "noise" else float(getattr(self[step], what))


def with_identification(judge: Judge) -> Identification:
    """Let a judge know `identification(...)`, the steps of paper A."""
    steps = Identification(judge)
    judge.further = {"identification": steps.measure}
    return steps


def record(model: Model) -> Measured:
    """Both angles of the final model, 401 samples in 4 s, with noise of 0.05 deg."""
    run = simulate(model, rtol=RTOL)
    rng = np.random.default_rng(SEED)
    values = {n: run[n] + NOISE * rng.standard_normal(run.t.size) for n in ("phi2", "phi1")}
    return Measured("generated", "train", run.t, values)


def criterion(model: Model, measured: Measured, signal: str, values: Mapping[str, float]) -> float:
    """mean((φ_exp - φ_num)²)/2 in rad², the objective of the paper's appendix."""
    run = simulate(model, parameters=values, times=measured.t)
    return float(np.mean((measured.values[signal] - run[signal]) ** 2) / 2)


def _steps(model_of: Callable[[str], Model], tell: Callable[[str], None]) -> tuple[Step, ...]:
    measured = record(model_of("S4"))
    steps: list[Step] = []

    def step(
        name: str,
        stage: str,
        did: str,
        values: Mapping[str, float],
        free: tuple[str, ...] = (),
        iterations: int = 0,
        signal: str = "phi2",
    ) -> dict[str, float]:
        """Adapt the free parameters from `values` on, and keep what came out."""
        tell(f"{name}: {did}")
        model = model_of(stage)
        found, done, evaluations = dict(values), 0, 0
        before = criterion(model, measured, "phi2", values)
        if free:
            only = Measured(measured.name, "train", measured.t, {signal: measured.values[signal]})
            fitted = fit(
                model,
                [only],
                method="fminsearch",
                free=free,
                parameters=values,
                options=optimset(MaxIter=iterations, **SEARCH),
            )
            found |= fitted.values
            done, evaluations = fitted.iterations, fitted.evaluations
        disk, column = (criterion(model, measured, n, found) for n in ("phi2", "phi1"))
        steps.append(Step(name, stage, did, before, disk, column, done, evaluations, dict(found)))
        return found

    rough = step("M1", "S1", "rough guess", {})
    first = step("M2", "S1", "fit without eps, mu, B", rough, (*DISK, *COLUMN), 50)
    second = step(
        "M3", "S1", "and with eps1, eps2, mu", first, (*DISK, *COLUMN, "eps1", "eps2", "mu"), 50
    )
    third = step(
        "M4, M5",
        "S1",
        "and with B1, B2; 50 iterations",
        second,
        (*DISK, *COLUMN, "eps1", "eps2", "mu", "B1", "B2"),
        50,
    )
    rest = {name: third[name] for name in ("B1", "B2", "mu", "eps1", "eps2", *COLUMN)}
    sided = {"c2": third["c2"], "k2": third["k2"]}
    sided |= {f"{n}_{side}": third[n] for n in ("T_s2", "T_v2") for side in "lr"}
    sixth = step("M6", "S2", "the disk's friction has two sides", rest | sided, SIDES, 100)
    contact = {n: sixth[n] for n in (*SIDES, "eps2", "B1", "B2") if n != "c2"}
    contact |= {"c2_l": sixth["c2"], "c2_r": sixth["c2"]}
    column = {f"{n}_{side}": third[n] for n in ("kappa1", "kappa2", "T_v1") for side in "lr"}
    seventh = step(
        "M7",
        "S3",
        "the column, with two sides, to its own record",
        contact | column,
        SPRING,
        150,
        "phi1",
    )
    given = {n: seventh[n] for n in (*SPRING, "B1", "B2")} | {"T_02_l": 0.5, "T_02_r": 0.5}
    step("M8", "S4", "the final friction, nine parameters", given, NINE, 150)
    return tuple(steps)
