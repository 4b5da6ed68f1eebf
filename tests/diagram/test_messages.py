"""One text for each message about what a diagram says."""

from __future__ import annotations

import pytest
from diagram.small_library import PENDULUM, refused
from tracewire.errors import unknown

SECTIONS = [
    ("title: Run 2: short\nblocks: {}", 'A text with a colon needs quotes, such as title: "Run 2'),
    ("titel: x\nblocks: {}", "1:1: unknown section 'titel'; there are: blocks, events, every"),
    ("titel: x\nblocks: {}", "Did you mean 'title'?"),
    ("outputs: [a]\nblocks: {}", "It belongs to a subsystem"),
    ("start: {x: 1}\nblocks: {}", "A start value stands at its block: x: {type: integrator"),
    ("title: x", "a diagram needs 'blocks'. Write blocks: ..."),
    ("title: [x]\nblocks: {}", "1:8: 'title' must be a text"),
    ("blocks: [a]", "1:9: 'blocks' must be a mapping. Write it like {column: {type: gain"),
    ("blocks: {}\nsubsystems: {a: {span: [0, 1]}}", "Some sections belong to the top of the file"),
    ("blocks: {}\nsubsystems: {a: b}", "2:17: block 'a': subsystem 'a' must be a mapping"),
    ("blocks: {}\nsubsystems: {2a: {}}", "'2a' cannot be the name of a subsystem"),
    ("blocks: {}\nsubsystems: {gain: {}}", "a subsystem here, and a block of the library"),
    ("blocks: {}\nspan: 3", "2:7: 'span' must be a pair of times. Write it like [0, 40]."),
    ("blocks: {}\nspan: [3, 1]", "the span ends at 1 s, not after its begin at 3 s"),
    ("blocks: {}\nevery: 0", "'every' must be above zero, not 0 s"),
    ("blocks: {}\nrequire: a > 0", "2:10: 'require' must be a list of comparisons. Write it like"),
    ("blocks: {}\nrequire: [2*3]", "2:11: formula '2*3': a condition must be a comparison"),
    ("blocks: {}\nrequire: [m > 0]", "2:11: unknown parameter 'm'"),
    ("blocks: {}\nrequire: [[m]]", "2:11: a formula must be a text"),
    ("blocks: {a: {type: gain, of: a}}\nrequire: [a > 0]", "'a' is a signal, and a value is fixed"),
    ("blocks: {}\nsubsystems: {a: {require: [1 > 0]}}", "belong to the top of the file only"),
    ("blocks: {}\nrecord: {a: b}", "'record' must be a list of names. Write it like [a, b]."),
    ("blocks: {}\nrecord: [[a]]", "an entry of 'record' must be a name"),
    ("blocks: {}\nrecord: [a]", "2:10: unknown signal 'a'; there is no signal here"),
    ("blocks: {o: {type: oscillator}}\nrecord: [o]", "'o' has 2 outputs; there are: o.x, o.force"),
    (PENDULUM.replace("bearing.friction]", "bearing.fricton]"), "Did you mean 'bearing.friction'?"),
    (PENDULUM.replace("bearing.friction]", "bearing.rate]"), "unknown signal 'bearing.rate'"),
]
VALUES = [
    ("{a: [1]}", "1:17: a value is a number, a formula, or a mapping, and not a list"),
    ("{a: {vale: 1}}", "1:18: unknown key of a value 'vale'; there are: fit, unit, value."),
    ("{a: {unit: m}}", "1:17: a value in a mapping needs 'value'"),
    ("{a: {value: [1]}}", "a formula must be a text, such as 2*k"),
    ("{a: {value: 1, unit: foo}}", "1:34: 'foo' is not a unit"),
    ("{a: {value: 1, unit: [m]}}", "a unit must be a text"),
    ("{a: {value: 1, fit: 3}}", "the bounds of a fit are two numbers. Write fit: [low, high]"),
    ("{a: {value: 1, fit: [0, x]}}", "a bound of a fit must be a number, not 'x'"),
    ("{a: {value: 1, fit: [3, 0]}}", "the lower bound 3 is not below the upper bound 0"),
    ("{a: {value: 5, fit: [0, 3]}}", "the value 5 is outside of its bounds 0 to 3"),
    ("{a: 2*}", "1:17: formula '2*': it does not parse"),
    ("{a: '2 + $'}", "1:22: formula '2 + $': it does not parse"),
    ("{a: bb, b: 1}", "1:17: unknown parameter 'bb'; there are: a, b."),
    ("{a: 2*t}", "'t' is the time, and a value is fixed"),
    ("{a: sum(a)}", "sum is for the formulas of block declarations"),
    ("{a: 1e999}", "too large for double precision"),
    ("{a: b, b: c, c: a}", "parameters depend on each other: a -> b -> c -> a. Give one of them"),
    ("{a: a + 1}", "parameters depend on each other: a -> a"),
    ("{if: 1}", "1:14: 'if' cannot be the name of a parameter. 'if' is a word"),
    ("[1]", "'parameters' must be a mapping"),
]
BLOCKS = [
    ("a: 3", "1:13: block 'a': it must be a mapping. Write it like {type: gain"),
    ("a: {of: a}", "it needs 'type'"),
    ("a: {type: [gain]}", "a type must be a text"),
    ("a: {type: gian}", "1:20: block 'a': unknown block type 'gian'; there are: expression, gain"),
    ("a: {type: gian}", "Did you mean 'gain'?"),
    ("a: {type: xyzzy}", "Blocks of your own come with --library FILE."),
    (
        "a: {type: gain, of: a, kk: 1}",
        "unknown input or parameter of 'gain' 'kk'; there are: k, of",
    ),
    (
        "a: {type: gain, of: a, k: 1, units: m}",
        "unknown input or parameter of 'gain' 'units'; there are: k, of, unit. Did you mean 'unit'",
    ),
    ("a: {type: gain, of: i, k: 1, unit: foo}", "'foo' is not a unit"),
    ("a: {type: gain, k: 1}", "1:10: block 'a': input 'of' is not connected. Write of: signal."),
    ("a: {type: sum}", "input 'of' is not connected. Write of: [a, b]."),
    ("a: {type: gain, of: i}", "parameter 'k' is not given. Write k: ..."),
    ("a: {type: gain, of: b, k: 1}", "1:30: block 'a': unknown signal 'b'; there are: a, i."),
    ("a: {type: gain, of: i.z, k: 1}", "unknown output 'i.z'; there are: i.y."),
    ("a: {type: gain, of: o, k: 1}, o: {type: oscillator}", "block 'o' has 2 outputs; there are"),
    ("a: {type: gain, of: s, k: 1}, s: {type: silent}", "block 's' has no outputs"),
    (
        "a: {type: gain, of: p, k: 1}",
        "'p' is a parameter, and not a signal. Put it into a block of",
    ),
    ("a: {type: gain, of: t, k: 1}", "'t' is the time, and not a signal"),
    ("a: {type: gain, of: 3, k: 1}", "input 'of' takes a signal, not the number 3"),
    (
        "a: {type: gain, of: 2*i, k: 1}",
        "input 'of' takes a signal, not '2*i'. Put the formula into",
    ),
    ("a: {type: gain, of: [i, i], k: 1}", "input 'of' takes one signal. Connect several"),
    ("a: {type: gain, of: i, k: i}", "'i' is a signal, and a value is fixed"),
    ("a: {type: expression, formula: u}", "unknown signal or parameter 'u'; there are: a, i, p, t"),
    ("a: {type: expression, formula: {b: i}}", "a formula must be a text"),
    ("a: {type: expression, formula: [i, {b: i}]}", "a formula must be a text"),
    ("a: {type: expression, formula: []}", "a vector has at least one element"),
    ("a: {type: expression, formula: [[i, i], [i]]}", "a matrix has rows of one length, and row 1"),
    ("a: {type: expression, formula: [[i, [i]]]}", "a list of matrices is no matrix"),
    ("a: {type: expression, formula: join(i)}", "Use a block of type mux, or write the list [a,"),
    ("a: {type: expression, formula: 'i[x]'}", "unknown signal or parameter 'x'"),
    ("a: {type: gain, of: 'i[-1]', k: 1}", "input 'of' takes a signal, not 'i[-1]'"),
    ("a: {type: gain, of: 'j[1]', k: 1}", "unknown signal 'j'; there are:"),
    ("a: {type: gain, of: i[1], k: 1}", 'needs quotes between brackets: {of: "q[1]"}'),
    ("a: {type: gain, of: i, k: []}", "a vector has at least one element"),
    ("a: {type: gain, of: i, k: 'p[0]'}", "a value is made of numbers, which have no elements"),
    ("a: {type: gain, of: i, k: [1, [2]]}", "a value is a number, a formula, or a mapping, and"),
    ("a: {type: viscous, rate: i, c: [1, -2]}", "'c' must be at least 0 N m s/rad, not -2"),
    ("a: {type: gain, of: i, k: 1, guess: i}", "'i' is a signal, and a value is fixed"),
    ("a: {type: gain, of: i, k: 1, guess: {value: 1, fit: free}}", "unknown key of a value 'fit'"),
    ("a: {type: viscous, rate: i, c: -1}", "'c' must be at least 0 N m s/rad, not -1"),
    ("a: {type: viscous, rate: i, c: 1e3}", "'c' must be at most 100 N m s/rad, not 1000"),
    ("a: {type: gain, of: i, k: 1, place: {q: i}}", "only a sum has 'place', and 'a' is a gain"),
    ("a: {type: sum, of: i, place: {q: j}}", "unknown signal 'j'"),
    ("a: {type: sum, of: i, place: {if: i}}", "'if' cannot be a symbol of a place"),
    ("a: {type: sum, of: i, place: q}", "'place' must be a mapping"),
    ("p: {type: sum, of: i}", "two definitions of 'p': a block here, and a parameter in line 2"),
    ("2a: {type: sum, of: i}", "1:10: '2a' cannot be the name of a block"),
    ("a: {type: lookup, of: i, points: 3}", "a table of points must be a list of pairs"),
    ("a: {type: lookup, of: i, points: [1, 2]}", "a point must be a pair [x, y]"),
    ("a: {type: lookup, of: i, points: [[0, x], [1, 2]]}", "a coordinate of a point must be a num"),
    ("a: {type: lookup, of: i, points: [[1, 2]]}", "a table needs at least two points"),
    ("a: {type: lookup, of: i, points: [[1, 2], [1, 3]]}", "ascend in x, and 1 is not above 1"),
    ("a: {type: lookup, of: i, points: {file: no.csv}}", "a table from a file needs 'x'"),
    ("a: {type: lookup, of: i, points: {file: no.csv, x: a, y: b}}", "no.csv"),
]
BLOCKS += [
    ("a: {type: sum, of: [i], signs: +}", "there are: of. Write a minus before a signal: of: [a, "),
    ("a: {type:gain, of: i, k: 1}", "A blank stands behind a colon: type: gain."),
    ("a: {of: i}", "block 'a': it needs 'type'. Write type: ..."),
]
SUBSYSTEMS = [
    ("outputs: {y: z}", "block 's': unknown signal 'z'; there are: i, k, o.force, o.x, u."),
    ("outputs: {2y: k}", "'2y' cannot be the name of an output"),
    ("outputs: [k, k]", "two definitions of the output 'k'"),
    ("outputs: {u: k}", "two definitions of 'u': an output here, and an input in line"),
    ("outputs: {k: -k}", "two definitions of 'k': an output here, and a block in line"),
    ("outputs: {y: [k]}", "output 'y' takes one signal"),
    ("parameters: {type: 1}", "'type' cannot be the name of a parameter of a subsystem"),
    ("events: {a: b}", "'events' must be a list"),
    ("events: [3]", "an event must be a mapping"),
    ("events: [{when: k, set: {i: 0}, cross: up}]", "unknown key of an event 'cross'"),
    ("events: [{when: k, set: {i: 0}, crosses: upp}]", "unknown direction 'upp'; there are: both"),
    ("events: [{set: {i: 0}}]", "an event needs 'when'"),
    ("events: [{when: k}]", "an event needs 'set'"),
    ("events: [{when: k, set: {}}]", "an event must set a state"),
    ("events: [{when: not k > 0, set: {i: 0}}]", "an event happens where one comparison becomes"),
    ("events: [{when: kk, set: {i: 0}}]", "unknown signal or parameter 'kk'"),
    ("events: [{when: k, set: {j: 0}}]", "unknown state 'j'; there are: i, o.v, o.x."),
    ("events: [{when: k, set: {k: 0}}]", "block 'k' has no states, and an event sets one; there"),
    ("events: [{when: k, set: {o: 0}}]", "block 'o' has 2 states, and an event sets one; there"),
    ("events: [{when: k, set: {o.z: 0}}]", "unknown state 'o.z'; there are: i, o.v, o.x."),
    ("events: [{when: o.top, set: {o.z: 0}}]", "unknown state 'o.z'"),
    (
        "events: [{when: o.tip, set: {i: 0}}]",
        "unknown event or output 'o.tip'; there are: o.force, o.top, o.x. Did you mean 'o.top'?",
    ),
    ("events: [{when: k.top, set: {i: 0}}]", "unknown output 'k.top'; there are: k.y."),
    (
        "events: [{when: o.top, crosses: up, set: {i: 0}}]",
        "'o.top' is an event of a block, which has a direction of its own. Take 'crosses' away.",
    ),
    ("events: [{when: o.top + 1, set: {i: 0}}]", "unknown output 'o.top'"),
    ("events: [{when: k, every: 1, set: {i: 0}}]", "an event has 'every' or 'when', and not both"),
    ("events: [{crosses: up, every: 1, set: {i: 0}}]", "an event has 'every' or 'crosses'"),
    ("events: [{when: k, offset: 1, set: {i: 0}}]", "only a clock has 'offset'. Write every: ..."),
    ("events: [{every: 0, set: {i: 0}}]", "the period of a clock must be above zero, not 0 s"),
    ("events: [{every: {value: -1, unit: ms}, set: {i: 0}}]", "above zero, not -0.001 s"),
    ("events: [{every: k, set: {i: 0}}]", "'k' is a signal, and a value is fixed"),
]
PRESETS = [
    ("{x: {kk: 2}}", "unknown parameter 'kk'; there are: b.c, d.c, k. Did you mean 'k'?"),
    ("{x: {b.cc: 2}}", "unknown parameter 'b.cc'"),
    (
        "{x: {g.k: 2}}",
        "'g.k' is not a parameter that can be set. Write k: {value: ...} in the block",
    ),
    ("{x: {b.g.k: 2}}", "'b.g.k' is not a parameter that can be set"),
    ("{x: {g.k.z: 2}}", "unknown parameter 'g.k.z'"),
    ("{x: {k: {value: 2, fit: free}}}", "unknown key of a value 'fit'"),
    ("{x: {k: [2]}}", "a value is a number"),
    ("{x: 2}", "preset 'x' must be a mapping"),
]


