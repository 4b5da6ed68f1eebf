"""Logic: blocks whose outputs are 0 or 1. An input at or above the threshold counts as 1.

Inputs that take several wires take vectors, too, whose elements count one by one.
"""

from tracewire.library import Block, Event, Input, Output, Parameter, State

OF = Input("of")
ALL = Input("of", doc="two signals or more", many=True)
THRESHOLD = Parameter("threshold", doc="a signal at or above it counts as 1", default=0.5)
START = Parameter("start", doc="0 or 1", default=0.0, low=0.0, high=1.0)

# how many of the wires count as 1, and how many as 0
ONES = "dot(1 if join(of) >= threshold else 0, 1)"
ZEROS = "dot(0 if join(of) >= threshold else 1, 1)"

compare = Block(
    name="compare",
    doc="One while one signal is at or above another, else 0.",
    inputs=(OF, Input("other", doc="what it is compared with", default="level")),
    parameters=(Parameter("level", doc="stands for the other where no wire does", default=0.0),),
    outputs=(Output("y", "1 if of >= other else 0", doc="jumps"),),
    source="GE of IEC 61131-3.",
)

and_ = Block(
    name="and",
    doc="One while all signals count as 1, else 0.",
    inputs=(ALL,),
    parameters=(THRESHOLD,),
    outputs=(Output("y", f"0 if {ZEROS} >= 1 else 1", doc="jumps"),),
    source="Boolean algebra; AND of IEC 61131-3.",
)

or_ = Block(
    name="or",
    doc="One while at least one signal counts as 1, else 0.",
    inputs=(ALL,),
    parameters=(THRESHOLD,),
    outputs=(Output("y", f"1 if {ONES} >= 1 else 0", doc="jumps"),),
    source="Boolean algebra; OR of IEC 61131-3.",
)

xor = Block(
    name="xor",
    doc="One while an odd number of signals counts as 1, else 0: of two, exactly one.",
    inputs=(ALL,),
    parameters=(THRESHOLD,),
    outputs=(Output("y", f"mod({ONES}, 2)", doc="jumps"),),
    source="Boolean algebra, as a sum modulo 2; XOR of IEC 61131-3.",
)

not_ = Block(
    name="not",
    doc="One while a signal does not count as 1, else 0.",
    inputs=(OF,),
    parameters=(THRESHOLD,),
    outputs=(Output("y", "0 if of >= threshold else 1", doc="jumps"),),
    source="Boolean algebra; NOT of IEC 61131-3.",
)

select = Block(
    name="select",
    doc="That one of several signals whose number, from 0, is nearest to an index.",
    inputs=(Input("index"), Input("of", doc="the signals, in order", many=True)),
    outputs=(Output("y", "pick_element(join(of), index)", doc="jumps with the index"),),
    source="MUX of IEC 61131-3, whose index is a whole number.",
)

edge = Block(
    name="edge",
    doc="One from a sample at which a signal counts as 1, and did not before, to the next sample.",
    inputs=(Input("of", sampled="tick"),),
    parameters=(
        Parameter("period", "s", "between two samples", above=0.0),
        Parameter("offset", "s", "the time of a sample", default=0.0),
        THRESHOLD,
    ),
    # the first tick only takes a sample
    states=(State("before", "zeros_like(of)", "1"), State("begun", "0", "0", "1", hidden=True)),
    events=(
        Event(
            "tick",
            every="period",
            offset="offset",
            set={"before": "1 if begun*of >= begun*threshold else 0", "begun": "1"},
        ),
    ),
    outputs=(Output("y", "(1 - before)*(1 if of >= threshold else 0)", doc="jumps"),),
    source="R_TRIG of IEC 61131-3, with the period as its cycle.",
)

monostable = Block(
    name="monostable",
    doc="One for a duration from each time that a signal rises over a threshold, else 0.",
    inputs=(OF,),
    parameters=(Parameter("duration", "s", "of a pulse", above=0.0), THRESHOLD),
    states=(State("left", rate="-1 if left > 0 else 0", start="0", unit="s"),),
    events=(Event("rise", when="of - threshold", crosses="up", set={"left": "duration"}),),
    outputs=(Output("y", "1 if left > 0 else 0", doc="jumps"),),
    source="A monostable that can be triggered again, as the circuit 74123.",
)

timer = Block(
    name="timer",
    doc="The time since a signal began to count as 1, and 0 while it does not.",
    inputs=(OF,),
    parameters=(THRESHOLD,),
    states=(State("passed", "1 if of >= threshold else 0", "0", "s"),),
    events=(Event("end", when="of - threshold", crosses="down", set={"passed": "0"}),),
    outputs=(Output("y", "passed", "s"),),
    source="The elapsed time of TON in IEC 61131-3, without its end.",
)

jk_flip_flop = Block(
    name="jk_flip_flop",
    doc="A bit that j sets, k resets, and both together turn, each time that a clock rises.",
    inputs=(
        Input("j"),
        Input("k"),
        Input("clock", doc="rises over the threshold"),
    ),
    parameters=(THRESHOLD, START),
    states=(State("y", rate="0", start="start"),),
    events=(
        Event(
            "rise",
            when="clock - threshold",
            crosses="up",
            set={
                "y": "(1 - y)*(1 if j >= threshold else 0) + y*(0 if k >= threshold else 1)",
            },
        ),
    ),
    outputs=(Output("y", "y", doc="0 or 1, jumps"),),
    source="The truth table of a JK flip-flop with a rising clock.",
)

debounce = Block(
    name="debounce",
    doc="A switch without its bounces: it follows a signal that has kept its side for a duration.",
    inputs=(OF,),
    parameters=(
        Parameter("duration", "s", "that a signal must keep its side for", above=0.0),
        THRESHOLD,
        START,
    ),
    # how long the signal has been on the other side than y
    states=(
        State("y", "0", "start"),
        State("passed", "1 - y if of >= threshold else y", "0", "s", hidden=True),
    ),
    events=(
        Event("bounce", when="of - threshold", set={"passed": "0"}),
        Event("settled", when="passed - duration", crosses="up", set={"y": "1 - y", "passed": "0"}),
    ),
    outputs=(Output("y", "y", doc="0 or 1, jumps"),),
    source="A counter that each bounce sets to zero.",
)
