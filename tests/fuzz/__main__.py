"""`make fuzz ARGS="--count 100000 --seed 7"`: many random systems, by hand."""

from __future__ import annotations

import argparse
import secrets
import sys

from fuzz.many import KINDS, fuzz

parser = argparse.ArgumentParser(prog="make fuzz", description=__doc__)
parser.add_argument("--count", type=int, default=1000, help="of systems")
parser.add_argument("--seed", type=int, default=None, help="of the first one; else a new one")
parser.add_argument("--method", default="any", help="of integration; else another for each one")
parser.add_argument("--backend", default="any", help="llvm, quick or python; else any of them")
parser.add_argument("--kind", choices=KINDS, default="linear", help="of systems")
given = parser.parse_args()
seed = secrets.randbelow(10**9) if given.seed is None else given.seed
print(f"seed {seed}")  # noqa: T201
tally = fuzz(given.count, seed, given.method, given.backend, given.kind)
print(tally)  # noqa: T201
sys.exit(bool(tally.wrong or tally.unexplained))
