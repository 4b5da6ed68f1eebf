"""The language of quantities: each function against what is known exactly."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from analyse.models import row_of, value_of
from tracewire.analyse import Judge, judge
from tracewire.compile import compile, statement_problems
from tracewire.diagram import read_text

OSCILLATOR = """
title: Oscillator
span: [0, 4*pi]
every: pi/500
record: [x]
parameters: {w: {value: 2, unit: 1/s}, c: 0}
blocks:
  x: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: expression, formula: -w**2*x - c*v, unit: m/s^2}
  energy: {type: expression, formula: (v**2 + w**2*x**2)/2}
presets:
  damped: {c: 0.2}
  fast: {w: 4}
"""
BALL = """
title: Ball
span: [0, 3]
every: 0.001
blocks:
  h: {type: integrator, of: v, start: 1, unit: m}
  v: {type: integrator, of: g, unit: m/s}
  g: {type: constant, value: -2, unit: m/s^2}
  momentum: {type: expression, formula: 3*v}
events:
  - {when: h, crosses: down, set: {v: -0.5*v}}
"""
DRIVEN = """
title: Driven
span: [0, 20]
parameters: {w: 2, f: 0.5, stiff: 1}
blocks:
  x: {type: integrator, of: v, start: 0}
  v: {type: integrator, of: a}
  drive: {type: square, amplitude: 1, frequency: f}
  a: {type: expression, formula: drive - stiff*x - 0.5*v}
"""
HILL = """
title: Hill
span: [0, 10]
parameters: {a: 4, b: 0.5}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: expression, formula: -b*x}
  y: {type: integrator, of: z, start: 1}
  z: {type: integrator, of: r}
  r: {type: expression, formula: -a*y}
"""
LORENZ = """
title: Lorenz
span: [0, 50]
blocks:
  x: {type: integrator, of: dx, start: 1}
  y: {type: integrator, of: dy, start: 1}
  z: {type: integrator, of: dz, start: 20}
  dx: {type: expression, formula: 10*(y - x)}
  dy: {type: expression, formula: x*(28 - z) - y}
  dz: {type: expression, formula: x*y - 8/3*z}
