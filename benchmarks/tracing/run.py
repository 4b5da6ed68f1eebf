"""`python -m benchmarks tracing`: trace every case and print the tables."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from benchmarks.table import console, show, show_promises
from benchmarks.tracing.cases import NULLS, Case, chosen
from benchmarks.tracing.floor import cases as floor
from benchmarks.tracing.floor.score import floor_tables
from benchmarks.tracing.score import tables

ONE_CORE = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def main(arguments: Sequence[str]) -> int:
    """Parse the options, run the cases in as many processes as asked, print the tables."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks tracing",
        description="Does a trace find what is hidden in generated records? One core a case.",
    )
    parser.add_argument("--quick", action="store_true", help="a sample of about 40 cases")
    parser.add_argument("--only", default="", help="a pattern of names: 'floor/*', 'chain'")
    parser.add_argument(
        "--units",
        choices=("si", "other", "both"),
        default="si",
        help="of floor cases: SI, others (mm, ms, deg), or SI and every fifth once more in others",
    )
    parser.add_argument("--nulls", type=int, default=NULLS, help=f"how many; default {NULLS}")
    parser.add_argument("--draw", type=int, default=0, help="other random numbers; default 0")
    parser.add_argument("--jobs", type=int, default=2, help="processes; default 2")
    parser.add_argument("--json", type=Path, help="a file for one JSON line a case")
    parser.add_argument("--folder", type=Path, help="keeps the records; default: a temporary one")
    parser.add_argument("--list", action="store_true", help="names of the cases, and nothing else")
    parser.add_argument("--generate", action="store_true", help="the files alone, no trace")
    parser.add_argument("--sanity", action="store_true", help="what scipy refits leave, no trace")
    parser.add_argument("--score", type=Path, help="tables of an earlier --json file, no trace")
    options = parser.parse_args(arguments)
    more = floor.quick() if options.quick else (*floor.floor_cases(), *floor.floor_nulls())
    cases = chosen(options.only, options.nulls, options.quick, options.draw, more)
    screen = console()
    if options.list:
        screen.print("\n".join(case.name for case in cases))
        return 0
    if options.score:
        rows = [json.loads(line) for line in options.score.read_text().splitlines()]
        failed = 0
    elif not cases:
        parser.error(f"no case matches '{options.only}'; --list shows them")
    else:
        with tempfile.TemporaryDirectory() as temporary:
            folder = options.folder or Path(temporary)
            if options.generate and not options.folder:
                parser.error("--generate needs a --folder")
            rows, failed = _all(cases, folder, options)
    if rows:
        with_floor = [row for row in rows if "units" in row]
        results = (
            tables([r for r in rows if "units" not in r]) if len(with_floor) < len(rows) else []
        )
        results += floor_tables(with_floor)
        for result in results:
            show(result, screen)
        show_promises(results, screen)
    return 1 if failed else 0


def _all(cases: Sequence[Case], folder: Path, options: Any) -> tuple[list[dict[str, Any]], int]:
    """The rows of the cases, and how many could not be made."""
    from benchmarks.tracing.sanity import sanity
    from benchmarks.tracing.work import generate, work

    rows: list[dict[str, Any]] = []
    failed = 0
    for name in ONE_CORE:  # the processes inherit it
        os.environ[name] = "1"
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(options.jobs, mp_context=spawn) as pool:
        if options.sanity:
            left = {pool.submit(sanity, case): case for case in cases if not case.bad}
            for ready in as_completed(left):
                print(f"{left[ready].name:48} {ready.result()}", flush=True)
            return [], 0
        task: Any = generate if options.generate else work
        waiting = {
            pool.submit(task, case, folder, other): case
            for case, other in floor.in_units(cases, options.units)
        }
        for number, done in enumerate(as_completed(waiting), 1):
            case = waiting[done]
            if (error := done.exception()) is not None:  # the others go on
                print(f"{number}/{len(waiting)} {case.name}: {error}", file=sys.stderr, flush=True)
                failed += 1
                continue
            if options.generate:
                print(f"{number}/{len(waiting)} {done.result()}", flush=True)
                continue
            row = done.result()
            rows.append(row)
            judged = row["judged"]
            words = " ".join(k for k, v in judged.items() if v is True)
            said = f"{judged['verdict']} {' + '.join(judged['named'])}"
            print(
                f"{number}/{len(waiting)} {case.name}: {said} [{words}] {row['wall']:.1f} s",
                file=sys.stderr,
                flush=True,
            )
            if options.json:
                with options.json.open("a") as file:
                    file.write(json.dumps(row, default=str) + "\n")
    return rows, failed
