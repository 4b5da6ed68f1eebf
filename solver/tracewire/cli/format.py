"""`tracewire format`: diagram files in one layout."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracewire.cli.check import diagram_files
from tracewire.cli.options import AsJson, Debug
from tracewire.cli.output import print_json, print_text
from tracewire.errors import Problem, TracewireError

UNFORMATTED = 1
"""The exit code of --check where a file has another layout."""


def format(
    diagrams: Annotated[
        list[str],
        typer.Argument(
            metavar="DIAGRAM...",
            help="Diagram files (YAML), or folders; - is stdin, and prints.",
            show_default=False,
        ),
    ],
    check: Annotated[
        bool, typer.Option("--check", help="Only name the files that would change; exit with 1.")
    ] = False,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Lay diagrams out anew: blanks, quotes and the order of sections, and nothing else.

    Comments and line breaks stay. The diagram means the same as before: a file is written only
    where that is so.

    \b
    Examples:
      tracewire format pendulum.yaml
      tracewire format diagrams/ --check
    """
    from tracewire.diagram import STDIN, lay_out, load_stdin, load_text
    from tracewire.files import write_file, writing

    changed: list[str] = []
    problems: list[Problem] = []
    code: type[TracewireError] = TracewireError
    files = diagram_files(diagrams)
    for name in files:
        file = STDIN if name == "-" else Path(name)
        try:
            text = load_stdin() if name == "-" else load_text(file)
            found = lay_out(text, file)
            if name == "-" and not check:
                print_text(found.rstrip("\r\n"))
                continue
            if found != text and not check:
                with writing(file):
                    write_file(file, found)
            changed += [name] if found != text else []
        except TracewireError as error:
            problems += error.problems
            code = type(error)
    if not problems or changed:
        _tell(changed, len(files), check, as_json, printed="-" in files)
    if problems:
        raise code(problems)
    if changed and check:
        raise typer.Exit(UNFORMATTED)


def _tell(changed: list[str], count: int, check: bool, as_json: bool, printed: bool) -> None:
    if as_json:
        print_json({"files": count, "would_change" if check else "written": changed})
        return
    for name in changed:
        print_text(f"{'would change' if check else 'written'}: {name}")
    if not changed and (check or not printed):
        print_text("no file needs another layout" if count > 1 else "the layout is in order")
