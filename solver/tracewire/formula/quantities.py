"""The functions of quantities: what is told of a run, or of a motion, in a number.

A quantity is a formula in which these stand beside the functions of all formulas:
`max(abs(phi1))`, `end(energy)/at(energy, 0)`, `multiplier(1)`. `tracewire.analyse` works them out;
`sweep --keep` and the section `expect` of a diagram are written in them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Argument = Literal["signal", "number", "condition", "event", "happening", "parameter", "word"]
QuantityUnit = Literal["kept", "number", "s", "1/s", "Hz", "kept s", "parameter", "inside", "any"]
BRANCHES = ("up", "down")


@dataclass(frozen=True)
class Quantity:
    """A function of quantities: its arguments, what it is, and its unit.

    An argument is a `signal`: a formula of signals, parameters and `t`, at each sample; a `number`;
    a `condition`, such as x > 0; an `event`: a kind of event, a block, or a guard as the log of
    events has it; a `happening`: one of these two; the name of a `parameter`; or a `word`. The last
    `optional` of them may be left out; `more`: the last one may be repeated.

    unit: that of the first signal is `kept`, or times s; a `number`; s; 1/s; Hz; that of the
    `parameter`; that of what is `inside`, or `any`. text: it is a word, such as "stable".
    study: it is no number of a run, and needs more of its setting than a run does. made_by: the
    analysis that makes it, where a key of the setting is for that one only. words: what its first
    argument, a word, may be; any that the caller knows where there are none.
    """

    takes: tuple[Argument, ...]
    doc: str
    unit: QuantityUnit = "number"
    optional: int = 0
    more: bool = False
    text: bool = False
    study: bool = False
    made_by: Literal["", "bifurcation diagram", "fit"] = ""
    words: tuple[str, ...] = ()

    @property
    def least(self) -> int:
        """The fewest arguments."""
        return len(self.takes) - self.optional

    def kind(self, n: int) -> Argument:
        """What the argument number n, from 0 on, is."""
        return self.takes[min(n, len(self.takes) - 1)]


# fmt: off
QUANTITIES = {
    # of a signal, over the samples of a run
    "end": Quantity(("signal",), "the value at the last sample", "kept"),
    "at": Quantity(("signal", "number"), "at(x, T): the value at the time T in s; T may read t",
        "kept"),
    "max": Quantity(("signal",), "the largest value", "kept"),
    "min": Quantity(("signal",), "the least value", "kept"),
    "range": Quantity(("signal",), "the largest less the least value", "kept"),
    "amplitude": Quantity(("signal",), "half of the range", "kept"),
    "mean": Quantity(("signal",), "the mean over the time", "kept"),
    "rms": Quantity(("signal",), "the root of the mean square over the time", "kept"),
    "std": Quantity(("signal",), "the standard deviation of the samples", "kept"),
    "integral": Quantity(("signal",), "the integral over the time, by trapezoids", "kept s"),
    "drift": Quantity(("signal", "number"),
        "drift(x, scale): the largest |x - x(0)|, in parts of |x(0)| unless a scale is given",
        optional=1),
    "period": Quantity(("signal",), "the mean time between rises through the middle of a wave, "
        "which may decay", "s"),
    "frequency": Quantity(("signal",), "1/period, in Hz", "Hz"),
    "growth_rate": Quantity(("signal",), "r of an envelope exp(r t) through the peaks that the "
        "tolerances resolve; below zero it decays", "1/s"),
    "line": Quantity(("signal", "number", "number"),
        "line(x, n, m): the frequency in Hz of line n, from below, of the m largest of a spectrum",
        "Hz"),
    "cosine": Quantity(("signal", "number"),
        "cosine(x, w, ...): the part of cos(w t), least squares of waves of all w in rad/s", "kept",
        more=True),
    # of conditions and events
    "fraction": Quantity(("condition",), "the part of the samples at which a condition holds"),
    "count": Quantity(("happening",), "how often a condition becomes true, or an event happens; "
        "count() of all events", optional=1),
    "time": Quantity(("happening", "number"),
        "time(x > 0, k): the first sample, or the event, number k from 1 on", "s", optional=1),
    "during": Quantity(("event", "event"),
        "during(stick, slip): 1 from each event of the first to the next of the second, else 0"),
    "before": Quantity(("event", "signal"), "before(event, x): x of the states before each event",
        "inside"),
    "after": Quantity(("event", "signal"), "after(event, x): x after each event", "inside"),
    # of another setting
    "reference": Quantity(("signal",), "the same of the run that `reference` sets", "inside"),
    # of motions: periods, orbits, exponents, sections
    "multiplier": Quantity(("number",), "the modulus of Floquet multiplier k of the motion with "
        "`period`, the largest first", study=True),
    "multiplier_real": Quantity(("number",), "its real part", study=True),
    "floquet_exponent": Quantity(("number",), "the growth rate ln|multiplier k|/period", "1/s",
        study=True),
    "floquet_frequency": Quantity(("number",), "|angle of multiplier k|/period, in rad/s", "1/s",
        study=True),
    "monodromy_trace": Quantity((), "the trace of the map over a period", study=True),
    "monodromy_determinant": Quantity((), "its determinant", study=True),
    "stability": Quantity((), "stable, unstable or neutral, by the multipliers", text=True,
        study=True),
    "stability_edge": Quantity(("parameter", "number", "number"),
        "stability_edge(a, low, high): the value of a between them where stability is lost",
        "parameter", study=True),
    "orbit_multiplier": Quantity(("number",), "the modulus of multiplier k of the periodic orbit",
        study=True),
    "lyapunov": Quantity(("number",), "Lyapunov exponent k, over `length`", "1/s", study=True),
    "lyapunov_positive": Quantity((), "how many are above zero by three standard errors",
        study=True),
    "lyapunov_sum": Quantity((), "the sum of all exponents", "1/s", study=True),
    "divergence": Quantity((), "the mean trace of the Jacobian along the motion", "1/s",
        study=True),
    "steady": Quantity(("signal",), "the value of a formula of states at the steady state", "kept",
        study=True),
    "steady_stability": Quantity((), "stable, unstable, neutral or nonsmooth", text=True,
        study=True),
    "section": Quantity(("signal", "number"),
        "section(x, k): a formula of states at point k of the section", "kept", study=True),
    "section_range": Quantity(("signal",), "the largest less the least value at the points", "kept",
        study=True),
    "section_clusters": Quantity((), "how many different points a section has", study=True),
    "section_count": Quantity((), "how many points a section has", study=True),
    "band_low": Quantity(("word", "number"),
        "band_low(down, gap): where the widest band of irregular motion begins, going down or up "
        "`over` a parameter; bands nearer than gap are one", "any", study=True,
        made_by="bifurcation diagram", words=BRANCHES),
    "band_high": Quantity(("word", "number"), "where it ends", "any", study=True,
        made_by="bifurcation diagram", words=BRANCHES),
    "irregular_beside": Quantity(("word", "number"), "the part of the values that are irregular "
        "outside of that band", study=True, made_by="bifurcation diagram", words=BRANCHES),
    "motions": Quantity(("number", "number", "parameter"),
        "motions(n, a, x, ...): how many motions n starts lead to, with states x within -a to a",
        study=True, more=True),
    # of fits
    "fitted": Quantity(("parameter",), "what a fit to the measured series makes of a parameter",
        "parameter", study=True, made_by="fit"),
    "criterion": Quantity((), "the criterion of that fit", study=True, made_by="fit"),
    "identification": Quantity(("word", "word"),
        "identification(M8, disk): a criterion after a step of paper A's identification", "any",
        study=True),
    # of mathematics, for what theory states
    "bessel_j": Quantity(("number", "signal"), "bessel_j(n, x): of the first kind"),
    "bessel_y": Quantity(("number", "signal"), "bessel_y(n, x): of the second kind"),
    "elliptic_k": Quantity(("number",), "the complete elliptic integral K of the parameter m"),
    "mathieu_a": Quantity(("number", "number"), "mathieu_a(n, q): where even solutions close"),
    "mathieu_b": Quantity(("number", "number"), "mathieu_b(n, q): where odd solutions close"),
}
# fmt: on
