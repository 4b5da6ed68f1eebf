"""What the command line prints: results to stdout; problems and progress to stderr."""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from tracewire.cli.limits import LIMITS
from tracewire.errors import OptionError, Problem, unknown
from tracewire.result import plain

if TYPE_CHECKING:
    from tracewire.show import Table

CONTROLS = {
    number: f"\\x{number:02x}" if number < 256 else f"\\u{number:04x}"
    for first, last in (
        (0, 8),
        (11, 31),
        (127, 159),
        (0x200E, 0x200F),
        (0x202A, 0x202E),
        (0x2066, 0x2069),
    )
    for number in range(first, last + 1)
}
"""The escape of each control character but tab and new line; those that turn the direction, too."""

LOST: list[OSError] = []
"""Why stdout did not take what was printed."""


class Cut(Exception):
    """The work was interrupted, and what there is of it has been told."""


def visible(text: str) -> str:
    """Text whose control characters are written as escapes: a title cannot steer a terminal."""
    return text.translate(CONTROLS)


def print_text(text: str) -> None:
    """Print plain text to stdout."""
    _echo(visible(text))


def flush() -> None:
    """Bring out what was printed, so that it is there whatever comes after."""
    try:
        sys.stdout.flush()
    except OSError as error:
        LOST.append(error)


def print_table(table: Table) -> None:
    """Print a table with its title to stdout; columns that hold numbers are aligned right."""
    from rich import box
    from rich.console import Console
    from rich.table import Table as RichTable
    from rich.text import Text

    terminal = sys.stdout.isatty()
    lines = StringIO()  # rich itself would fail at a full disk
    width = None if terminal else LIMITS.pipe_width
    console = Console(file=lines, force_terminal=terminal, width=width, highlight=False)
    shown = RichTable(
        title=Text(visible(table.title), style="bold") if table.title else None,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
    )
    for n, name in enumerate(table.header):
        right = n in table.numeric
        shown.add_column(
            Text(visible(name)),
            justify="right" if right else "left",
            overflow="fold",
            no_wrap=right,
        )
    for row in table.rows:
        shown.add_row(*(Text(visible(cell)) for cell in row))  # Text: `[rad]` is no markup
    console.print(shown)
    _echo(lines.getvalue(), nl=False)


def print_parts(parts: Iterable[str | Table]) -> None:
    """Print sentences and tables in their order."""
    for part in parts:
        if isinstance(part, str):
            print_text(part)
        else:
            print_table(part)


def print_json(data: object) -> None:
    """Print data as JSON to stdout; what is not finite becomes null."""
    text = json.dumps(plain(data), indent=2, ensure_ascii=False, allow_nan=False)
    _echo(text.translate({number: f"\\u{number:04x}" for number in CONTROLS}))


def print_problems(problems: Sequence[Problem], as_json: bool = False) -> None:
    """Print problems one a line to stderr, and with `as_json` as one object to stdout."""
    for problem in problems:
        note(" ".join(str(problem).split("\n")))
    if as_json:
        print_json({"error": [_record(problem) for problem in problems]})


def _record(problem: Problem) -> dict[str, object]:
    place = problem.place
    where = {"file": place.file, "line": place.line, "column": place.column, "block": place.block}
    return where | {"what": problem.what, "exists": problem.exists, "hint": problem.hint}


def note(text: str) -> None:
    """Print a line to stderr: progress or a warning, no result."""
    _echo(visible(text), err=True)


def _echo(text: str, nl: bool = True, err: bool = False) -> None:
    """Print; a stream that takes no more does not end the work: the files come first."""
    try:
        typer.echo(text, nl=nl, err=err)
    except OSError as error:
        if not err:
            LOST.append(error)


@contextmanager
def working(text: str) -> Iterator[Callable[[str], None]]:
    """Show on a terminal's stderr what is being done; elsewhere nothing is shown.

    It gives a function that changes the text, for work that can tell how far it is.
    """
    if not sys.stderr.isatty():
        yield lambda changed: None
        return
    from rich.console import Console
    from rich.text import Text

    with Console(stderr=True).status(Text(visible(text))) as status:
        yield lambda changed: status.update(Text(visible(changed)))


def telling(text: str, show: Callable[[str], None]) -> Callable[[float, float], None]:
    """What tells, from the first second on, which part is done and the time that is left."""
    began = time.monotonic()

    def tell(part: float, left: float) -> None:
        if time.monotonic() - began > LIMITS.soon:
            rest = f", {clock(left)} left" if math.isfinite(left) else ""
            show(f"{text}: {100 * part:.0f} %{rest}")

    return tell


def clock(seconds: float) -> str:
    """A time in s, in min and s, or in h and min."""
    whole = math.ceil(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def check_target(path: str | None, endings: Sequence[str], what: str) -> None:
    """Refuse, before the work, a file that could not be written after it. Raises OptionError."""
    if path is None:
        return
    file = Path(path)
    if file.suffix not in endings:
        problem = unknown("file ending", file.suffix, endings)
        hint = f"End the name of the {what} in {' or '.join(endings)}."
        raise OptionError([Problem(f"'{path}': {problem.what}", hint=hint)])
    if file.is_dir():
        raise OptionError([Problem(f"'{path}' is a folder", hint="Name a file.")])
    if not file.parent.is_dir():
        hint = "Make the folder first, or name another."
        raise OptionError([Problem(f"there is no folder '{file.parent}'", hint=hint)])
