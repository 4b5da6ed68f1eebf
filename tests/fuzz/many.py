"""Many random systems of a kind, one after the other."""

from __future__ import annotations

import time

from fuzz.beside import check_beside
from fuzz.compare import CASES, Tally, check

KINDS = (*CASES, "beside")


def fuzz(
    count: int, seed: int, method: str = "any", backend: str = "any", kind: str = "linear"
) -> Tally:
    """So many systems from a seed on. `beside` draws its methods itself, for one back end."""
    tally, began = Tally(), time.perf_counter()
    for number in range(seed, seed + count):
        if kind == "beside":
            check_beside(number, tally)
        else:
            check(CASES[kind](number), number, tally, method, backend)
        for failed, what in (*tally.wrong[-1:], *tally.refusals[-1:]):
            if failed == number:
                print(f"seed {failed}: {what}", flush=True)  # noqa: T201
        if (number - seed + 1) % 1000 == 0:
            spent = time.perf_counter() - began
            print(f"{number - seed + 1} of {count}, {spent:.0f} s: {tally}", flush=True)  # noqa: T201
    return tally