"""


T = math.pi
STEP = math.pi / 500  # between two samples
OF_A_RUN = [
    ("end(x)", 1.0),
    ("end(v)", 0.0),
    ("at(x, pi/3)", -0.5),
    ("max(x)", 1.0),
    ("min(v)", -2.0),
    ("max(abs(v))", 2.0),
    ("max(end(x), 7)", 7.0),
    ("range(v)", 4.0),
    ("amplitude(v)", 2.0),
    ("mean(x)", 0.0),
    ("mean(x**2)", 0.5),
    ("rms(v)", math.sqrt(2)),
    ("integral(v**2)", 8 * math.pi),
    ("period(x)", T),
    ("frequency(x)", 1 / T),
    ("drift(energy)", 0.0),
    ("drift(v, 4)", 0.5),
    ("drift(x)", 2.0),
    ("cosine(x, 2)", 1.0),
    ("cosine(x + 3*cos(5*t), 5, 2)", 3.0),
    ("line(x, 1, 1)", 1 / T),
    ("fraction(x > 0)", 0.5),
    ("count(x < 0)", 4.0),
    ("time(x < -0.5, 2)", math.pi / 3 + T),
    ("max(x if t > 1 else 0)", 1.0),
    ("w", 2.0),
    ("pi*w", 2 * math.pi),
    ("max(abs(at(x, t + pi) - x))", 0.0),
]


@pytest.mark.parametrize(("that", "known"), OF_A_RUN)
def test_numbers_of_a_run_of_x_cos_2t(that: str, known: float) -> None:
    assert value_of(OSCILLATOR, that) == pytest.approx(known, abs=STEP)


def test_the_standard_deviation_is_that_of_the_samples() -> None:
    run = "run: {until: pi, samples: 5}"  # x = 1, 0, -1, 0, 1
    assert value_of(OSCILLATOR, "std(x)", run) == pytest.approx(math.sqrt(0.56), abs=1e-6)


def test_growth_is_below_zero_where_it_decays() -> None:
    run = "run: {preset: damped, until: 30}"
    assert value_of(OSCILLATOR, "growth_rate(x)", run) == pytest.approx(-0.1, rel=1e-3)


def test_samples_before_since_do_not_count() -> None:
    assert value_of(OSCILLATOR, "max(t)", "run: {since: 5, until: 6}") == pytest.approx(6, abs=0.01)
    assert value_of(OSCILLATOR, "min(t)", "run: {since: 5, until: 6}") == pytest.approx(5, abs=0.01)
    assert value_of(OSCILLATOR, "at(x, 0)", "run: {since: 5}") == 1.0


def test_a_setting_has_values_starts_and_a_preset() -> None:
    run = "run: {set: {w: 3}, start: {x: 2}, until: 1}"
    assert value_of(OSCILLATOR, "end(x)", run) == pytest.approx(2 * math.cos(3), abs=1e-7)
    run = "run: {preset: fast, until: 1}"
    assert value_of(OSCILLATOR, "end(x)", run) == pytest.approx(math.cos(4), abs=1e-7)


def test_the_reference_is_another_run_at_the_same_times() -> None:
    """cos 4t is cos 2(2t)."""
    other = "run: {until: pi}, reference: {preset: fast, until: pi}"
    assert value_of(OSCILLATOR, "max(abs(at(x, 2*t) - reference(x)))", other) < 1e-6
    assert value_of(OSCILLATOR, "max(v)/reference(max(v))", other) == pytest.approx(0.5, rel=1e-4)


def test_the_reference_may_be_another_diagram(tmp_path: Path) -> None:
    (tmp_path / "fast.yaml").write_text(OSCILLATOR.replace("value: 2", "value: 4"), "utf-8")
    text = OSCILLATOR + (
        'expect: [{that: "end(x) - reference(end(x))", below: 1, '
        "reference: {diagram: fast.yaml, until: 1}, run: {until: 1}}]\n"
    )
    (row,) = judge(read_text(text, tmp_path / "a.yaml"))
    assert row.value == pytest.approx(math.cos(2) - math.cos(4), abs=1e-7)


def test_events_of_a_ball_that_falls_by_2_m_per_s2() -> None:
    """It falls 1 m in 1 s, is there again after 1 s with half of its rate, and after 0.5 s."""
    assert value_of(BALL, "count(reset)", "run: {until: 2.9}") == 5.0
    assert value_of(BALL, "time(h, 1)") == pytest.approx(1.0, abs=1e-7)
    assert value_of(BALL, "time(events[0], 2) - time(reset)") == pytest.approx(1.0, abs=1e-7)
    jump = "after(reset, v) - before(reset, v)"
    assert value_of(BALL, f"max({jump})") == pytest.approx(3.0, abs=1e-7)
    assert value_of(BALL, "max(before(reset, momentum))", "run: {until: 1.5}") == pytest.approx(-6)
    assert value_of(BALL, "count()", "run: {until: 1.5}") == 1.0


def test_during_is_one_between_two_events() -> None:
    cart = Path(__file__).parents[2] / "diagrams" / "lessons" / "cart.yaml"
    moves = value_of(
        cart.read_text("utf-8").split("\nexpect:")[0] + "\n", "max(abs(v)*during(stick, slip))"
    )
    assert moves == 0.0


OF_MOTIONS = [
    ("multiplier(1)", 1.0),
    ("multiplier(3)", math.exp(-0.5)),
    ("multiplier_real(1)", math.cos(2)),
    ("floquet_exponent(3)", -0.5),
    ("floquet_frequency(1)", 2.0),
    ("monodromy_trace()", 2 * math.cos(2) + math.exp(-0.5)),
    ("monodromy_determinant()", math.exp(-0.5)),
]


@pytest.mark.parametrize(("that", "known"), OF_MOTIONS)
def test_multipliers_of_a_linear_system_over_one_second(that: str, known: float) -> None:
    assert value_of(HILL, that, "run: {period: 1}") == pytest.approx(known, abs=1e-8)


def test_verdicts_are_words() -> None:
    stable = row_of(OSCILLATOR, "steady_stability()", "run: {preset: damped}", "is: stable")
    assert (stable.value, stable.verdict) == ("stable", "agrees")
    assert row_of(OSCILLATOR, "steady_stability()", "", "is: stable").verdict == "does not agree"
    run = "run: {preset: damped, period: 1}"
    assert row_of(OSCILLATOR, "stability()", run, "is: stable").verdict == "agrees"


def test_where_stability_is_lost() -> None:
    edge = value_of(HILL, "stability_edge(b, -1, 1)", "run: {period: 1}")
    assert edge == pytest.approx(0.0, abs=1e-6)


def test_the_steady_state_and_a_periodic_orbit() -> None:
    pushed = DRIVEN.replace("drive - stiff*x", "3 - stiff*x")
    assert value_of(pushed, "steady(2*x)", "run: {set: {stiff: 2}}") == pytest.approx(3.0)
    run = "run: {period: 1/f, skip: 3}"
    assert value_of(DRIVEN, "orbit_multiplier(1)", run) == pytest.approx(math.exp(-0.5), rel=1e-6)


def test_points_of_a_section() -> None:
    run = "run: {edge: drive, skip: 40, keep: 8}"
    assert value_of(DRIVEN, "section_count()", run) == 8.0
    assert value_of(DRIVEN, "section_clusters()", run) == 1.0
    assert value_of(DRIVEN, "section_range(x + v)", run) < 1e-6
    again = "section(x, 1) - section(x, 8)"
    assert value_of(DRIVEN, again, run) == pytest.approx(0.0, abs=1e-6)
    assert value_of(DRIVEN, "motions(3, 2, x, v)", run) == 1.0


def test_the_exponents_of_lorenz() -> None:
    """Their sum is -(10 + 1 + 8/3) at each point (E. N. Lorenz, 1963)."""
    run = "run: {length: 100, transient: 10}"
    assert value_of(LORENZ, "lyapunov_positive()", run) == 1.0
    assert value_of(LORENZ, "divergence()", run) == pytest.approx(-41 / 3, rel=1e-9)
    assert value_of(LORENZ, "lyapunov_sum()", run) == pytest.approx(-41 / 3, rel=1e-3)
    assert value_of(LORENZ, "lyapunov(1)", run) == pytest.approx(0.9, abs=0.15)


def test_what_theory_states_is_written_as_theory_writes_it() -> None:
    """Published values: M. Abramowitz, I. Stegun, tables 9.1, 17.1 and 20.1."""
    assert value_of(HILL, "bessel_j(0, 1)") == pytest.approx(0.7651976866, abs=1e-10)
    assert value_of(HILL, "bessel_y(1, 2)") == pytest.approx(-0.1070324315, abs=1e-10)
    assert value_of(HILL, "elliptic_k(0.5)") == pytest.approx(1.8540746773, abs=1e-10)
    assert value_of(HILL, "mathieu_a(0, 5)") == pytest.approx(-5.80004602, abs=1e-8)
    assert value_of(HILL, "mathieu_b(2, 5)") == pytest.approx(2.09946045, abs=1e-8)


def test_a_fit_gives_a_parameter_and_its_criterion(tmp_path: Path) -> None:
    rows = "\n".join(f"{n / 10},{math.cos(0.3 * n)}" for n in range(40))
    (tmp_path / "run.csv").write_text(f"t,x\n{rows}\n", "utf-8")
    text = OSCILLATOR.replace("unit: 1/s}", "unit: 1/s, fit: [1, 5]}") + (
        "measured: {run: {file: run.csv, time: t, signals: {x: x}}}\n"
        "expect:\n"
        "  - {that: fitted(w), is: 3, within: 1e-4, unit: 1/s, run: {method: least_squares}}\n"
        "  - {that: criterion(), below: 1e-6, run: {method: least_squares}}\n"
        "  - {that: fitted(c), is: 0, within: 1, run: {method: least_squares}}\n"
    )
    rows_found = judge(read_text(text, tmp_path / "a.yaml"))
    assert [row.verdict for row in rows_found] == ["agrees", "agrees", "could not be measured"]
    assert "the fit does not free 'c'; there are: w" in rows_found[2].why


LINE = """
span: [0, 3]
every: 1
inputs: {u: {default: 1}}
parameters: {a: {value: 1, fit: [0, 10]}, b: 1}
blocks:
  x: {type: integrator, of: u, start: 0}
  y: {type: expression, formula: a*b*t}
