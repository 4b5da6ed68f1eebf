"""The section `expect`: what is read of it, and what is told where it is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagram.small_library import made, refused
from tracewire.diagram import Value, read_text
from tracewire.diagram.grammar import FIT_METHODS, SETTING
from tracewire.errors import DiagramError
from tracewire.fit.methods import METHODS
from tracewire.formula import Call, Name, Number

BASE = """\
parameters: {l: {value: 2, unit: m}}
blocks: {phi: {type: integrator, of: w, start: 1}, w: {type: gain, of: phi, k: -1}}
presets: {long: {l: 3}}
expect:
"""
LIKE = "that: end(phi), above: 1"
WRONG = [
    ("  that: end(phi)", "5:3: 'expect' must be a list of statements. Write it like - {that:"),
    ("  - end(phi)", "5:5: a statement must be a mapping. Write it like {that:"),
    ("  - {above: 1}", "5:5: a statement needs 'that'. Write that: ..."),
    ("  - {that: [a], above: 1}", "a quantity must be a text, such as end(x)"),
    ("  - {that: end(phi)}", "5:12: a statement expects nothing. Write one of: is: 2 with within:"),
    ("  - {that: end(phi), is: 1, above: 2}", "a statement has is and above. Write one of"),
    ("  - {that: end(phi), is: 1}", "a statement with 'is' needs 'within'. Write within: 1e-6"),
    ("  - {that: end(phi), above: 1, within: 2}", "5:40: 'within' belongs to 'is'"),
    ("  - {that: end(phi), is: 1, within: -1}", "5:37: 'within' must be a number from 0 on, or a"),
    ("  - {that: end(phi), is: 1, within: 1 m}", "or a part such as 1 %, not '1 m'"),
    ("  - {that: end(phi), between: 1}", "5:31: 'between' must be a pair of numbers"),
    ("  - {that: end(phi), above: 1, unit: 3}", "5:38: '3' is not a unit"),
    (
        "  - {that: end(phi), above: 1, like: 2}",
        "unknown key of a statement 'like'; there are: abov",
    ),
    (
        "  - {that: end(psi), above: 1}",
        "5:12: unknown signal or parameter 'psi'; there are: l, phi",
    ),
    (
        "  - {that: phi, above: 1}",
        "'phi' is a signal, and a quantity is one number. Write end(phi)",
    ),
    ("  - {that: end(phi) + w, above: 1}", "'w' is a signal, and a quantity is one number"),
    ("  - {that: most(phi), above: 1}", "formula 'most(phi)': unknown function 'most'"),
    ("  - {that: amplitud(phi), above: 1}", "Did you mean 'amplitude'?"),
    (
        "  - {that: 'drift(phi, 1, 2)', above: 1}",
        "drift takes (signal, number), 3 given. It is drift",
    ),
    ("  - {that: monodromy_trace(1), above: 1}", "monodromy_trace takes (nothing), 1 given"),
    ("  - {that: fraction(phi), above: 1}", "a condition must be a comparison, such as x >= 0"),
    ("  - {that: end(phi > 1), above: 1}", "a comparison is not a number"),
    ("  - {that: fitted(2), above: 1}", "argument 1 of fitted is a name. It is what a fit"),
    ("  - {that: fitted(phi), above: 1}", "unknown parameter 'phi'; there are: l"),
    (
        "  - {that: time(imact), above: 1}",
        "unknown event 'imact'; there are: crossing, impact, phi,",
    ),
    ("  - {that: time(phi - psi), above: 1}", "unknown signal or parameter 'psi'"),
    ("  - {that: 'motions(3, 2, v)', above: 1}", "unknown state 'v'; there are: phi, w"),
    ("  - {that: 'interp(phi, l)', above: 1}", "interp is for the formulas of block declarations"),
    ("  - {that: end(phi), above: end(w)}", "what is expected cannot read end: it is no number"),
    ("  - {that: end(phi), above: w}", "what is expected reads 'w', a signal. Compare signals in"),
    ("  - {that: end(phi), above: k}", "unknown signal or parameter 'k'"),
    (
        "  - {that: reference(end(phi)), above: 1}",
        "and the statement no 'reference'. Write reference",
    ),
    ("  - {that: end(phi*stability()), above: 1}", "stability() is a word, and no part of a form"),
    ("  - {that: stability(), is: stabel}", "5:29: unknown verdict 'stabel'; there are: neutral"),
    ("  - {that: stability(), above: 1}", "'stability()' is a word, and not above anything"),
    (f"  - {{{LIKE}, says: [a]}}", "'says' must be a text"),
    (f"  - {{{LIKE}, run: 3}}", "'run' must be a mapping. Write it like {preset: free"),
    (f"  - {{{LIKE}, run: {{rum: 3}}}}", "unknown key of 'run' 'rum'"),
    (f"  - {{{LIKE}, run: {{diagram: a.yaml}}}}", "unknown key of 'run' 'diagram'"),
    (
        f"  - {{{LIKE}, run: {{preset: lng}}}}",
        "5:46: unknown preset 'lng'; there are: long. Did you",
    ),
    (f"  - {{{LIKE}, run: {{series: one}}}}", "unknown measured series 'one'"),
    (f"  - {{{LIKE}, run: {{set: {{k: 2}}}}}}", "unknown parameter 'k'; there are: l"),
    (f"  - {{{LIKE}, run: {{start: {{psi: 2}}}}}}", "unknown state 'psi'; there are: phi"),
    (f"  - {{{LIKE}, run: {{modulo: {{psi: 2}}}}}}", "unknown state 'psi'"),
    (f"  - {{{LIKE}, run: {{samples: 1.5}}}}", "'samples' must be a whole number, not 1.5"),
    (f"  - {{{LIKE}, run: {{samples: 1}}}}", "'samples' must be 2 or more, and 1000000 at"),
    (f"  - {{{LIKE}, run: {{skip: -1}}}}", "'skip' must be a whole number, not -1"),
    (f"  - {{{LIKE}, run: {{rtol: 0}}}}", "'rtol' must be above zero, not 0"),
    (f"  - {{{LIKE}, run: {{until: phi}}}}", "'phi' is a signal, and a value is fixed"),
    (
        f"  - {{{LIKE}, run: {{direction: left}}}}",
        "unknown direction 'left'; there are: apart, both",
    ),
    (f"  - {{{LIKE}, run: {{over: {{k: 1:2:3}}}}}}", "unknown parameter 'k'; there are: l"),
    (
        f"  - {{{LIKE}, run: {{over: {{l: 1:2}}}}}}",
        "the values of 'over' are numbers or FROM:TO:COUNT",
    ),
    (
        f"  - {{{LIKE}, run: {{over: {{l: 1:2:1}}}}}}",
        "the values of 'over' are numbers or FROM:TO:CO",
    ),
    (f"  - {{{LIKE}, run: {{full: {{full: {{}}}}}}}}", "unknown key of 'full' 'full'"),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, until: 2*l}}}}",
        "a value in the setting of another diagram is a number, and not '2*l'",
    ),
    (f"  - {{{LIKE}, reference: {{diagram: no.yaml}}}}", "there is no file 'no.yaml'"),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, series: no}}}}",
        "5:61: 'series' cannot stand with 'diagram'. Leave it out, or write the statement in that",
    ),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, modulo: {{x: 1}}}}}}",
        "'modulo' cannot stand with 'diagram'",
    ),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, over: {{k: 1:2:3}}}}}}",
        "'over' cannot stand with 'diagram'",
    ),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, direction: sideways}}}}",
        "unknown direction 'sideways'; there are: apart, both",
    ),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, full: {{rubbish: 1}}}}}}",
        "unknown key of 'full' 'rubbish'",
    ),
    (
        f"  - {{{LIKE}, reference: {{diagram: a.yaml, full: {{until: l}}}}}}",
        "a value in the setting of another diagram is a number, and not 'l'",
    ),
    (
        f"  - {{{LIKE}, run: {{over: {{l: 1:2:3}}}}}}",
        "5:38: 'over' is of a bifurcation diagram, and the statement measures nothing of one. "
        "Leave it out, or measure one of band_low, band_high, irregular_beside.",
    ),
    (
        f"  - {{{LIKE}, run: {{method: shooting}}}}",
        "'method' is of a fit, and the statement measures nothing of one",
    ),
    (
        f"  - {{{LIKE}, reference: {{full: {{method: shooting}}}}}}",
        "'method' is of a fit, and the statement measures nothing of one",
    ),
    (
        "  - {that: fitted(l), above: 1, run: {method: rubbish}}",
        "5:47: unknown method 'rubbish'; there are: fminsearch, growing",
    ),
    (
        "  - {that: criterion(), above: 1, run: {start: {phi: 2}}}",
        "5:41: 'start' cannot stand with a fit, whose runs are those of the measured series",
    ),
    (
        "  - {that: criterion(), above: 1, run: {series: no}}",
        "'series' cannot stand with a fit, whose runs are those of the measured series",
    ),
    (
        "  - {that: fitted(l) - end(phi), above: 1, run: {start: {phi: 2}}}",
        "5:50: 'start' would hold in the run and not in the fit of one statement. Write two "
        "statements, or use 'preset' or 'set', which hold in both.",
    ),
    (
        "  - {that: criterion() + end(phi), above: 1, run: {series: no}}",
        "'series' would hold in the run and not in the fit of one statement",
    ),
    (
        "  - {that: 'band_low(sideways, 0.1)', above: 1}",
        "unknown word of band_low 'sideways'; there are: down, up",
    ),
    (
        f"  - {{{LIKE}}}\n  - {{{LIKE}}}",
        "6:12: two statements are called 'end(phi)'. The other one",
    ),
]


@pytest.mark.parametrize(("statements", "message"), WRONG)
def test_what_is_wrong_with_a_statement_is_told(statements: str, message: str) -> None:
    assert message in refused(BASE + statements)


def test_all_that_is_wrong_is_told_at_once() -> None:
    told = refused(BASE + "  - {that: end(psi), above: 1}\n  - {that: end(phi), is: 1}\n")
    assert "unknown signal or parameter 'psi'" in told and "needs 'within'" in told


def test_expect_belongs_to_the_top_of_a_file() -> None:
    told = refused("blocks: {}\nsubsystems: {s: {blocks: {}, expect: []}}")
    assert "unknown section of a subsystem 'expect'" in told


def test_a_statement_has_its_quantity_its_bounds_and_its_setting() -> None:
    text = (
        "  - name: A long swing\n"
        "    that: max(phi)/l\n"
        "    between: [1, 2*l]\n"
        "    source: Table 3\n"
        "    run: {preset: long, set: {l: {value: 40, unit: cm}}, until: 2*l, rtol: 1e-8,\n"
        "          modulo: {phi: 2*pi}, full: {samples: 9}}\n"
        "  - {that: 'band_low(up, 1)', below: 3, run: {over: {l: [1, 2:3:3]}}}\n"
    )
    first, second = made(BASE + text).expect
    assert first.that == Call("/", (Call("max", (Name("phi"),)), Name("l")))
    assert (first.name, first.source, first.place.line) == ("A long swing", "Table 3", 6)
    assert first.above == Number(1.0) and first.value is None
    run = first.run
    assert (run.preset, run.values["l"].factor, run.samples) == ("long", 0.01, None)
    assert second.run.over == {"l": (1.0, 2.0, 2.5, 3.0)}
    assert run.full is not None and run.full.samples == 9
    assert (second.name, second.what) == ("band_low(up, 1)", "band_low(up, 1)")


def test_a_signal_inside_a_subsystem_and_an_element_are_names() -> None:
    text = """\
