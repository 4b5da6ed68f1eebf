"""Vectors: signals of several numbers. Every other block works on them element by element."""

from tracewire.library import Block, Input, Output, Parameter

mux = Block(
    name="mux",
    doc="The vector of several signals and vectors, end to end.",
    inputs=(Input("of", doc="the elements, in order", many=True),),
    outputs=(Output("y", "join(of)"),),
)

demux = Block(
    name="demux",
    doc="One element of a vector, as q[1] is one of q wherever a signal is named.",
    inputs=(Input("of", doc="the vector"),),
    parameters=(Parameter("index", doc="which element: a whole number, from 0", low=0.0),),
    outputs=(Output("y", "of[index]"),),
)

dot = Block(
    name="dot",
    doc="The sum of the products of the elements of two vectors.",
    inputs=(Input("of"), Input("other")),
    outputs=(Output("y", "dot(of, other)"),),
)

total = Block(
    name="total",
    doc="The sum of the elements of a vector.",
    inputs=(Input("of"),),
    outputs=(Output("y", "dot(of, 1)"),),
)

matrix_gain = Block(
    name="matrix_gain",
    doc="A matrix times a vector.",
    inputs=(Input("of", doc="the vector"),),
    parameters=(
        Parameter("matrix", doc="formulas by rows, such as [[c, -c], [-c, c + d]]", kind="formula"),
    ),
    outputs=(Output("y", "dot(matrix, of)"),),
)

solve = Block(
    name="solve",
    doc="The vector x of a linear system M x = f, such as the accelerations of a mass matrix.",
    parameters=(
        Parameter(
            "matrix", doc="M: formulas by rows, such as [[a + b, c*cos(q)], [c, b]]", kind="formula"
        ),
        Parameter("right", doc="f: formulas, such as [torque, -d*omega]", kind="formula"),
    ),
    outputs=(Output("x", "solve(matrix, right)"),),
    source="Gaussian elimination with exchange of rows; where M is singular the result is not"
    " finite, which ends the run.",
)
