"""Tables beside that of one signal: of two signals, and signals of straight lines with jumps."""

from tracewire.library import Block, Input, Output, Parameter

signal_builder = Block(
    name="signal_builder",
    doc="A signal of straight lines over the time, which jumps where a time stands twice.",
    parameters=(
        Parameter("times", "s", "a list of numbers that ascend; a jump is the same number twice"),
        Parameter("values", doc="a list: the signal at these times, held before and after them"),
    ),
    outputs=(Output("y", "straight_lines(t, times, values)", doc="jumps: the later value holds"),),
    source="As Modelica's TimeTable, where two values at one time are a jump.",
)

lookup_table_2d = Block(
    name="lookup_table_2d",
    doc="A table of two signals, bilinear between its points and held beyond them.",
    inputs=(
        Input("of", doc="what the rows belong to"),
        Input("other", doc="what the columns belong to"),
    ),
    parameters=(
        Parameter("rows", doc="a list of numbers that ascend: of, for each row"),
        Parameter("columns", doc="a list of numbers that ascend: other, for each column"),
        Parameter("values", doc="by rows, such as [[1, 2, 3], [4, 5, 6]]", kind="formula"),
    ),
    outputs=(Output("y", "bilinear(of, other, rows, columns, values)"),),
    source="Bilinear interpolation: in each cell y = a + b*of + c*other + d*of*other.",
)