@pytest.mark.parametrize(("text", "message"), SECTIONS)
def test_sections(text: str, message: str) -> None:
    assert message in refused(text)


@pytest.mark.parametrize(("parameters", "message"), VALUES)
def test_values(parameters: str, message: str) -> None:
    assert message in refused(f"parameters: {parameters}\nblocks: {{}}")


def test_a_name_that_is_refused_is_not_refused_as_a_function_too() -> None:
    use = "blocks: {f: {type: gain, of: x, k: dry}, x: {type: integrator, of: f}}"
    told = refused(f"parameters: {{dry: 3}}\n{use}")
    assert "'dry' cannot be the name of a parameter" in told
    assert "is a function" not in told
    assert "dry is a function. Write dry(...)." in refused(use)


@pytest.mark.parametrize(("block", "message"), BLOCKS)
def test_blocks(block: str, message: str) -> None:
    more = "i: {type: integrator, of: i}"
    silent = "subsystems: {silent: {blocks: {x: {type: integrator, of: x}}}}"
    text = f"blocks: {{{block}, {more}}}\nparameters: {{p: 1}}\n{silent}"
    assert message in refused(text)


@pytest.mark.parametrize(("line", "message"), SUBSYSTEMS)
def test_subsystems(line: str, message: str) -> None:
    text = f"""
blocks: {{}}
subsystems:
  s:
    inputs: [u]
    {line}
    blocks:
      k: {{type: gain, of: u, k: 1}}
      i: {{type: integrator, of: k}}
      o: {{type: oscillator}}
"""
    assert message in refused(text)


