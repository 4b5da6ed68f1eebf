"""Histories: what an effect would have put out along recorded signals."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tracewire.compile import Model, compile
from tracewire.diagram import read_text
from tracewire.solve import Interrupted
from tracewire.trace.candidates.candidate import Candidate
from tracewire.trace.candidates.candidates import find_candidates
from tracewire.trace.candidates.effect_outputs import Variant, effect_outputs, variants_of
from tracewire.trace.candidates.places import find_places
from tracewire.trace.candidates.signal_scales import Trajectory, signal_scales_of
from tracewire.trace.options import TraceOptions

OPTIONS = TraceOptions()

TEXT = """
inputs: {u: {default: 0}}
blocks:
  x: {type: integrator, of: v}
  v: {type: integrator, of: force}
  force: {type: sum, of: [-x, u]}
"""
T = np.linspace(0, 12, 2401)


def moving(phase: float = 0.0) -> Trajectory:
    x = np.sin(2 * T + phase) * np.exp(-0.05 * T)
    v = (2 * np.cos(2 * T + phase) - 0.05 * np.sin(2 * T + phase)) * np.exp(-0.05 * T)
    return Trajectory(T, {"x": x, "v": v, "force": np.gradient(v, T), "u": np.sin(3 * T)})


def resting() -> Trajectory:
    half = T < 6
    x = np.where(half, np.sin(np.pi * T / 12) ** 2, 1.0)
    v = np.where(half, np.pi / 12 * np.sin(np.pi * T / 6), 0.0)
    return Trajectory(T, {"x": x, "v": v, "force": np.zeros_like(T), "u": np.sin(3 * T)})


def candidates_of(text: str, runs: list[Trajectory]) -> tuple[Model, dict[str, Candidate]]:
    model = compile(read_text(text))
    found = find_candidates(
        model, find_places(model), signal_scales_of(runs, OPTIONS.candidate), OPTIONS.candidate
    )
    return model, {str(candidate): candidate for candidate in found}


def outputs_of(
    model: Model,
    candidates: list[Candidate],
    runs: list[Trajectory],
    tell: Callable[[str], None] = pytest.fail,
) -> dict[Variant, list[np.ndarray]]:
    """The outputs at all samples."""
    samples = [np.arange(len(run.t)) for run in runs]
    return effect_outputs(model, candidates, runs, samples, OPTIONS.candidate, tell)


def test_outputs_at_some_samples_are_those_of_all() -> None:
    """Those of memories, too, which begin where the record does."""
    run, some = moving(), np.arange(700, 2401, 50)
    model, known = candidates_of(TEXT, [run])
    chosen = [known[f"{name} @ force"] for name in ("quad_drag", "hysteresis", "cogging")]
    whole = outputs_of(model, chosen, [run])
    part = effect_outputs(model, chosen, [run], [some], OPTIONS.candidate, pytest.fail)
    assert part.keys() == whole.keys()
    for variant, (values,) in part.items():
        np.testing.assert_allclose(values, whole[variant][0][some], atol=1e-3, err_msg=str(variant))


def test_one_memory_that_needs_short_steps_runs_without_the_others() -> None:
    """Whether a group of memories is split makes no difference to what they put out, but for what
    the loose tolerance of a screen leaves where the rate of a `dahl` bends."""
    run, samples = moving(), [np.arange(len(T))]
    model, known = candidates_of(TEXT, [run])
    chosen = [known[f"{name} @ force"] for name in ("dahl", "hysteresis", "play")]
    together, apart = (
        effect_outputs(
            model, chosen, [run], samples, replace(OPTIONS.candidate, memory_steps=most), print
        )
        for most in (1_000_000, 0)
    )  # fmt: skip
    assert apart.keys() == together.keys()
    assert len(apart) > len(chosen)
    for variant, (values,) in apart.items():
        np.testing.assert_allclose(values, together[variant][0], atol=5e-3, err_msg=str(variant))


def test_memoryless_effects_follow_their_formulas() -> None:
    runs = [moving(), moving(1.0)]
    model, known = candidates_of(TEXT, runs)
    formulas = {
        "bias @ force": lambda x, v, a, u: np.ones_like(x),
        "viscous @ force": lambda x, v, a, u: -v,
        "quad_drag @ force": lambda x, v, a, u: -v * np.abs(v),
        "coulomb @ force": lambda x, v, a, u: -np.sign(v),
        "stiffness @ force": lambda x, v, a, u: -x,
        "cubic_stiffness @ force": lambda x, v, a, u: -(x**3),
        "inertia @ force": lambda x, v, a, u: -a,
        "drive_gain @ drive.u": lambda x, v, a, u: u,
    }
    chosen = [known[name] for name in formulas]
    found = outputs_of(model, chosen, runs)
    for name, formula in formulas.items():
        first = next(v for v in found if str(v.candidate) == name)
        for run, values in zip(runs, found[first], strict=True):
            x, v, a, u = (run.signals[signal] for signal in ("x", "v", "force", "u"))
            np.testing.assert_allclose(values, formula(x, v, a, u), atol=1e-9, err_msg=name)


def test_a_shape_is_a_variant_of_its_own() -> None:
    runs = [moving()]
    model, known = candidates_of(TEXT, runs)
    found = outputs_of(model, [known["coulomb @ force"]], runs)
    assert [dict(variant.shapes)["width"] for variant in found] == pytest.approx(
        known["coulomb @ force"].shapes["width"]
    )
    smooth = [values for variant, (values,) in found.items() if dict(variant.shapes)["width"] > 0]
    widths = known["coulomb @ force"].shapes["width"][1:]
    for values, width in zip(smooth, widths, strict=True):
        np.testing.assert_allclose(values, -np.tanh(runs[0].signals["v"] / width), atol=1e-9)


def test_a_memory_is_integrated_along_the_run() -> None:
    run = moving()
    model, known = candidates_of(TEXT, [run])
    dahl = known["hysteresis @ force"]
    found = outputs_of(model, [dahl], [run])
    for variant, (values,) in found.items():
        (s,) = (value for _, value in variant.shapes)

        def rate(t: float, z: np.ndarray, s: float = s) -> np.ndarray:
            v = np.interp(t, run.t, run.signals["v"])
            return v - np.abs(v) * z / s

        exact = solve_ivp(rate, (0, 12), [0.0], t_eval=T, rtol=1e-8, atol=1e-10, max_step=0.02)
        np.testing.assert_allclose(values, -exact.y[0] / s, atol=2e-4)


def test_a_lag_is_that_of_its_coefficient_over_it() -> None:
    run = moving()
    model, known = candidates_of(TEXT, [run])
    lag = known["drive_lag @ drive.u"]
    assert lag.at == pytest.approx(2 * 0.005)
    ((values,),) = outputs_of(model, [lag], [run]).values()
    late = T > 0.2  # behind the start, a sine after a lag is known
    phase = np.arctan(3 * lag.at)
    expected = (np.cos(phase) * np.sin(3 * T - phase) - np.sin(3 * T)) / lag.at
    lines = 3**2 * 0.005**2 / 8  # a sine is above the straight lines between its samples
    np.testing.assert_allclose(values[late], expected[late], atol=2 * lines / lag.at)


def test_a_body_at_rest_neither_hangs_nor_fails() -> None:
    runs = [resting(), resting()]
    model, known = candidates_of(TEXT, runs)
    told: list[str] = []
    found = outputs_of(model, list(known.values()), runs, told.append)
    assert told == []
    assert {str(variant.candidate) for variant in found} == {
        name
        for name in known
        if not name.startswith(("sensor", "inertia", "elastic_load", "barrier_lo"))
    }  # with no force and x >= 0 these put out nothing, and are left out
    assert all(np.isfinite(values).all() for both in found.values() for values in both)


def test_one_that_cannot_be_computed_is_left_out_with_a_reason() -> None:
    bad = """
