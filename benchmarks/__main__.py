"""`python -m benchmarks [CASE ...] [--quick] [--rtol 1e-6]`: tables of times at equal accuracy."""

from __future__ import annotations

import argparse
import platform
import sys
import time

import numpy as np
import scipy
import tracewire as tw

from benchmarks.cases import CASES
from benchmarks.options import Options
from benchmarks.table import console, seconds, show, show_promises


def main() -> int:
    """Measure the cases that are named, or all; the benches of traces have their own options."""
    if sys.argv[1:2] == ["tracing"]:
        from benchmarks.tracing.run import main as tracing

        return tracing(sys.argv[2:])
    if sys.argv[1:2] == ["tracing-real"]:
        from benchmarks.tracing.real import main as tracing_real

        return tracing_real(sys.argv[2:])
    if sys.argv[1:2] == ["rigs"]:
        from benchmarks.rigs.run import main as rigs

        return rigs(sys.argv[2:])
    if sys.argv[1:2] == ["view"]:
        from benchmarks.view.run import main as view

        return view(sys.argv[2:])
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description="Times of tracewire beside other solvers, at equal accuracy. "
        "A time is the least of several runs, taken in turn; ratios are of the same session. "
        "What a trace finds is another bench: python -m benchmarks tracing --help, "
        "on measured records: python -m benchmarks tracing-real --help, "
        "and on a hundred and seven rigs with hidden effects: python -m benchmarks rigs --help. "
        "How fast the live page follows: python -m benchmarks view --help.",
    )
    parser.add_argument("case", nargs="*", help=f"of {', '.join(CASES)}; all if none is named")
    parser.add_argument("--quick", action="store_true", help="fewer runs, slow peers left out")
    parser.add_argument("--rtol", type=float, default=1e-6, help="of tracewire; default 1e-6")
    arguments = parser.parse_args()
    wrong = [name for name in arguments.case if name not in CASES]
    if wrong:
        parser.error(f"no case {', '.join(wrong)}; there are {', '.join(CASES)}")
    options = Options(rtol=arguments.rtol, quick=arguments.quick)
    screen = console()
    versions = (
        f"Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}"
    )
    screen.print(f"{versions}, {platform.machine()}\n")
    began, results, failed = time.perf_counter(), [], False
    for name in arguments.case or CASES:
        try:
            for result in CASES[name](options):
                show(result, screen)
                results.append(result)
        except tw.TracewireError as error:
            failed = True
            screen.print(f"{name}: tracewire fails: {error}\n", style="bold red")
    show_promises(results, screen)
    screen.print(f"\n{seconds(time.perf_counter() - began)} in all")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