presets: {twice: {b: 2}, half: {b: 0.5}}
measured:
  run: {file: run.csv, time: t, signals: {y: y}}
"""


@pytest.mark.parametrize("run", ["preset: twice", "set: {b: 2}"])
def test_a_fit_holds_the_preset_and_the_values_of_its_setting(tmp_path: Path, run: str) -> None:
    """y = a*b*t is 2 t: a is 1 where b is 2. The presets of the series give way."""
    (tmp_path / "run.csv").write_text("t,y\n0,0\n1,2\n2,4\n3,6\n", "utf-8")
    text = LINE.replace("signals: {y: y}}", "signals: {y: y}, preset: half}")
    statement = f"that: fitted(a), is: 1, within: 1e-6, run: {{method: least_squares, {run}}}"
    (row,) = judge(read_text(f"{text}expect: [{{{statement}}}]\n", tmp_path / "a.yaml"))
    assert row.verdict == "agrees", row.why


def test_a_fit_has_the_tolerance_of_its_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tracewire.analyse.quantities import subject

    given: list[float] = []
    fit = subject.fit
    monkeypatch.setattr(subject, "fit", lambda *a, **k: given.append(k["rtol"]) or fit(*a, **k))
    (tmp_path / "run.csv").write_text("t,y\n0,0\n1,2\n2,4\n3,6\n", "utf-8")
    statement = "that: criterion(), below: 1e-6, run: {rtol: 1e-7}"
    (row,) = judge(read_text(f"{LINE}expect: [{{{statement}}}]\n", tmp_path / "a.yaml"))
    assert (row.verdict, given) == ("agrees", [1e-7])


def test_a_series_drives_a_run_where_another_one_is_absent(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("t,y,u\n0,0,1\n1,2,1\n2,4,1\n3,6,1\n", "utf-8")
    text = LINE.replace("signals: {y: y}", "signals: {y: y}, inputs: {u: u}")
    text += "  other: {file: absent.csv, time: t, inputs: {u: u}}\n"
    statement = "that: end(x), is: 3, within: 1e-9, run: {series: run}"
    (row,) = judge(read_text(f"{text}expect: [{{{statement}}}]\n", tmp_path / "a.yaml"))
    assert row.verdict == "agrees", row.why


SWINGING = """
span: [0, 10]
parameters: {g: 1, size: 1}
blocks:
  x: {type: integrator, of: v, start: 1}
  v: {type: expression, formula: (g/size - cos(t)*cos(t))*x}
