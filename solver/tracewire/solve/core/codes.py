"""The numbers that the core and Python share: kinds, places in arrays, what a run may end with."""

from __future__ import annotations

KINDS = ("sign", "floor", "segment", "memory", "delay")
SIGN, FLOOR, SEGMENT, MEMORY, DELAY = range(5)
UP, DOWN, BOTH = 1, -1, 0
DIRECTIONS = {"up": UP, "down": DOWN, "both": BOTH}
# what reaches a level; PASSED: a guard that is found beyond it where a step begins; CHANGES: a
# known time whose mode changes now, while the resets that it fires wait; WAITS: a guard that waits
GUARD, FRACTION, FORCE, TIME, PASSED, CHANGES, WAITS = range(7)
# a reset's guard has come to zero on its own: in this stage of an instant, in an earlier one
CROSSED, ARRIVED = -1, -2

EVENTS = ("crossing", "scheduled", "reset", "impact", "stick", "slip", "rest", "transition")
CROSSING, SCHEDULED, RESET, IMPACT, STICK, SLIP, REST, TRANSITION = range(8)
LOG_HEAD = 4  # time, kind, mode, direction; behind them the states before and after

FINISHED, PAUSED, LOG_FULL, HISTORY_FULL = range(4)
UNDERFLOW, UNDEFINED, CHATTER, NO_MODE, NO_SLIDE = range(10, 15)
UNSETTLED, TWO_WRITES, BAD_RESET, NO_END, CARRIED, ENDLESS = range(15, 21)

# places in Progress.now
T, H, END, LENGTH, RTOL, FIXED, RATIO, LONGEST, PACED, LAST = range(10)
NEVER, WHILE_HELD, ALWAYS = range(3)  # in now[PACED]: when the pace bounds a step
# places in Progress.ints
STEPS, REJECTED, STIFF_STEPS, METHOD, CURRENT, SUSPICIOUS, CALM = range(7)
SAMPLED, LOGGED, STIFF_ROWS, RECENT, BUDGET, WARNINGS, STAGE, WATCHED = range(7, 15)
NOT_UNIQUE = 1
AWAY, ON_GUARD, BEYOND = range(3)  # in Progress.overlooked: where a start is
POINTS, DROPPED = range(2)  # places in History.counts
MOVES, NODE = range(2)  # places in History.along
FLAGS = 5
ZENO, GRAZES, SIMULTANEOUS, TOUCHES, LOST = range(FLAGS)  # where sensitivities end
CHATTER_EVENTS = 50
ABSOLUTE = 1e-3  # of the relative tolerance, of what was seen of a state