@pytest.mark.parametrize(("presets", "message"), PRESETS)
def test_presets(presets: str, message: str) -> None:
    text = f"""
inputs: [u]
parameters: {{k: 1}}
blocks:
  g: {{type: gain, of: u, k: 1}}
  d: {{type: viscous, rate: u, c: {{value: 1}}}}
  b: {{type: s}}
subsystems:
  s:
    parameters: {{c: 1}}
    blocks: {{g: {{type: gain, of: i, k: 1}}, i: {{type: integrator, of: g}}}}
presets: {presets}
"""
    assert message in refused(text)


def test_all_problems_come_together_in_the_order_of_lines() -> None:
    text = PENDULUM.replace("of: omega,", "off: omega,").replace("1/J", "1/I").replace("up,", "in,")
    lines = refused(text).splitlines()
    assert [line.split(":")[1] for line in lines] == ["11", "11", "17", "30"]


def test_one_mistake_gives_one_problem() -> None:
    for right, wrong in {
        "type: integrator, of: alpha": "type: integrater, of: alpha",
        "value: 3.1e-3, unit: N m/rad": "value: 3.1e-3, unit: N m/radd",
        "value: 4.2e-4": "value: 4.2f-4",
        "{torque: total}": "{torque: totl}",
        "-slip*sign(rate)": "-slip*sgn(rate)",
        "rate: omega}": "rte: omega, rate: omega}",
    }.items():
        assert right in PENDULUM
        assert len(refused(PENDULUM.replace(right, wrong)).splitlines()) == 1


