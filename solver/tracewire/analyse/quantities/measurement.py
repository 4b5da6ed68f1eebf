"""`measure`: the value of a quantity of a subject."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from tracewire.analyse.quantities.evaluate import NOTHING_FURTHER, At, Further, resolve
from tracewire.analyse.quantities.of_motions import OF_MOTIONS
from tracewire.analyse.quantities.of_runs import OF_RUNS
from tracewire.analyse.quantities.subject import Subject
from tracewire.errors import AnalysisError, OptionError, Problem
from tracewire.formula import Expression, to_text

FUNCTIONS = MappingProxyType(OF_RUNS | OF_MOTIONS)


def ask(
    quantities: Sequence[Expression], subject: Subject, reference: Subject | None = None
) -> None:
    """Tell a subject what will be measured, so that one run has all of it.

    Raises OptionError: a signal that is not there.
    """
    for quantity in quantities:
        resolve(subject.model, quantity)
        with np.errstate(all="ignore"):  # a time that is not finite is refused when it is read
            At(subject, reference, functions=FUNCTIONS).ask(quantity)


def measure(
    quantity: Expression,
    subject: Subject,
    reference: Subject | None = None,
    further: Further = NOTHING_FURTHER,
) -> float | str:
    """The value of a quantity: a number in SI, or a word.

    Raises TracewireError: what it takes cannot be had, which the message says in words.
    """
    at = At(subject, reference, functions=FUNCTIONS, further=further)
    with np.errstate(all="ignore"):  # the branch of a choice that is not taken
        try:
            found = at.value(quantity)
        except ValueError as error:  # arrays of numpy that do not go together
            what = f"'{to_text(quantity)}' takes values at samples and at events together"
            raise OptionError(
                [Problem(what, hint="Make one number of each, as by max.")]
            ) from error
    if isinstance(found, str):
        return found
    if np.ndim(found):
        what = f"'{to_text(quantity)}' is no single number"
        raise OptionError([Problem(what, hint="Write end(x), max(x) or at(x, 2).")])
    if not np.isfinite(found):
        why = "0/0 or such" if np.isnan(found) else "infinite, as what is divided by zero"
        raise AnalysisError([Problem(f"'{to_text(quantity)}' has no value: it is {why}")])
    return float(found)
