"""From text to a formula: Python's own grammar, and only the nodes that we know."""

from __future__ import annotations

import ast
import contextlib
import keyword
import math
import re
import warnings
from functools import lru_cache

from tracewire.errors import FormulaError, Location, Problem, unknown
from tracewire.formula.expression import Call, Expression, Name, Number
from tracewire.formula.functions import CONSTANTS, FUNCTIONS
from tracewire.formula.limits import LIMITS
from tracewire.formula.quantities import QUANTITIES, Quantity
from tracewire.formula.units import read_unit

ARITHMETIC: dict[type[ast.operator], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}
RELATIONS: dict[type[ast.cmpop], str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
INSTEAD: dict[type[ast.operator], str] = {
    ast.BitXor: "Write ** for a power.",
    ast.Mod: "Write mod(a, b).",
    ast.FloorDiv: "Write floor(a/b).",
}
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
WITH_UNIT = re.compile(r"(?<![\w.])(\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s*([A-Za-z%]+)(?![\w.(])")
ONLY_WITH_UNIT = re.compile(r"([+-]?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s+([A-Za-z%].*)")
TWO_FACTORS = re.compile(r"(?<![\w.])(\d+(?:\.\d*)?)\s*([A-Za-z_]\w*|\()")
OTHERWISE: dict[str, tuple[str, str]] = {
    "&&": ("'&&'", "Write and."),
    "||": ("'||'", "Write or."),
    "?": ("'?'", "Write a if c else b for c ? a : b."),
    "'": ("a prime", "The rate of a state is what its integrator reads: name that signal."),
    "!": ("'!'", "Write not."),
    "=": ("'='", "A formula is what stands on the right of the sign: leave the rest out."),
}
"""Signs of other languages: what they are called, and what to write."""
ZEROS = re.compile(r"(?<![\w.])0+([1-9]\d*)(?![\w.])")
DECIMAL = re.compile(r"([+-]?\d+),(\d+)")
BY_NAME = {"wires": "a port", "points": "a table of points"}
LANGUAGE = (
    "A formula knows + - * / **, < <= > >=, and/or/not, 'a if c else b' and: "
    + ", ".join(name for name, function in FUNCTIONS.items() if not function.instead)
    + "."
)
OF_QUANTITIES = f"Quantities are: {', '.join(QUANTITIES)}."


def is_name(text: str) -> bool:
    """Whether a block, parameter or port may be called this: letters, digits, `_`, not reserved.

    Reserved are the words of the formula language, those of Python, and names that begin with `__`.
    """
    reserved = keyword.iskeyword(text) or text in CONSTANTS or text in FUNCTIONS or text == "t"
    return bool(NAME.fullmatch(text)) and not reserved and not text.startswith("__")


def name_hint(text: str) -> str:
    """What to do about a name for which `is_name` is false."""
    if NAME.fullmatch(text) and not text.startswith("__"):
        return f"'{text}' is a word of formulas: choose another one, such as {text}_1."
    return "Use the letters a to z, digits and _, no digit in front, and no __."


def number_hint(text: str) -> str:
    """What to write in place of a text that is meant as a number; '' where that is not clear."""
    decimal, zeros, word = DECIMAL.fullmatch(text), ZEROS.search(text), text.lstrip("+-").lower()
    if decimal:
        return f"Write {decimal[1]}.{decimal[2]}: a point stands before the decimals."
    if zeros:
        return f"Write {zeros[1]}."
    if word in ("nan", "inf", "infinity", "null", "none"):
        return "A value is a finite number: write one."
    answer = {"yes": 1, "on": 1, "true": 1, "no": 0, "off": 0, "false": 0}.get(word)
    return "" if answer is None else f"A value is a number: write {answer}."


class _Refused(Exception):
    """A part of the text that is outside the language."""

    def __init__(self, what: str, column: int = 0, hint: str = "") -> None:
        super().__init__(what)
        self.what, self.column, self.hint = what, column, hint


def parse(text: str, place: Location = Location()) -> Expression:
    """The formula that `text` writes.

    `place` is where the text begins in its file; errors point into the text from there.
    Raises FormulaError: not a formula, an unknown function, a wrong number of arguments, too large,
    a condition where a number is meant.
    """
    return _read(text, place, condition=False)


def parse_condition(text: str, place: Location = Location()) -> Expression:
    """The condition that `text` writes: comparisons joined by and, or, not.

    Raises FormulaError as `parse` does, and where the text is a number and no condition.
    """
    return _read(text, place, condition=True)


def parse_quantity(text: str, place: Location = Location()) -> Expression:
    """The quantity that `text` writes: a formula that knows the functions of QUANTITIES, too.

    Raises FormulaError as `parse` does.
    """
    return _read(text, place, condition=False, quantity=True)


def _read(text: str, place: Location, condition: bool, quantity: bool = False) -> Expression:
    try:
        return _parse(text, condition, quantity)
    except _Refused as refused:
        column = place.column + refused.column if place.column else 0
        at = Location(place.file, place.line, column, place.block)
        shown = text if len(text) <= 80 else text[:77] + "..."
        problem = Problem(f"formula '{shown}': {refused.what}", at, (), refused.hint)
        raise FormulaError([problem]) from None


@lru_cache(maxsize=4096)
def _parse(text: str, condition: bool, quantity: bool) -> Expression:
    if len(text) > LIMITS.most_characters:
        most = LIMITS.most_characters
        raise _Refused(f"it has {len(text)} characters, at most {most} are allowed")
    if not text.strip():
        raise _Refused("there is no text", 0, LANGUAGE)
    if "#" in text:
        raise _Refused("a formula holds no comment", text.index("#"), "")
    if "\x00" in text or len(text.strip().splitlines()) > 1:
        raise _Refused("it must stand on one line of text")
    lead = len(text) - len(text.lstrip())
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's advice on its own grammar is not ours
            tree = ast.parse(text.strip(), mode="eval")
    except SyntaxError as error:
        column = lead + max((error.offset or 1) - 1, 0)
        raise _what_was_meant(text) or _Refused(
            f"it does not parse ({error.msg})", column, LANGUAGE
        ) from None
    except (ValueError, RecursionError, MemoryError):
        raise _Refused("it does not parse (nested too deeply, or no text)") from None
    converter = _Converter(lead, quantity)
    return converter.condition(tree.body, 0) if condition else converter.value(tree.body, 0)


def _what_was_meant(text: str) -> _Refused | None:
    """What to say of a number with a unit or with zeros in front, of a sign of another language,
    or of a product without a sign; None where that is not it."""
    alone = ONLY_WITH_UNIT.fullmatch(text.strip())
    if alone is not None:
        with contextlib.suppress(FormulaError):
            read_unit(alone[2])
            hint = f"Write it as a value: {{value: {alone[1]}, unit: {alone[2]}}}."
            return _Refused("a number in a formula has no unit", 0, hint)
    for found in WITH_UNIT.finditer(text):
        number, unit = found.groups()
        with contextlib.suppress(FormulaError):
            read_unit(unit)
            hint = f"Numbers are in SI: make a parameter of it, {{value: {number}, unit: {unit}}}."
            if unit in CONSTANTS:
                hint = f"Write {number}*{unit}."
                return _Refused("a product needs a sign", found.start(), hint)
            return _Refused("a number in a formula has no unit", found.start(), hint)
    zeros = ZEROS.search(text)
    if zeros is not None:
        return _Refused("a number has zeros in front", zeros.start(), f"Write {zeros.group(1)}.")
    for sign, (called, hint) in OTHERWISE.items():
        at = re.search(rf"(?<![<>=!]){re.escape(sign)}(?!=)", text)
        if at is not None:
            return _Refused(f"{called} is not part of the formula language", at.start(), hint)
    product = TWO_FACTORS.search(text)
    if product is None:
        return None
    hint = f"A product needs a sign: {product[1]}*{product[2]}."
    return _Refused("it does not parse", product.start(), hint)


class _Converter:
    """Turns the nodes of Python's grammar into ours, counting them."""

    def __init__(self, lead: int, quantity: bool) -> None:
        self.lead, self.count, self.quantity = lead, 0, quantity

    def refuse(self, node: ast.AST, what: str, hint: str = LANGUAGE) -> _Refused:
        return _Refused(what, self.lead + getattr(node, "col_offset", 0), hint)

    def convert(self, node: ast.expr, depth: int) -> Expression:
        self.count += 1
        if depth > LIMITS.most_nesting:
            what = f"it is nested deeper than {LIMITS.most_nesting}"
            raise self.refuse(node, what, "Use several blocks.")
        if self.count > LIMITS.most_parts:
            what = f"it has more than {LIMITS.most_parts} parts"
            raise self.refuse(node, what, "Use several blocks.")
        match node:
            case ast.Constant(value=value):
                return self.number(node, value)
            case ast.Name() | ast.Attribute():
                return Name(self.path(node))
            case ast.UnaryOp(op=op, operand=operand):
                return self.unary(node, op, operand, depth + 1)
            case ast.BinOp(left=left, op=op, right=right):
                return self.binary(node, op, left, right, depth)
            case ast.BoolOp(op=op, values=values):
                sign = "and" if isinstance(op, ast.And) else "or"
                return Call(sign, tuple(self.condition(value, depth + 1) for value in values))
            case ast.Compare():
                return self.compare(node, depth)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                condition = self.condition(test, depth + 1)
                return Call(
                    "if",
                    (condition, self.value(body, depth + 1), self.value(orelse, depth + 1)),
                )
            case ast.Call():
                return self.call(node, depth)
            case ast.Subscript(value=vector, slice=index):
                if not isinstance(vector, ast.Name | ast.Attribute):
                    hint = "Write q[0], or M[0, 1] for an element of a matrix."
                    raise self.refuse(node, "an index stands behind a name", hint)
                return Call("[]", (Name(self.path(vector)), *self.indices(index)))
            case ast.Tuple(elts=[ast.Constant(value=int(whole)), ast.Constant(value=int(part))]):
                hint = f"Write {whole}.{part}: a point stands before the decimals."
                raise self.refuse(node, "a comma is no decimal point", hint)
            case _:
                what = type(node).__name__.lower()
                raise self.refuse(node, f"a {what} is not part of the formula language")

    def indices(self, node: ast.expr) -> list[Expression]:
        """The indices of an element: whole numbers from 0, or names of parameters of a block."""
        found: list[Expression] = []
        for part in node.elts if isinstance(node, ast.Tuple) else [node]:
            match part:
                case ast.Constant(value=int(value)) if not isinstance(value, bool) and value >= 0:
                    found.append(Number(float(value)))
                case ast.Name():
                    found.append(Name(self.path(part)))
                case _:
                    hint = "Write q[0] for the first element, and M[0, 1] for one of a matrix."
                    raise self.refuse(part, "an index is a whole number from 0 on", hint)
        return found

    def number(self, node: ast.expr, value: object) -> Number:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.refuse(node, f"{value!r} is not a number")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.refuse(node, "the number is too large for double precision", "")
        return Number(number)

    def path(self, node: ast.expr) -> str:
        parts: list[str] = []
        part = node
        while isinstance(part, ast.Attribute):
            parts.append(part.attr)
            part = part.value
        if not isinstance(part, ast.Name):
            raise self.refuse(node, "a dot may only join names")
        parts.append(part.id)
        for name in parts:
            if name in FUNCTIONS:
                raise self.refuse(node, f"{name} is a function", f"Write {name}(...).")
            if not NAME.fullmatch(name) or name.startswith("__"):
                hint = "Use the letters a to z, digits and _, and no __ in front."
                raise self.refuse(node, f"'{name}' cannot be a name", hint)
        return ".".join(reversed(parts))

    def unary(self, node: ast.UnaryOp, op: ast.unaryop, term: ast.expr, depth: int) -> Expression:
        if isinstance(op, ast.Not):
            return Call("not", (self.condition(term, depth),))
        if isinstance(op, ast.Invert):
            raise self.refuse(node, "the sign '~' is not part of the formula language")
        operand = self.value(term, depth)
        if isinstance(op, ast.UAdd):
            return operand
        return Number(-operand.value) if isinstance(operand, Number) else Call("neg", (operand,))

    def binary(
        self, node: ast.BinOp, op: ast.operator, left: ast.expr, right: ast.expr, depth: int
    ) -> Expression:
        sign = ARITHMETIC.get(type(op))
        if sign is None:
            hint = INSTEAD.get(type(op), LANGUAGE)
            raise self.refuse(node, "an operator is not part of the formula language", hint)
        return Call(sign, (self.value(left, depth + 1), self.value(right, depth + 1)))

    def value(self, node: ast.expr, depth: int) -> Expression:
        converted = self.convert(node, depth)
        if is_condition(converted):
            raise self.refuse(node, "a comparison is not a number", "Write 'a if c else b'.")
        return converted

    def condition(self, node: ast.expr, depth: int) -> Expression:
        converted = self.convert(node, depth)
        if not is_condition(converted):
            raise self.refuse(node, "a condition must be a comparison, such as x >= 0")
        return converted

    def compare(self, node: ast.Compare, depth: int) -> Expression:
        terms = [self.value(term, depth + 1) for term in (node.left, *node.comparators)]
        parts: list[Expression] = []
        for op, left, right in zip(node.ops, terms, terms[1:], strict=False):
            sign = RELATIONS.get(type(op))
            if sign is None:
                hint = "Signals are real numbers: compare with <= or >=, or use a band."
                raise self.refuse(node, "only < <= > >= compare signals", hint)
            parts.append(Call(sign, (left, right)))
        return parts[0] if len(parts) == 1 else Call("and", tuple(parts))

    def call(self, node: ast.Call, depth: int) -> Expression:
        if not isinstance(node.func, ast.Name):
            raise self.refuse(node, "only named functions can be called")
        name = node.func.id
        function = FUNCTIONS.get(name)
        quantity = QUANTITIES.get(name) if self.quantity else None
        if quantity is not None and (function is None or len(node.args) < function.least):
            return self.call_quantity(node, name, quantity, depth)
        if function is None:
            known = FUNCTIONS | QUANTITIES if self.quantity else FUNCTIONS
            problem = unknown("function", name, known)
            hint = OF_QUANTITIES if self.quantity else LANGUAGE
            raise self.refuse(node, problem.what, problem.hint or hint)
        if node.keywords or any(isinstance(argument, ast.Starred) for argument in node.args):
            raise self.refuse(node, f"arguments of {name} are given by position", "")
        given = len(node.args)
        if given < function.least or (function.most is not None and given > function.most):
            wanted = f"{function.least} argument{'s' if function.least > 1 else ''}"
            wanted = wanted if function.most else f"at least {wanted}"
            raise self.refuse(node, f"{name} takes {wanted}, {given} given", "")
        arguments = tuple(self.value(argument, depth + 1) for argument in node.args)
        if function.reads and not isinstance(arguments[-1], Name):
            raise self.refuse(node, f"{name} reads {BY_NAME[function.reads]} by its name", "")
        return Call(name, arguments)

    def call_quantity(self, node: ast.Call, name: str, known: Quantity, depth: int) -> Expression:
        if node.keywords or any(isinstance(argument, ast.Starred) for argument in node.args):
            raise self.refuse(node, f"arguments of {name} are given by position", "")
        given, most = len(node.args), None if known.more else len(known.takes)
        if given < known.least or (most is not None and given > most):
            told = ", ".join(known.takes) or "nothing"
            raise self.refuse(node, f"{name} takes ({told}), {given} given", f"It is {known.doc}.")
        found: list[Expression] = []
        for n, argument in enumerate(node.args):
            match known.kind(n):
                case "condition":
                    found.append(self.condition(argument, depth + 1))
                case "happening":
                    found.append(self.convert(argument, depth + 1))
                case "word" | "parameter":
                    if not isinstance(argument, ast.Name | ast.Attribute):
                        what = f"argument {n + 1} of {name} is a name"
                        raise self.refuse(argument, what, f"It is {known.doc}.")
                    found.append(Name(self.path(argument)))
                case _:
                    found.append(self.value(argument, depth + 1))
        return Call(name, tuple(found))


def is_condition(expression: Expression) -> bool:
    """Whether the formula is true or false and not a number."""
    relations = ("<", "<=", ">", ">=", "and", "or", "not")
    return isinstance(expression, Call) and expression.function in relations
