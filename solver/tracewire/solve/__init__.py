"""From a model to a run: a flat ODE whose right-hand side switches at located events.

**Frozen modes.** Every relation of a formula is a mode m and its guard g. Between events all modes
are frozen and x' = f(x, t, m) is smooth. A crossing of g is on the half-open interval (t0, t1]: a
zero at a step's start does not fire again. Guards are sampled inside each step, sampled dips are
refined, and a crossing is located on the dense output and then on true steps, to 1e-14 of the
span. A frozen formula may be undefined beyond its guard: a trial step that is not finite is
rejected, and where steps underflow at a guard, the guard is crossed. A sample at the time of an
event is the right limit; the log keeps x⁻ and x⁺.

**Events.** All resets that are due read x⁻ and write x⁺ together; two that write different values
to one state are an error that names both. Then the modes are evaluated anew until they stand still,
and the run restarts. The mode is stored, never derived again from a state that sits on the
surface. A guard that a reset carries over zero changes its mode, but fires no reset of its own.
Modes that do not stand still are an error: no consistent mode.

**Zero at the start, or after a reset.** The modes of all guards that are zero are decided together.
A combination is consistent when the first non-zero derivative of each guard along the field of
that combination, up to order 4, has the sign of its mode. One: it is taken. None: a slide. Several:
the stored one, at the start with a warning. All derivatives zero: the stored one, at the start what
the comparison says at zero. Relations on the same signal, up to sign, share one mode; where they
differ at exactly zero (x > 0 and x >= 0), the first one speaks for both.

**Sliding.** On a slide over surfaces S the field is the blend sum over patterns of (product of m or
1 - m) times f, with the fractions m in [0, 1] for which dg/dt = 0 for all g in S. It ends when a
fraction leaves [0, 1]; the new mode is stored. Up to six surfaces are decided by trying all
combinations, more by pivoting. Fields in which two sliding modes multiply each other are refused.
`dry(u, slip, stick)` holds u = 0 while the required level is within +-stick, even if only one of
the fields points in. Recorded signals on a slide are blends, too.

**Zeno.** A contact whose flights shorten below what can be resolved closes at
t + flight/(1 - ratio) and rests: its guard is held at zero by a force in the direction of its last
reset, until that force would have to pull. The force is no signal. A reset that drives a resting
contact further in is refused. A run that starts on a contact has had no impact: it is not held, and
a warning says so.

**Known times.** Guards that are a line in t (square, step, ramp, breakpoints of tables in t) change
at computed times that steps end on; breakpoints of tables are not logged.

**Never hang.** Chatter, underflow of the step, values that are not finite, the step limit and the
limit of wall time stop a run with block, time, values and what to try.

**Order at one instant.** What crosses there and what is scheduled there, resets, modes, one sample.

Not there yet: blocks with memory, clocks and hard stops (so no event of kind `impact`), delays,
loops through a mode, sensitivities.
"""

from tracewire.solve.limits import Limits
from tracewire.solve.run import Event, Run, Statistics
from tracewire.solve.simulate import parameter_values, simulate

__all__ = ["Event", "Limits", "Run", "Statistics", "parameter_values", "simulate"]
