"""From a model to a run: a flat ODE whose right-hand side switches at located events.

**Frozen modes.** Every relation of a formula is a mode m and its guard g. Between events all modes
are frozen and x' = f(x, t, m) is smooth. A crossing of g is on the half-open interval (t0, t1]: a
zero at a step's start does not fire again. A guard that reaches zero at the known time at which a
step ends crosses there. Guards are sampled inside each step, sampled dips are refined, and a
crossing is located on the dense output, then on a true step, to 1e-14 of the span. Steps follow the
error of the states; where a guard, or a force on what is held, reads what turns faster than that, a
sine of t, a narrow pulse, the step is bounded by its pace (`compile.pace`), and by `max_step` where
that is given. A guard that creeps beyond its level too slowly for any step to see it crosses where
it is found there. A frozen formula may be undefined beyond its guard: a trial step that is not
finite is rejected, and where steps underflow at a guard, the guard is crossed. A sample at the time
of an event is the right limit; the log keeps x⁻ and x⁺.

**Events.** All resets that are due read x⁻ and write x⁺ together; two that write different values
to one state are an error that names both. Then the modes are evaluated anew until they stand still,
and the run restarts. The mode is stored, never derived again from a state that sits on the
surface. A guard that is zero and that a reset drives over it (a ball that lies at a wall and is
struck) fires at the same instant, and reads what the first one wrote. Modes that do not stand still
are an error.
An event whose guard only jumps (a square wave, a relay, a counter, a sample: constant between other
events) fires at the instant of the jump, when all other modes stand still there: up, where it jumps
from below zero to zero or above, or from zero, where that was no arrival from below, to above; down
likewise. Its reset reads what the other resets of that instant wrote. A start fires nothing. Two
events of one jump that write different values to one state are an error that names both.
A guard that moves as well, such as a square wave with a ripple, fires where it passes through zero,
and at an instant that carries it over: when all modes stand still there, after the events whose
guards only jump. What these resets carry over zero fires next, until nothing is left; events that
set each other off without end are an error, and so is a jump that carries a body over a contact.

**Memory.** A block with memory has named modes that only its transitions change: while the memory
is `source` and the condition of the transition holds, it becomes `target`, and its reset, if it has
one, reads x⁻. Transitions are looked at when all other modes stand still; of several of one memory
the first declared one fires. Transitions that lead back to where they began are an error.

**Clocks.** A clock (`every`) fires at offset + k*period, and at the start of a run where that is
such a time. An offset above zero is the time of the first tick: there is none before it. Without
one, and with one below zero, k is any whole number, however early the run begins.

**Zero at the start, or after a reset.** The modes of all guards that are zero are decided together.
A combination is consistent when the first non-zero derivative of each guard along the field of
that combination, up to order 4, has the sign of its mode. One: it is taken. None: a slide. Several:
the stored one, at the start with a warning. All derivatives zero: the stored one; of a guard that
was seen beyond, the mode there; at the start what the comparison says at zero. On a slide a higher
derivative is known as far as no lower one differs between the sides. A floor that stands on a whole
number goes to the side to which its guard goes.

**Comparisons.** Relations on the same signal, up to sign, share one mode where they are a law that
moves the rate of this signal, such as a friction: they slide together. A comparison of a signal
that it does not move has a mode of its own. Where the signal rests at zero, exactly or because a
slide holds it, `x >= 0` is true and `x > 0` is false.

**Zero** is a matter of what a value is made of. A guard counts as zero below 1e-14 of its size, the
sum of what is added up in it (`compile.sizes`), a derivative below 1e-12 of its size on any side. A
state at zero is of the size that it has had of late, or by which it may move in the longest step,
up to 1. So neither a unit nor another state has a say.

**Sliding.** On a slide over surfaces S the field is the blend sum over patterns of (product of m or
1 - m) times f, with the fractions m in [0, 1] for which dg/dt = 0 for all g in S. It ends when a
fraction leaves [0, 1]; the new mode is stored. Up to six surfaces are decided by trying all
combinations, more by pivoting. Fields in which two sliding modes multiply each other are refused.
`dry(u, slip, stick)` holds u = 0 while the required level is within +-stick, even if only one of
the fields points in; not where its sign is wrong, so that it drives. A jump that carries the run
off the surface ends the slide. Recorded signals on a slide are blends, too, and so are the guards
and what resets write: a counter that reads a friction which sticks counts the rises of the force
that holds it. What such a friction balances bounds the steps by its pace in time. The
blend is exact where the friction enters as a factor or a term: its square is that of the sides.
What rounding moves
off the surface is put back after each step: a body at rest stays where it is for ever. A floor does
not slide: fields that point to its jump from both sides end as chatter. Where the fields of the
sides agree at an instant (friction whose level passes through zero) the fraction is 0/0, and its
limit follows from the first higher derivative that is not zero. A guard that rests at zero while
nothing decides its mode (friction on a prescribed rate of exactly zero) keeps the last side, with a
warning where that makes a difference.

**Loops.** The modes of an algebraic loop read what they change. They are changed one at a time, the
first one first, which ends where each of them moves its own guard the right way; where that goes
round in a circle all combinations are tried, and none or several that fit are an error.

**Contacts and Zeno.** A reset that turns the rate of its guard is an impact. A contact whose
flights shorten below what can be resolved closes at t + flight/(1 - ratio) and rests: its guard is
held at zero by a force in the direction of its reset, until that force would have to pull. A guard
of an impact that is zero with g' = 0 and g'' < 0 rests at once, at the start and later. The force
is no signal; `is_held(g)` tells that it acts. A start that lies on a contact and moves into it
fires an event of the kind `impact` there. Another event does not fire, and a warning says so.

**Known times.** Guards that are a line in t (square, step, ramp, clocks, breakpoints of tables in
t) change at computed times that steps end on; breakpoints of tables are not logged. Where the line
jumps with another mode (`t - 0.7 + wave/2`), they change at the jump, too.

**Sensitivities.** S = dx/dp follows S' = f_x S + f_p between events. At an event the instant moves
by dτ = -(g_x S + g_p)/g', and S⁺ = R_x (S⁻ + f⁻ dτ) + R_p + R_t dτ - f⁺ dτ, with R the reset and f⁺
the field that holds after it, a slide included. At a breakpoint of a table in t, where the field
has a kink and no jump, S goes on as it is. Where it is not defined (the end of a Zeno
sequence, a guard that is only grazed, several things at one instant) it stays finite, and a
warning says so.

**Never hang.** Chatter, underflow of the step, values that are not finite, the limits of steps,
events and wall time stop a run with block, time, values and what to try. A run is paused about ten
times a second; there Ctrl-C is heard, and raises `Interrupted`, which carries the run up to there.

**Order at one instant.** What jumps there at a known time (steps, tables, delayed jumps), until all
modes stand still, with the resets whose guards it carries over; then clocks and what crosses there,
all of whose resets read the states from before them; modes and transitions; resets of guards that
were carried over; one sample. So a clock reads a step of its instant as it is behind it, as Xcos
does, and a bounce as it was before.

**How it runs.** `initial_value_problem` checks the arguments of a run and gives them as numbers
(`problem`). An `Integrator` is given a problem: it takes arrays that fit, set to the numbers
(`workspace`, made by `setup`), lets the core go on, to a stop or to the end, takes what the core
logs (`event_log`), and finds words for what went wrong (`failures`). `core` holds all of the above
as functions that are compiled when the package is built (`core_build`); `core_library` loads their
machine code, which calls that of a model by address. `simulate` is one run; `simulate_many` runs
the same problem with rows of values in threads (`task`); `Passage` stops
where an analysis looks at it; `simulate_spans` lets the core go from one short run to the next. A
fit keeps the `span_problem` behind it, which is checked and laid out once, and runs it with values.

**Delays.** What is read with a delay is kept over each step, as polynomials through its values in
the dense output, and before the start it is what is declared. Steps are shorter than the delay, so
that the past is known: a loop through a delay is no algebraic loop. An event, and the start, at tau
is a known time at tau + delay, as far as what is delayed feels it in a derivative of order 5 or
less; each integrator on the way raises the order by one. Steps end there, and what is read jumps
there. A guard that reads the past is located as others are. Steps meet at most two of the
polynomials of what a guard reads. Sensitivities of what was are kept, too: with u(t - T) comes
dU(t - T) - u'(t - T) dT, and its jumps move with those of u and with T.

Not there yet: the rate of a state that is held by a stop is still a state, so that friction
on it keeps its last side while the stop holds.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