blocks:
  q: {type: integrator, of: q, start: [1, 2]}
  s: {type: inner}
subsystems:
  inner: {outputs: [y], parameters: {c: 1}, blocks: {y: {type: integrator, of: y, start: 1}}}
expect:
  - {that: "max(q[1] - s.y)/s.c", above: 0}
"""
    assert len(read_text(text, Path("a.yaml")).expect) == 1
    with pytest.raises(DiagramError, match=r"unknown signal or parameter 's\.z'"):
        read_text(text.replace("s.y)", "s.z)"), Path("a.yaml"))


def test_the_setting_of_another_diagram_has_what_a_run_and_its_analyses_read(
    tmp_path: Path,
) -> None:
    (tmp_path / "other.yaml").write_text(BASE.removesuffix("expect:\n"), encoding="utf-8")
    keys = "samples: 5, edge: hit, guard: x, direction: up, skip: 3, full: {samples: 9, until: 2}"
    text = f"  - {{{LIKE}, reference: {{diagram: other.yaml, start: {{q: 1}}, {keys}}}}}\n"
    (statement,) = made(BASE + text, tmp_path / "a.yaml").expect
    found = statement.reference
    assert found is not None and found.full is not None
    assert found.file == tmp_path / "other.yaml"
    assert (found.samples, found.full.samples, list(found.start)) == (5, 9, ["q"])
    assert found.full.until == Value(Number(2.0), place=found.full.until.place)
    assert {key: found.options[key] for key in ("edge", "guard", "direction")} == {
        "edge": "hit",
        "guard": "x",
        "direction": "up",
    }


@pytest.mark.parametrize("key", SETTING)
@pytest.mark.parametrize("beside", ["", "diagram: other.yaml, "])
def test_every_key_of_a_setting_is_read_or_refused(key: str, beside: str, tmp_path: Path) -> None:
    """A mapping that holds a list is no value of any of them."""
    (tmp_path / "other.yaml").write_text("blocks: {}\n", encoding="utf-8")
    text = f"  - {{{LIKE}, reference: {{{beside}{key}: {{x: [[]]}}}}}}"
    assert refused(BASE + text, tmp_path / "a.yaml")


def test_the_methods_of_a_fit_are_those_that_a_fit_has() -> None:
    assert tuple(METHODS) == FIT_METHODS
