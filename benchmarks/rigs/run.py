"""`python -m benchmarks rigs`: trace the record of each rig, and say what was hidden.

One process a rig, so that its seconds are its own; one line each.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.rigs.records import RECORDS, generate
from benchmarks.rigs.score import grade
from benchmarks.rigs.truth import TRUTHS
from benchmarks.tracing.real import effect_of, matches
from benchmarks.tracing.run import ONE_CORE
from benchmarks.tracing.sets import ROOT

Row = dict[str, Any]


def main(arguments: Sequence[str]) -> int:
    """Parse the options, generate what matches, trace each in a process, print a line each."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks rigs",
        description="Does a trace find what is hidden in records of a hundred and seven labs and "
        "machines? One core a rig. right: what is hidden and nothing else; with more: "
        "others besides.",
    )
    parser.add_argument("--only", default="*", help="a pattern of rigs: 'r08', 'motor'")
    parser.add_argument("--json", type=Path, help="a file for one JSON line a rig")
    parser.add_argument("--folder", type=Path, help="keeps the records; default: a temporary one")
    parser.add_argument("--generate", action="store_true", help="the files alone, no trace")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)  # asked of a process of its own
    options = parser.parse_args(arguments)
    if options.one:
        print(json.dumps(trace_one(options.one), default=str))
        return 0
    names = [name for name in RECORDS if matches(name, [options.only])]
    if not names:
        parser.error(f"no rig matches '{options.only}'; there are {', '.join(RECORDS)}")
    if options.generate and not options.folder:
        parser.error("--generate needs a --folder")
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.folder or Path(temporary)).resolve()
        if options.generate:
            for name in names:
                print(generate(name, folder), flush=True)
            return 0
        rows = []
        for name in names:
            row = in_own_process(generate(name, folder))
            rows.append(row)
            print(line_of(row), flush=True)
            if options.json:
                with options.json.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
    counts = Counter(row.get("grade", "no answer") for row in rows)
    print(f"{len(rows)} rigs: " + ", ".join(f"{n} {word}" for word, n in counts.most_common()))
    return int(any("error" in row for row in rows))


def in_own_process(file: Path) -> Row:
    """The row of a diagram, from a process of its own on one core."""
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.rigs.run", "--one", str(file)],
        cwd=ROOT,
        env=os.environ | dict.fromkeys(ONE_CORE, "1"),
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    row: Row = {"rig": file.stem, "error": f"the process ended with code {done.returncode}"}
    if done.returncode == 0:
        row = json.loads(done.stdout.splitlines()[-1])
    row |= {"title": TRUTHS[file.stem].title, "hidden": TRUTHS[file.stem].told()}
    if "answer" in row:
        row["grade"] = grade(TRUTHS[file.stem], row["answer"])
    return row


def trace_one(file: Path) -> Row:
    """Trace a diagram in this process: the answer as JSON, and the seconds that it took."""
    import tracewire as tw

    row: Row = {"rig": file.stem}
    began = time.perf_counter()
    try:
        row["answer"] = tw.trace(tw.compile(tw.read(file))).json()
    except tw.TracewireError as error:
        row["error"] = f"message: {error}"
    except Exception as error:  # a crash is one line of the table, not its end
        row["error"] = f"crash: {type(error).__name__}: {str(error)[:300]}"
    row["seconds"] = time.perf_counter() - began
    return row


def line_of(row: Row) -> str:
    """A row in one line: rig, verdict, effects, what is hidden, what it is worth, seconds."""
    cost = f" | {row['seconds']:.1f} s" if "seconds" in row else ""
    hidden = f" | hidden: {row['hidden']}"
    if "error" in row:
        return f"{row['rig']:13} {' '.join(row['error'].split())}{hidden}{cost}"
    answer = row["answer"]
    said = " + ".join(map(effect_of, answer["effects"])) or "no effect"
    if (missing := answer.get("missing")) is not None:
        said += f", missing at {missing['place']}: {', '.join(missing['variables'])}"
    return f"{row['rig']:13} {answer['verdict']:11} {said}{hidden} | {row['grade']}{cost}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