subsystems:
  root:
    inputs: [angle]
    outputs: {y: y}
    parameters: {k: 0}
    effect: {coefficient: k, inputs: {angle: q}, sign: either}
    blocks: {y: {type: expression, formula: "k*sqrt(angle)"}}
"""
    runs = [moving()]
    model, known = candidates_of(TEXT + bad, runs)
    told: list[str] = []
    names = ["viscous @ force", "root @ force", "stiffness @ force", "bias @ force"]
    found = outputs_of(model, [known[name] for name in names], runs, told.append)
    assert [str(v.candidate) for v in found] == [n for n in names if n != "root @ force"]
    assert len(told) == 1 and told[0].startswith("root @ force was not tried: ")


def test_long_grids_are_thinned_out_evenly() -> None:
    _, known = candidates_of(TEXT, [moving()])
    candidate = known["coulomb @ force"]
    grids = {"a": tuple(np.arange(300.0)), "b": (0.0, 1.0)}
    many = Candidate("x", candidate.place, "x", {}, "x.c", 0, grids)
    variants = [dict(variant.shapes) for variant in variants_of(many, OPTIONS.candidate.variants)]
    assert len(variants) <= OPTIONS.candidate.variants
    assert {(shape["a"], shape["b"]) for shape in variants} >= {
        (0.0, 0.0),
        (0.0, 1.0),
        (299.0, 0.0),
        (299.0, 1.0),
    }
    steps = np.diff(sorted({shape["a"] for shape in variants}))
    assert steps.max() - steps.min() <= 1.0


def test_ctrl_c_is_no_reason_to_leave_one_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*args: object, **options: object) -> None:
        raise Interrupted.one("stopped by Ctrl-C")

    model, known = candidates_of(TEXT, [moving()])
    # the package has a function of its name, which hides the module from its path
    monkeypatch.setattr(sys.modules[effect_outputs.__module__], "simulate", stopped)
    with pytest.raises(Interrupted):
        outputs_of(model, list(known.values()), [moving()])
