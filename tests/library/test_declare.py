"""A declaration is checked where it stands, and says each thing that is wrong with it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tracewire.errors import BlockError
from tracewire.formula import Call, Name, Number
from tracewire.library import Block, Effect, Input, Output, Parameter, Shape, State

GOOD: dict[str, Any] = {
    "name": "damper",
    "doc": "A damper.",
    "inputs": (Input("rate"), Input("of", many=True)),
    "parameters": (
        Parameter("c", "N m s/rad", default=1.0, low=0.0),
        Parameter("d", default="2*c"),
        Parameter("points", kind="points"),
    ),
    "states": (State("x", rate="rate - x", start="c"),),
    "outputs": (Output("force", "-c*rate - d*x + sum(of) + interp(rate, points)"),),
}


def test_a_good_declaration_has_parsed_formulas_and_feedthrough() -> None:
    block = Block(**GOOD | {"outputs": (Output("y", "x"), Output("force", "-c*rate"))})
    assert block.formulas["force"] == Call("*", (Call("neg", (Name("c"),)), Name("rate")))
    assert block.rates["x"] == Call("-", (Name("rate"), Name("x")))
    assert block.feedthrough("force") == {"rate"}
    assert block.feedthrough("y") == frozenset()
    assert block == Block(**GOOD | {"outputs": block.outputs})
    assert hash(block) == hash(Block(**GOOD | {"outputs": block.outputs}))


def test_a_block_with_an_effect_can_be_a_key() -> None:
    block = Block(
        "b",
        "A bias.",
        parameters=(Parameter("c"),),
        outputs=(Output("y", "c"),),
        effect=Effect("c"),
    )
    assert {block: 1}[block] == 1


def test_a_block_may_be_called_like_a_function_and_its_ports_may_not() -> None:
    sine = Block("sin", "A sine.", inputs=(Input("of"),), outputs=(Output("y", "sin(of)"),))
    assert sine.formulas["y"] == Call("sin", (Name("of"),))
    with pytest.raises(BlockError, match="'sin' cannot be used as a name"):
        Block("sin", "A sine.", inputs=(Input("sin"),), outputs=(Output("y", "2"),))


def output(formula: str) -> dict[str, Any]:
    return {"outputs": (Output("force", formula),)}


def parameters(*given: Parameter) -> dict[str, Any]:
    return {"parameters": given, "states": (), "outputs": (Output("y", "rate"),)}


def effect(given: Effect, *ports: Input, **more: Any) -> dict[str, Any]:
    parts = {"inputs": ports, "parameters": (Parameter("c", default=0.0),), "states": ()}
    return parts | {"outputs": (Output("y", "c"),), "effect": given} | more


def shaped(shape: Shape, name: str = "width") -> dict[str, Any]:
    default = None if name == "width" else 0.0
    both = (Parameter("c", default=0.0), Parameter("width", default=default, low=0.0))
    return effect(Effect("c", shapes={name: shape}), parameters=both)


PLAIN = Parameter("c")
COMPLAINTS: dict[str, tuple[dict[str, Any], str]] = {
    "no output": ({"outputs": ()}, "a block needs at least one output."),
    "no sentence": ({"doc": " "}, "a block needs a sentence that says what it is."),
    "block name": ({"name": "my damper"}, "'my damper' cannot be used as a name. Use letters"),
    "block name is Python's": ({"name": "lambda"}, "'lambda' cannot be used as a name"),
    "block name abroad": ({"name": "dämpfer"}, "'dämpfer' cannot be used as a name"),
    "time as port": ({"inputs": (*GOOD["inputs"], Input("t"))}, "'t' cannot be used as a name"),
    "function as output": (output("rate") | {"outputs": (Output("sum", "rate"),)}, "'sum' cannot"),
    "a port twice": ({"inputs": (*GOOD["inputs"], Input("c"))}, "'c' is declared twice."),
    "an output twice": ({"outputs": 2 * (Output("y", "rate"),)}, "'y' is declared twice."),
    "no formula": (output("rate +"), "formula 'rate +': it does not parse"),
    "a condition": (output("rate > 0"), "a comparison is not a number"),
    "unknown name": (
        output("-c*rat"),
        "unknown name 'rat'; there are: c, d, of, points, rate, t, x."
        " Did you mean 'rate'? It stands in '-c*rat'.",
    ),
    "several wires read as one": (
        output("2*of"),
        "'of' is read by sum(), product(), min(), max() or join().",
    ),
    "points compared": (output("max(rate, points)"), "'points' is read by interp(), cubic"),
    "a port without its clock": (
        {"inputs": (Input("rate", sampled="tick"), Input("of", many=True))},
        "unknown clock 'tick'; there is no clock here. It samples the port 'rate'.",
    ),
    "one wire read as several": (output("sum(rate)"), "'rate' is read by its name alone."),
    "points read as a number": (
        output("points + 1"),
        "formula 'points + 1': 'points' is read by interp(), cubic_spline() or monotone_cubic().",
    ),
    "a number read as points": (output("interp(rate, c)"), "'c' is read by its name alone."),
    "points of points": (output("interp(points, points)"), "'points' is read by interp(), cubic"),
    "rate of a state": ({"states": (State("x", "y", "0"),)}, "unknown name 'y'"),
    "start of a state": (
        {"states": (State("x", "0", "rate"),)},
        "unknown name 'rate'; there are: c, d. It stands in 'rate'.",
    ),
    "default of a port": ({"inputs": (Input("rate", default="x"), Input("of", many=True))}, "'x'"),
    "default of a later one": (
        parameters(Parameter("d", default="c"), PLAIN),
        "unknown name 'c'; there is no name here. It stands in 'c'.",
    ),
    "default of itself": (parameters(Parameter("c", default="c")), "unknown name 'c'"),
    "bounds": (
        parameters(Parameter("c", low=2, high=1)),
        "the bounds of 'c' are 2 to 1. Give the lower one first.",
    ),
    "default outside": (
        parameters(Parameter("c", default=-1.0, low=0)),
        "the default -1 of 'c' is outside 0 to inf.",
    ),
    "default not above": (
        parameters(Parameter("c", default=0.0, above=0.0)),
        "the default 0 of 'c' is not above 0.",
    ),
    "unit of a port": ({"inputs": (*GOOD["inputs"], Input("u", "foo"))}, "'foo' is not a unit."),
    "unit of a parameter": (parameters(Parameter("c", "N + m")), "'N + m' is not a unit."),
    "unit of an output": ({"outputs": (Output("y", "rate", "foo"),)}, "'foo' is not a unit."),
    "unit of a state": ({"states": (State("x", "0", "0", "foo"),)}, "'foo' is not a unit."),
    "effect without coefficient": (
        effect(Effect("k")),
        "unknown parameter 'k'; there are: c.",
    ),
    "effect of an unknown port": (
        effect(Effect("c", {"rate": "v"})),
        "unknown input 'rate'; there is no input here.",
    ),
    "effect with a loose port": (
        effect(Effect("c"), Input("rate"), Input("of"), Input("u", default="t")),
        "the effect leaves the inputs rate, of unconnected."
        " Say which local signal each reads: q, v, a, u, other_q, other_v.",
    ),
    "effect of another signal": (
        effect(Effect("c", {"rate": "w"}), Input("rate")),  # type: ignore[dict-item]
        "the effect wires 'rate' to 'w'; there are: q, v, a, u, other_q, other_v. Say which",
    ),
    "effect that needs a value": (
        effect(Effect("c"), parameters=(PLAIN, Parameter("eps"), Parameter("n", default=1.0))),
        "the effect leaves the parameters eps without a value. Give each a default, or a shape.",
    ),
    "effect with two outputs": (
        effect(Effect("c"), outputs=(Output("y", "c"), Output("z", "c"))),
        "an effect has one output, and this block has 2. Declare the others in a block",
    ),
    "effect of a third sign": (
        effect(Effect("c", sign=-1)),  # type: ignore[arg-type]
        "the sign of an effect is -1; there are: 0, 1. 1: only positive coefficients",
    ),
    "effect elsewhere": (
        effect(Effect("c", place="sensor")),  # type: ignore[arg-type]
        "unknown place of an effect 'sensor'; there are: drive, sum.",
    ),
    "effect at the drive of the rate": (
        effect(Effect("c", {"rate": "v"}, place="drive"), Input("rate")),
        "the effect acts on the drive and wires 'rate' to 'v'; there are: u. An effect at the",
    ),
    "shape of nothing": (
        shaped(Shape((1.0,)), name="s"),
        "unknown parameter 's'; there are: c, width. It is a shape.",
    ),
    "shape of the coefficient": (
        shaped(Shape((1.0,)), name="c"),
        "'c' is the coefficient of the effect, and not one of its shapes. For a coefficient in",
    ),
    "shape of an unknown size": (
        shaped(Shape((1.0,), of="W")),  # type: ignore[arg-type]
        "unknown scale 'W'; there are: Q, T, U, V, drives, dt, rates, stroke, top. It is of",
    ),
    "shape without values": (
        shaped(Shape(())),
        "the shape 'width' needs numbers to try. Say where it is tried first, such as 0.1 and 0.3.",
    ),
    "shape that is not finite": (shaped(Shape((float("inf"),))), "'width' needs numbers to try"),
    "shape below its parameter": (
        shaped(Shape((1.0,), low=-1.0)),
        "the shape 'width' may fall to -1, and the parameter only to 0. Give a 'low' that the",
    ),
    "shape tried outside": (
        shaped(Shape((1.0, 0.0), of="V", low=0.1)),
        "the shape 'width' is tried at 0, which its bounds exclude. Change the values or the",
    ),
    "coefficient tried at zero": (
        effect(Effect("c", at=Shape((0.0, 2.0), of="dt"))),
        "'c' is tried at 0. The effect vanishes there: give other values.",
    ),
}


@pytest.mark.parametrize("case", COMPLAINTS)
def test_what_is_wrong_is_said(case: str) -> None:
    changes, message = COMPLAINTS[case]
    with pytest.raises(BlockError) as caught:
        Block(**GOOD | changes)
    assert message in str(caught.value)
    assert len(caught.value.problems) == 1


def test_all_problems_of_a_block_are_told_at_once() -> None:
    with pytest.raises(BlockError) as caught:
        Block("a b", "", inputs=(Input("u", "foo"),), outputs=(Output("y", "v"),))
    assert len(caught.value.problems) == 4


def test_a_block_knows_the_line_on_which_it_is_declared() -> None:
    declared = Block(
        "two",
        "A two.",
        outputs=(Output("y", "2"),),
    )
    line = (lines := Path(__file__).read_text("utf-8").splitlines()).index(
        "    declared = Block("
    ) + 1
    assert lines[line - 1].endswith("Block(")
    assert (declared.place.file, declared.place.line) == ("test_declare.py", line)
    assert replace(declared, name="three").place == declared.place


def test_a_problem_names_the_file_the_line_and_the_block() -> None:
    with pytest.raises(BlockError) as caught:
        Block("two", "A two.", outputs=(Output("y", "x"),))
    text = Path(__file__).read_text("utf-8").splitlines()
    line = text.index('        Block("two", "A two.", outputs=(Output("y", "x"),))') + 1
    assert str(caught.value).startswith(f"test_declare.py:{line}: block 'two': unknown name 'x'")


def test_defaults_and_starts_are_parsed() -> None:
    block = Block(**GOOD | {"inputs": (*GOOD["inputs"], Input("u", default="t"))})
    assert block.defaults == {"d": Call("*", (Number(2.0), Name("c")))}
    assert block.starts == {"x": Name("c")}
    assert block.port_defaults == {"u": Name("t")}