def test_very_many_problems_are_counted() -> None:
    lines = [f"  a{i}: {{type: gain, of: zz{i}, k: 1}}" for i in range(250)]
    told = refused("\n".join(["blocks:", *lines])).splitlines()
    assert len(told) == 101
    assert told[-1] == "<text>: and 150 more problems."


def test_a_long_name_is_shown_in_part() -> None:
    told = refused(f"blocks: {{a: {{type: {'x' * 5000}}}}}")
    assert len(told) < 400 and "xxx..." in told


def test_a_reserved_name_is_no_input_of_a_subsystem() -> None:
    told = refused("blocks: {}\nsubsystems: {s: {inputs: {unit: {}}, blocks: {}}}")
    assert "'unit' cannot be the name of an input of a subsystem" in told
    assert refused("blocks: {}\ninputs: {unit: {}}") == ""


def test_an_input_of_the_diagram_is_a_mapping_of_unit_and_default() -> None:
    assert "unknown key of an input 'units'" in refused("blocks: {}\ninputs: {a: {units: m}}")
    said = refused("blocks: {}\ninputs: {a: {sigma: 0.1}}")
    assert "It belongs to the record: measured: {run: {inputs: {...}}}." in said
    assert "input 'a' must be a mapping" in refused("blocks: {}\ninputs: {a: m}")
    told = refused("blocks: {}\ninputs: [a, a]")
    assert "two definitions of 'a': an input here, and an input in line 2" in told


def test_a_word_of_a_name_is_enough_to_propose_it() -> None:
    known = ["gain", "dry_friction", "asym_coulomb", "coulomb_smooth"]
    assert str(unknown("block", "dry", known)).endswith("Did you mean 'dry_friction'?")
    message = str(unknown("block", "Smooth", known))
    assert message.endswith("Did you mean 'coulomb_smooth'?")
