"""The accepted steps that the sensitivities have not followed yet.

S goes behind the states, several steps at once: these are short where the states need it, and an
interval of S may be longer. The states inside of a step are read from `trial`, so that a step of
the past is put there again.
"""

from __future__ import annotations

from tracewire.solve.core.arrays import copy, sensitivity_of, trial_of
from tracewire.solve.core.methods import INNER
from tracewire.solve.core.units import helper, unit


@unit
def keep_step(core: int, method: int, first: int) -> None:
    """Keep the step in `trial`, in which the samples from `first` on lie."""
    sensitivity, trial = sensitivity_of(core), trial_of(core)
    kept, number = sensitivity.kept, sensitivity.kept[0]
    row, n, at = sensitivity.steps[number], len(trial.x), len(trial.ends)
    sensitivity.methods[number] = method
    copy(trial.ends, row)
    copy(trial.x, row[at:])
    copy(trial.x_end, row[at + n :])
    for k in range(INNER[method]):
        copy(trial.inner[k], row[at + (2 + k) * n :])
    if number == 0:
        kept[2] = first
    kept[0] = number + 1


@unit
def step_at(core: int, t: float) -> int:
    """Let `trial` be the kept step that has a time inside; its method."""
    sensitivity = sensitivity_of(core)
    steps, kept = sensitivity.steps, sensitivity.kept
    number = kept[1]
    while number + 1 < kept[0] and t > steps[number, 0] + steps[number, 1]:
        number += 1
    while number > 0 and t < steps[number, 0]:
        number -= 1
    if number != kept[1]:
        put_step(core, number)
    return int(sensitivity.methods[number])


@helper
def end_of_trail(core: int) -> float:
    """The time at which the last kept step ends."""
    row = sensitivity_of(core).steps[sensitivity_of(core).kept[0] - 1]
    return row[0] + row[1]


@unit
def put_step(core: int, number: int) -> None:
    """Let `trial` be one of the kept steps."""
    sensitivity, trial = sensitivity_of(core), trial_of(core)
    row, n, at = sensitivity.steps[number], len(trial.x), len(trial.ends)
    sensitivity.kept[1] = number
    copy(row[:at], trial.ends)
    copy(row[at : at + n], trial.x)
    copy(row[at + n : at + 2 * n], trial.x_end)
    for k in range(INNER[sensitivity.methods[number]]):
        first = at + (2 + k) * n
        copy(row[first : first + n], trial.inner[k])