"""


def test_the_edge_of_stability_is_found_from_its_phase_and_as_near_as_its_range() -> None:
    """x' = (g/s - cos² t) x over pi is stable below g = s/2; over pi/2 from the phase pi/4 the mean
    of cos² is 1/2 - 1/pi."""
    edge = value_of(SWINGING, "stability_edge(g, 0, 1)", "run: {period: pi/2, phase: pi/4}")
    assert edge == pytest.approx(0.5 - 1 / math.pi, abs=1e-7)
    run = "run: {period: pi, set: {size: 1e-9}}"
    edge = value_of(SWINGING, "stability_edge(g, 0, 1e-9)", run)
    assert edge == pytest.approx(5e-10, rel=1e-6)


def test_an_edge_of_stability_lies_between_two_values() -> None:
    """At b = 0 the multiplier of x' = b x is exactly 1."""
    text = """
parameters: {b: 1}
blocks: {x: {type: integrator, of: v, start: 1}, v: {type: expression, formula: b*x}}
"""
    row = row_of(text, "stability_edge(b, 0, 0)", "run: {period: 1}")
    assert "'b' has the same stability at 0 and at 0. Give two values with the edge" in row.why


def test_the_edge_of_stability_has_the_tolerance_of_its_setting(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tracewire.analyse.quantities import subject

    given: list[float] = []
    floquet = subject.floquet
    monkeypatch.setattr(
        subject, "floquet", lambda *a, **k: given.append(k["rtol"]) or floquet(*a, **k)
    )
    value_of(SWINGING, "stability_edge(g, 0, 1)", "run: {period: pi, rtol: 1e-7}")
    assert set(given) == {1e-7}


def test_statements_of_one_setting_share_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    from tracewire.analyse.quantities import subject

    made: list[object] = []
    simulate = subject.simulate
    monkeypatch.setattr(subject, "simulate", lambda *a, **k: made.append(a) or simulate(*a, **k))
    text = OSCILLATOR + (
        "expect:\n"
        "  - {that: max(x), above: 0}\n"
        "  - {that: 'at(energy, 1.2345)', above: 0}\n"
        "  - {that: max(v), above: 0, run: {preset: fast}}\n"
        "  - {that: min(v), below: 0}\n"
    )
    assert all(row.verdict == "agrees" for row in judge(read_text(text, Path("a.yaml"))))
    assert len(made) == 2


def test_the_longest_runs_are_asked_for() -> None:
    text = OSCILLATOR + "expect: [{that: max(t), above: 0, run: {until: 1, full: {until: 2}}}]\n"
    diagram = read_text(text, Path("a.yaml"))
    assert judge(diagram)[0].value == pytest.approx(1.0, abs=0.01)
    assert judge(diagram, full=True)[0].value == pytest.approx(2.0, abs=0.01)


BOUNDS = [
    ("is: 2, within: 0.1", "2 ± 0.1", 1.9, 2.1),
    ("is: 2, within: 5 %", "2 ± 0.1", 1.9, 2.1),
    ("is: pi/2*w, within: 0", "3.141593 ± 0", math.pi, math.pi),
    ("above: 1", "≥ 1", 1, math.inf),
    ("below: 1 + 1", "≤ 2", -math.inf, 2),
    ("between: [1, 3]", "1 to 3", 1, 3),
]


@pytest.mark.parametrize(("expected", "text", "low", "high"), BOUNDS)
def test_bounds_are_within_or_beyond(expected: str, text: str, low: float, high: float) -> None:
    bounds = row_of(OSCILLATOR, "max(abs(v))", "", expected).bounds
    assert bounds is not None
    assert (bounds.text, bounds.low, bounds.high) == (
        text, pytest.approx(low), pytest.approx(high),
    )  # fmt: skip
    assert bounds.hold(low if math.isfinite(low) else high) and not bounds.hold(math.nan)


def test_values_and_bounds_are_in_the_unit_of_the_statement() -> None:
    row = row_of(OSCILLATOR, "max(x)", "unit: mm", "is: 1000, within: 1")
    assert (row.value, row.verdict) == (pytest.approx(1000), "agrees")
    row = row_of(OSCILLATOR, "max(v)", "unit: mm/s", "is: w, within: 1 %")  # a formula is in SI
    assert (row.value, row.verdict) == (pytest.approx(2000, abs=0.1), "agrees")


LOST = [
    ("time(impact)", "", "there is no event 'impact' number 1: there are 0"),
    ("time(x < 0, 9)", "", "number 9: there are 4"),
    ("max(after(reset, x))", "", "there is no event 'reset'"),
    ("multiplier(1)", "", "a multiplier needs 'period'. Write run: {period: ...} in the statement"),
    ("multiplier(3)", "run: {period: 1}", "there is no multiplier 3: there are 2"),
    ("time(x < 0, 1.5)", "", "number 1.5: there are 4"),
    ("time(x < 0, 1/0)", "", "number inf: there are 4"),
    ("line(x, 1, 0/0)", "", "there is no number of lines nan"),
    ("at(x, 1/0)", "", "the sample times do not ascend"),
    ("motions(1e9, 1, x)", "run: {period: 1}", "there is no number of starts 1e+09"),
    ("section(x, 1)", "", "a section needs 'period'"),
    ("band_low(up, 0.1)", "", "a band needs one parameter in 'over'"),
    ("period(x)", "run: {until: 1}", "rises through the middle of its wave 0 times"),
    ("growth_rate(x)", "run: {until: 1}", "too few for a growth rate"),
    ("drift(v)", "", "'v' begins at 0: its drift needs a scale"),
    ("at(x, -1)", "", "a quantity reads a signal at -1 s, and the run begins at 0 s"),
    ("max(x)", "run: {since: 99}", "fewer than two samples from 99 s on"),
    ("end(x)/0", "", "has no value: it is "),
    ("(1 + end(x)**2)/0", "", "has no value: it is infinite"),
    ("max(x/0)", "", "'x/0' is not finite at each sample"),
    ("motions(3, 0, x)", "run: {period: 1}", "starts within 0 of zero have no use"),
    ("cosine(x, 1/0)", "", "an angular frequency of cosine(...) is not finite"),
    ("stability_edge(c, 1, 2)", "run: {period: 1}", "the same stability at 1 and at 2"),
    ("criterion()", "", "there is no measured series to fit"),
    ("end(is_held(x))", "", "a quantity cannot work out is_held"),
    ("identification(M8, disk)", "", "is measured by `tracewire paper` only"),
]


@pytest.mark.parametrize(("that", "more", "said"), LOST)
def test_what_cannot_be_had_is_told_in_words(that: str, more: str, said: str) -> None:
    diagram = OSCILLATOR if that != "end(x)/0" else OSCILLATOR.replace("start: 1,", "start: 0,")
    row = row_of(diagram, that, more)
    assert (row.value, row.verdict) == (None, "could not be measured")
    assert said in row.why


def test_samples_and_events_do_not_mix() -> None:
    row = row_of(BALL, "count(after(reset, v) > v)")
    assert "takes values at samples and at events together" in row.why


def test_a_signal_before_an_event_must_be_one_of_states() -> None:
    text = BALL.replace("formula: 3*v", "formula: 3*abs(v)")
    row = row_of(text, "max(before(reset, momentum))")
    assert "before an event only states are known, and 'momentum' is none" in row.why


def test_statements_of_another_diagram_are_measured_on_this_one() -> None:
    lesson = read_text(
        OSCILLATOR + "expect: [{that: max(v), is: 2, within: 0.1}, {that: end(energy), above: 1}]",
        Path("lesson.yaml"),
    )
    right, wrong = (read_text(OSCILLATOR.replace("value: 2", f"value: {w}"), Path(f"{w}.yaml"))
                    for w in (2, 3))  # fmt: skip
    lost = read_text(OSCILLATOR.replace("energy", "power"), Path("lost.yaml"))
    found = Judge()
    verdicts = [
        [row.verdict for row in found.judge(one, lesson.expect)] for one in (right, wrong, lost)
    ]
    assert verdicts == [
        ["agrees", "agrees"],
        ["does not agree", "agrees"],
        ["agrees", "could not be measured"],
    ]


UNITS = [
    ("that: max(v), is: 1, within: 0, unit: m", "'max(v)' is in m/s, and its unit is 'm'"),
    ("that: period(x), is: 1, within: 0, unit: Hz", "'period(x)' is in s, and its unit is 'Hz'"),
    ("that: integral(v), is: 1, within: 0, unit: s", "is in m, and its unit is 's'"),
    ("that: max(x) + max(v), above: 0", "they cannot be added or compared"),
    ("that: max(x)/max(v), is: 1, within: 0, unit: s", ""),
    ("that: max(x), is: 1, within: 0, unit: mm", ""),
    ("that: drift(x), is: 1, within: 0, unit: m", "is in 1, and its unit is 'm'"),
]


@pytest.mark.parametrize(("statement", "said"), UNITS)
def test_the_unit_of_a_statement_is_that_of_its_quantity(statement: str, said: str) -> None:
    text = f"{OSCILLATOR}expect: [{{{statement}}}]\n"
    model = compile(read_text(text, Path("a.yaml")))
    found = statement_problems(model, model.diagram.expect)
    assert [problem.place.line for problem in found] == ([15] if said else [])
    assert all(said in problem.what for problem in found)
