"""`tracewire check`: is everything in order with diagrams and their data?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tracewire.cli.expect import check_expected
from tracewire.cli.options import AsJson, Debug, Libraries, read_diagram
from tracewire.cli.output import print_json, print_text, working
from tracewire.errors import DiagramError, OptionError, Problem, TracewireError

if TYPE_CHECKING:
    from tracewire.compile import Model

ENDINGS = (".yaml", ".yml")


def check(
    diagrams: Annotated[
        list[str],
        typer.Argument(
            metavar="DIAGRAM...",
            help="Diagram files (YAML), or folders; - is stdin.",
            show_default=False,
        ),
    ],
    expect: Annotated[
        bool, typer.Option("--expect", help="Measure the statements of the section 'expect'.")
    ] = False,
    against: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Measure the statements of this diagram instead."),
    ] = None,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Check diagrams, their formulas and their measured files, and say what is in them.

    Everything that is wrong is told at once, with file, line and column. Of each measured series
    it tells what is done to the data (-), and what is odd about them (!). A measured file that is
    not there is a remark: the diagram can be run without. In a folder all files with `blocks:` or
    `extends:` are checked. With --expect their statements are measured and told in a table; the
    exit code is 1 where one of them does not hold.

    \b
    Examples:
      tracewire check pendulum.yaml
      tracewire check --expect pendulum.yaml
      tracewire check student.yaml --against lesson.yaml
      tracewire check diagrams/
      tracewire check - < pendulum.yaml
    """
    problems: list[Problem] = []
    found: list[dict[str, Any]] = []
    code: type[TracewireError] = OptionError
    files = diagram_files(diagrams)
    if expect or against is not None:
        check_expected(files, against, library, as_json)
        return
    for file in files:
        try:
            found.append(_contents(file, library, as_json))
        except TracewireError as error:
            problems += error.problems
            code = type(error)
    if problems:
        raise code(problems)
    if as_json:
        one = len(files) == 1
        told = found[0] if one else {"diagrams": found}
        print_json({"problems": [], **told})
    else:
        absent = sum(len(one["absent"]) for one in found)
        print_text(f"no problems{_absent_words(absent)}")


def _contents(file: str, library: Sequence[str] | None, quiet: bool) -> dict[str, Any]:
    """What is in a diagram, printed unless `quiet`. Raises TracewireError."""
    from tracewire.diagram import absent_series
    from tracewire.show.summary import contents, contents_text, series_contents
    from tracewire.solve import initial_value_problem, parameter_values

    with working(f"compiling {'stdin' if file == '-' else file}"):
        from tracewire.compile import compile, remarks_of, statement_problems, unit_problems

        model = compile(read_diagram(file, library), backend="python")  # it evaluates little
    if problems := [*unit_problems(model.flat), *statement_problems(model, model.diagram.expect)]:
        raise DiagramError(problems)
    for preset in ("", *model.flat.presets):  # what `run` refuses before its first step
        initial_value_problem(model, preset=preset, inputs=_at_rest(model))
    measured: list[dict[str, object]] = []
    absent = absent_series(model.diagram)
    remarks = [*remarks_of(model, parameter_values(model, {})), *map(str, absent.values())]
    found = {**contents(model), "remarks": remarks}
    present = [name for name in model.diagram.measured if name not in absent]
    if present:
        with working("reading the measured series"):
            from tracewire.residual import (
                free_names,
                load_measured,
                refuse_readers_of_free,
                sigma_problem,
            )

            refuse_readers_of_free(model)
            series = load_measured(model, driving=True, series=present)
            measured = [series_contents(one, model) for one in series]
            found["free"] = free_names(model, series)
            remarks += sigma_problem(model.diagram, present)
    if not quiet:
        print_text(contents_text(found, measured))
    return {**found, "measured": measured, "absent": list(absent)}


def _at_rest(model: Model) -> dict[str, tuple[list[float], list[float]]]:
    """Zero for each input without a default: no start reads an input."""
    without = [name for name, default in model.flat.inputs.items() if default is None]
    return {name: ([0.0], [0.0]) for name in without}


def _absent_words(count: int) -> str:
    if not count:
        return ""
    series = "1 measured series has" if count == 1 else f"{count} measured series have"
    return f" in the diagram, but {series} no file, which a fit or a trace needs: see above"


def diagram_files(paths: Sequence[str]) -> list[str]:
    """The files, and the diagrams in folders. Raises OptionError."""
    found: list[str] = []
    for path in paths:
        if not Path(path).is_dir():
            found.append(path)
            continue
        inside = [
            str(file)
            for file in sorted(Path(path).rglob("*"))
            if file.suffix in ENDINGS and _is_diagram(file)
        ]
        if not inside:
            what = f"there is no diagram in '{path}'"
            hint = "A diagram is a file that ends in .yaml and has 'blocks:' or 'extends:'."
            raise OptionError([Problem(what, hint=hint)])
        found += inside
    return found


def _is_diagram(file: Path) -> bool:
    text = file.read_text(encoding="utf-8", errors="replace")
    return any(line.startswith(("blocks:", "extends:")) for line in text.splitlines())
