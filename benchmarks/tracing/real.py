"""`python -m benchmarks tracing-real`: trace each diagram of diagrams/real on files at hand.

One process a diagram, so that seconds and peak memory are its own; one line each.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from benchmarks.tracing.run import ONE_CORE
from benchmarks.tracing.sets import DIAGRAMS, ROOT, SHARED, lay_out

Row = dict[str, Any]
MEGABYTE = 1024 if sys.platform != "darwin" else 1024**2  # ru_maxrss counts kB, on macOS bytes


def main(arguments: Sequence[str]) -> int:
    """Parse the options, trace what matches in a process of its own, print a line each."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks tracing-real",
        description="What a trace says of measured records: verdict, effects, share explained, "
        "errors on the part that played no part, seconds and peak memory. One core a diagram.",
    )
    parser.add_argument("--only", default="*", help="a pattern of diagrams: 'falling*', '*/large*'")
    parser.add_argument("--without", action="append", default=[], help="a pattern; repeatable")
    parser.add_argument("--shared", type=Path, default=SHARED, help=f"the files; default {SHARED}")
    parser.add_argument("--json", type=Path, help="a file for one JSON line a diagram")
    parser.add_argument("--list", action="store_true", help="the diagrams, and nothing else")
    parser.add_argument("--one", help=argparse.SUPPRESS)  # what a process of its own is asked for
    options = parser.parse_args(arguments)
    if options.one:
        print(json.dumps(trace_one(options.one, options.shared), default=str))
        return 0
    names = [name for name in DIAGRAMS if matches(name, [options.only])]
    names = [name for name in names if not matches(name, options.without)]
    if not names:
        parser.error(f"no diagram matches '{options.only}'; --list shows them")
    if options.list:
        print("\n".join(names))
        return 0
    if not options.shared.is_dir():
        parser.error(f"there is no folder '{options.shared}'; name one with --shared")
    failed = False
    for name in names:
        row = in_own_process(name, options.shared)
        failed = failed or "error" in row
        print(line_of(row), flush=True)
        if options.json:
            with options.json.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
    return int(failed)


def matches(name: str, patterns: Sequence[str]) -> bool:
    """Whether a part of a diagram's name matches one of the patterns."""
    return any(fnmatch(name, f"*{pattern}*") for pattern in patterns)


def in_own_process(name: str, shared: Path) -> Row:
    """The row of a diagram, from a process of its own on one core."""
    command = [sys.executable, "-m", "benchmarks.tracing.real", "--one", name]
    environment = os.environ | dict.fromkeys(ONE_CORE, "1")
    done = subprocess.run(
        [*command, "--shared", str(shared.resolve())],
        cwd=ROOT,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    if done.returncode:
        return {"diagram": name, "error": f"the process ended with code {done.returncode}"}
    row: Row = json.loads(done.stdout.splitlines()[-1])
    return row


def trace_one(name: str, shared: Path) -> Row:
    """Trace a diagram in this process: the answer as JSON, seconds, peak memory in MB."""
    import tracewire as tw

    row: Row = {"diagram": name}
    with tempfile.TemporaryDirectory() as folder:
        home = lay_out(name.partition("/")[0], Path(folder), shared)
        began = time.perf_counter()
        try:
            row["answer"] = tw.trace(tw.compile(tw.read(home.parent / name))).json()
        except tw.TracewireError as error:
            row["error"] = f"message: {error}"
        except Exception as error:  # a crash is one line of the table, not its end
            row["error"] = f"crash: {type(error).__name__}: {str(error)[:300]}"
        row["seconds"] = time.perf_counter() - began
    row["megabytes"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MEGABYTE
    return row


def line_of(row: Row) -> str:
    """A row in one line: diagram, verdict, effects, explained share, errors, cost."""
    name = f"{row['diagram'].removesuffix('.yaml'):32}"
    cost = ""
    if "seconds" in row:
        cost = f" | {row['seconds']:.1f} s, {row['megabytes']:.0f} MB"
    if "error" in row:
        return f"{name} {' '.join(row['error'].split())}{cost}"
    answer = row["answer"]
    effects = " + ".join(map(effect_of, answer["effects"])) or "no effect"
    explained = answer.get("explained")
    share = f" | explained {explained['share']:.0%}" if explained is not None else ""
    errors = f"rmse {answer['rmse_before']:.4g} -> {answer['rmse_after']:.4g}"
    return f"{name} {answer['verdict']:11} {effects}{share} | {errors}{cost}"


def effect_of(effect: Mapping[str, Any]) -> str:
    """An effect with its place, values in SI, and ties."""
    values = ", ".join(f"{name} {value:.4g}" for name, value in effect["params"].items())
    ties = f" ~ {', '.join(effect['ties'])}" if effect["ties"] else ""
    return f"{effect['name']} @ {effect['place']} ({values}{ties})"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
