"""What blocks of linear systems need of vectors: realisations of transfer functions, registers.

A transfer function b(s)/a(s) of degree n is realised in observable canonical form, with a[0] = 1:

    y   = x[0] + b[0]*u
    x'  = w*(x[1], ..., x[n-1], 0) + w*(b[k]/w**k)*u - w*(a[k]/w**k)*y    for k = 1 ... n

where b has zeros in front up to the length of a. The scale w is the size of the largest pole, so
that all states are of the size of y, whatever the unit of the time; a discrete one has w = 1, and
x⁺ in the place of x'. It begins settled, with y = start and a constant input u = a[n]/b[n]*start:

    x[0] = start - b[0]*u,    x[k] = a[k]/w**k*start - b[k]/w**k*u    for k = 1 ... n-1

where u is 0 if one of a[n] and b[n] is: an integrator rests at any y.

Source: T. Kailath, Linear Systems, 1980, section 2.1; the scale is Fujiwara's bound of the roots
without its factor 2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tracewire.compile.breakpoints import bilinear, straight_lines
from tracewire.compile.elements import Elements, Mismatch, shape_text
from tracewire.formula import Call, Expression, Number

ZERO, ONE = Number(0.0), Number(1.0)


def _scalar(parts: Sequence[Elements], text: str) -> Elements:
    """one_number(u): u, which must be one number."""
    if parts[0].shape:
        what = f"its input is {shape_text(parts[0].shape)}, and it takes one number"
        raise Mismatch(f"{what}: name an element, such as [0]")
    return parts[0]


def _times(parts: Sequence[Elements], text: str) -> Elements:
    """matrix_times(M, u): a matrix times a vector; a vector in the place of M is one row."""
    matrix, vector = parts
    if not matrix.shape and matrix.items[0] == ZERO:
        return Elements((), (ZERO,))
    columns = matrix.shape[-1] if matrix.shape else 1
    if vector.shape not in ((columns,), () if columns == 1 else None):
        kind = f"a row of {columns}" if len(matrix.shape) < 2 else shape_text(matrix.shape)
        what = f"{kind} cannot be multiplied with {shape_text(vector.shape)} in '{text}'"
        raise Mismatch(f"{what}: a matrix has its rows in brackets, such as [[0], [1]]")
    rows = len(matrix.items) // columns
    items = tuple(
        _sum([_product(matrix.items[row * columns + i], vector.at(i)) for i in range(columns)])
        for row in range(rows)
    )
    return Elements(matrix.shape[:-1], items)


def _zeros(parts: Sequence[Elements], text: str) -> Elements:
    """zeros_like(u): zeros of the shape of u."""
    return Elements(parts[0].shape, (ZERO,) * len(parts[0].items))


def _shift(parts: Sequence[Elements], text: str) -> Elements:
    """shift_in(x, u): x without its first element, and u behind."""
    x, u = parts
    return Elements((len(x.items),), (*x.items[1:], u.items[0]))


def _register(parts: Sequence[Elements], text: str) -> Elements:
    """bit_register(r): 1 for each element of r that is at least 1/2, and 0 for the others."""
    bits = parts[0]
    if len(bits.shape) != 1 or bits.shape[0] < 2:
        what = f"its register is {shape_text(bits.shape)}, and it takes two bits or more"
        raise Mismatch(f"{what}: write a list, such as [1, 0, 0]")
    if all(isinstance(bit, Number) and bit.value < 0.5 for bit in bits.items):
        raise Mismatch("the bits of its register are all 0, and would stay so: write a 1 for one")
    items = tuple(Call("if", (Call(">=", (bit, Number(0.5))), ONE, ZERO)) for bit in bits.items)
    return Elements(bits.shape, items)


def _direct(parts: Sequence[Elements], text: str) -> Elements:
    """direct_gain(b, a): b[0]/a[0] where b/a has equal degrees, else 0."""
    padded, leading = _polynomials(parts)
    return Elements((), (_quotient(padded[0], leading),))


def _coefficients(parts: Sequence[Elements], text: str) -> Elements:
    """monic_coefficients(b, a, w): b[k]/(a[0]*w**k) for k from 1, b padded to the length of a."""
    padded, leading = _polynomials(parts[:2])
    w = parts[2].items[0]
    powers = (Call("**", (w, Number(float(k)))) for k in range(1, len(padded)))
    items = tuple(
        _quotient(_quotient(coefficient, leading), ONE if w == ONE else power)
        for coefficient, power in zip(padded[1:], powers, strict=True)
    )
    return Elements((len(items),), items)


def _settled(parts: Sequence[Elements], text: str) -> Elements:
    """settled_states(b, a, w): the states for an output of 1, to which the system has settled."""
    b, a = (_coefficients([part, parts[1], parts[2]], text).items for part in parts[:2])
    last_b, last_a = (_polynomials([part, parts[1]])[0][-1] for part in parts[:2])
    u = ZERO if ZERO in (last_a, last_b) else _quotient(last_a, last_b)
    direct = _direct(parts[:2], text).items
    output = (ONE, *a[:-1])
    taken = (_product(u, item) for item in (*direct, *b[:-1]))
    items = [y if x == ZERO else Call("-", (y, x)) for y, x in zip(output, taken, strict=True)]
    return Elements((len(items),), tuple(items))


def _root_scale(parts: Sequence[Elements], text: str) -> Elements:
    """root_scale(a): max over k of |a[k]/a[0]|**(1/k), and 1 where that is 0."""
    padded, leading = _polynomials([parts[0], parts[0]])
    ratios = {k: _quotient(a, leading) for k, a in enumerate(padded) if k and a != ZERO}
    if not ratios:
        return Elements((), (ONE,))
    numbers = {k: a.value for k, a in enumerate(padded) if isinstance(a, Number)}
    if len(numbers) == len(padded):
        size = max(abs(numbers[k] / numbers[0]) ** (1 / k) for k in ratios)
        return Elements((), (Number(size),))
    sizes = [Call("**", (Call("abs", (a,)), Number(1.0 / k))) for k, a in ratios.items()]
    largest = Call("max", tuple(sizes)) if len(sizes) > 1 else sizes[0]
    return Elements((), (Call("if", (Call(">", (largest, ZERO)), largest, ONE)),))


def _polynomials(parts: Sequence[Elements]) -> tuple[tuple[Expression, ...], Expression]:
    """The coefficients of b with zeros in front up to the length of a, and the first of a."""
    b, a = parts
    if len(b.shape) > 1 or len(a.shape) > 1:
        raise Mismatch("a polynomial is a list of numbers, the highest power first: [1, 0.5, 4]")
    if a.items[0] == ZERO:
        raise Mismatch("the first coefficient of the denominator is 0: leave it out")
    if len(a.items) < 2:
        raise Mismatch("the denominator has one coefficient, and so no state: use a gain")
    missing = len(a.items) - len(b.items)
    if missing < 0:
        degrees = f"degree {len(b.items) - 1}, and the denominator of degree {len(a.items) - 1}"
        what = f"the numerator is of {degrees}: it would be a derivative of its input"
        raise Mismatch(f"{what}. Give the denominator as high a degree")
    return (ZERO,) * missing + b.items, a.items[0]


def _pick(parts: Sequence[Elements], text: str) -> Elements:
    """pick_element(v, i): the element of v whose number is nearest to i."""
    vector, index = parts
    chosen = vector.items[0]
    for number, item in enumerate(vector.items[1:]):
        beyond = Call(">=", (index.items[0], Number(number + 0.5)))
        chosen = Call("if", (beyond, item, chosen))
    return Elements((), (chosen,))


def without_zero_products(formula: Expression) -> Expression:
    """The formula without what a matrix of zero is multiplied with: it does not read that."""
    if not isinstance(formula, Call):
        return formula
    if formula.function == "matrix_times" and formula.arguments[0] == ZERO:
        return ZERO
    return Call(formula.function, tuple(map(without_zero_products, formula.arguments)))


def _quotient(a: Expression, b: Expression) -> Expression:
    return a if b == ONE or a == ZERO else Call("/", (a, b))


def _product(a: Expression, b: Expression) -> Expression:
    if ZERO in (a, b):
        return ZERO
    return b if a == ONE else Call("*", (a, b))


def _sum(terms: Sequence[Expression]) -> Expression:
    total: Expression = ZERO
    for term in terms:
        if term != ZERO:
            total = term if total == ZERO else Call("+", (total, term))
    return total


REALISED: Mapping[str, Callable[[Sequence[Elements], str], Elements]] = {
    "one_number": _scalar,
    "matrix_times": _times,
    "zeros_like": _zeros,
    "shift_in": _shift,
    "bit_register": _register,
    "direct_gain": _direct,
    "monic_coefficients": _coefficients,
    "settled_states": _settled,
    "root_scale": _root_scale,
    "pick_element": _pick,
    "straight_lines": straight_lines,
    "bilinear": bilinear,
}
"""The functions of vectors that block declarations may call: {name: elements of the arguments}."""
