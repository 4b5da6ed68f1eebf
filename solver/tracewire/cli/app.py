"""The command `tracewire`: its verbs, and what becomes of their errors."""

from __future__ import annotations

import gc
import re
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from itertools import pairwise
from typing import Annotated

import typer
from typer.main import get_command

from tracewire.cli.interrupt import INTERRUPTED, is_interrupt
from tracewire.cli.limits import LIMITS
from tracewire.cli.multi_value import MultiValueCommand, OneValueCommand
from tracewire.cli.output import Cut, print_problems
from tracewire.cli.records import with_fields
from tracewire.cli.streams import safe_streams
from tracewire.cli.verb_group import VerbGroup
from tracewire.errors import Problem, TracewireError

STOPPED = Problem("interrupted; nothing was finished")
USAGE_ERROR: type[Exception] = typer.BadParameter.__bases__[0]
"""The base of every usage error; typer has its own copy of click or uses the installed one."""

EXTRA = re.compile(r"[Uu]nexpected extra arguments?(?:\(s\))? \((.+)\)")

VERBS = (
    *("check", "show", "draw", "view", "run", "animate", "fit", "trace", "report", "sweep"),
    *("paper", "blocks", "units", "format", "rename", "schema", "demo", "analyse", "data", "new"),
)
"""In the order of the help. Each is a function, or a `typer.Typer` of several, in the file of its
name; a verb imports what is slow to import inside its function."""

OTHER_NAMES = {
    "simulate": "run",
    "sim": "run",
    "effects": "blocks",
    "library": "blocks",
    "laws": "blocks",
    "plot": "run",
    "gui": "view",
    "edit": "view",
    "lint": "check",
    "validate": "check",
    "optimise": "fit",
    "optimize": "fit",
    "estimate": "fit",
    "calibrate": "fit",
    "identify": "trace",
    "diagnose": "trace",
}
"""What other tools call these verbs."""


def tracewire_(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Simulate block diagrams, fit them to measured data, trace what they lack.

    \b
    Examples:
      tracewire check pendulum.yaml
      tracewire show pendulum.yaml --equations
      tracewire draw pendulum.yaml --depth 1
      tracewire view pendulum.yaml
      tracewire run pendulum.yaml --figure swing.png
      tracewire run pendulum.yaml --set "phi=13.6 deg" --output swing.csv
      tracewire animate pendulum.yaml
      tracewire fit pendulum.yaml --report fit.html
      tracewire trace pendulum.yaml --apply
      tracewire analyse steady pendulum.yaml
      tracewire blocks dry_friction
      tracewire units "N m s/deg"
      tracewire schema --modeline pendulum.yaml
    """
    if version:
        typer.echo(f"tracewire {_version()}")
        raise typer.Exit


def _app(verbs: Sequence[str]) -> typer.Typer:
    """The command line with these verbs."""
    app = typer.Typer(
        cls=VerbGroup,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(tracewire_)
    for verb in verbs:
        made = getattr(import_module(f"tracewire.cli.{verb}"), verb)
        if isinstance(made, typer.Typer):
            app.add_typer(made, name=verb)
        else:
            kind = MultiValueCommand if verb == "trace" else OneValueCommand
            app.command(cls=kind)(with_fields(made))
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0: done; 1: the work failed; 2: the input is wrong; 130: interrupted. Every error is told in
    words on stderr, and with --json on stdout as well; --debug shows the traceback, too. A stdout
    that takes no more ends the command with 1; one that is closed, and stderr, change nothing.
    """
    given = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    if arguments is None:  # the process is this command's own
        gc.set_threshold(LIMITS.new_objects)
    problems: list[Problem] = []
    with safe_streams() as ending:
        try:
            known = given[0] in VERBS or given == ["--version"]  # to import all verbs takes 0.2 s
            command = get_command(_app([verb for verb in VERBS if verb in given[:1] or not known]))
            ended: object = command.main(given, prog_name="tracewire", standalone_mode=False)
            ending.code = ended if isinstance(ended, int) else 0
            if ended == INTERRUPTED:  # what typer makes of an interrupt
                problems = [STOPPED]
        except Cut:
            ending.code = INTERRUPTED
        except SystemExit as end:  # what typer makes of a reader that has gone
            ending.code = end.code if isinstance(end.code, int) else 1
        except (Exception, KeyboardInterrupt) as error:
            problems, ending.code = _told(error, given)
            if "--debug" in given:
                traceback.print_exception(error)
        if problems:
            print_problems(problems, "--json" in given)
    return ending.code


def _version() -> str:
    # the package stands above the rooms: they do not import it, but it is there when they run
    return str(sys.modules["tracewire"].__version__)


def _told(error: BaseException, given: Sequence[str]) -> tuple[list[Problem], int]:
    """What to say of an error, and the exit code."""
    if isinstance(error, TracewireError):
        return list(error.problems), error.exit_code
    if isinstance(error, USAGE_ERROR):
        return [_usage(error, given)], 2
    if is_interrupt(error) or isinstance(error, typer.Abort):
        return [STOPPED], INTERRUPTED
    what = f"internal error ({type(error).__name__}: {error})"
    return [Problem(what, hint="Please report it; --debug shows the traceback.")], 1


def _usage(error: Exception, given: Sequence[str]) -> Problem:
    context = getattr(error, "ctx", None)
    path = context.command_path if context is not None else "tracewire"
    message = error.format_message() if hasattr(error, "format_message") else str(error)
    what, _, meant = message.strip().partition(" Did you mean ")
    hint = f"Did you mean {meant} " if meant else ""
    if path == "tracewire" and given[0] in OTHER_NAMES:
        hint = f"It is '{OTHER_NAMES[given[0]]}' here. "
    if extra := EXTRA.search(what):
        names = extra[1].split()
        what = f"unexpected {'argument' if len(names) == 1 else 'arguments'}: {' '.join(names)}"
        if ("--json", names[0]) in pairwise(given):
            hint = f"--json prints to the screen: `--json > {names[0]}` writes that to a file. "
            options = context.command.params if context is not None else ()
            if any("--save" in option.opts for option in options):
                hint = f"--json prints to the screen; --save {names[0]} keeps the result. "
    return Problem(what.rstrip("."), hint=f"{hint}See '{path} --help'.")
