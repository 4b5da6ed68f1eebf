"""`tracewire check --expect`: do diagrams show what their sections `expect` say?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from tracewire.cli.options import note_units, read_diagram
from tracewire.cli.output import print_json, print_table, print_text, working
from tracewire.cli.progress import stages
from tracewire.errors import DiagramError, OptionError, Problem, TracewireError


def check_expected(
    files: Sequence[str],
    against: str | None,
    libraries: Sequence[str] | None,
    as_json: bool,
) -> None:
    """Measure the statements of each diagram, or those of the diagram `against` on each; print a
    table, and end with the exit code 1 where one fails. Raises OptionError, DiagramError.
    """
    from tracewire.analyse import Judge, counts_of
    from tracewire.compile import statement_problems, unit_problems
    from tracewire.diagram import Diagram
    from tracewire.paper import with_identification
    from tracewire.show import statement_data, statements_table

    lesson = None if against is None else read_diagram(against, libraries)
    judge = Judge(libraries=libraries or ())
    diagrams: list[Diagram] = []
    problems: list[Problem] = []
    code: type[TracewireError] = OptionError
    with working("compiling"):
        for file in files:
            try:
                diagram = read_diagram(file, libraries)
                chosen = (lesson or diagram).expect
                model = judge.model(diagram)
                wrong = statement_problems(model, chosen)
                if lesson is None:
                    wrong = [*unit_problems(model.flat), *wrong]
                else:  # a solution is marked as it stands
                    note_units(model)
                if wrong:
                    raise DiagramError(wrong)
                diagrams.append(diagram)
            except TracewireError as error:
                problems += error.problems
                code = type(error)
    if problems:
        raise code(problems)
    if not (lesson.expect if lesson is not None else any(d.expect for d in diagrams)):
        where = against or ", ".join(files[:3])
        hint = "Write expect: [{that: end(x), is: 2, within: 0.1}] in the diagram."
        raise OptionError([Problem(f"there is no statement to check in {where}", hint=hint)])
    rows = []
    with working("measuring") as show:
        judge.tell = stages(show)
        with_identification(judge)
        for diagram in diagrams:
            rows.append((diagram, judge.judge(diagram, (lesson or diagram).expect)))
    every = [row for _, found in rows for row in found]
    holds = all(row.holds for row in every)
    if as_json:
        data = [
            {"file": str(diagram.file), "statements": [statement_data(row) for row in found]}
            for diagram, found in rows
        ]
        print_json({"holds": holds, "counts": counts_of(every), "diagrams": data})
    else:
        for diagram, found in rows:
            if not found:
                continue
            title = diagram.title or Path(diagram.file).stem
            print_table(statements_table(found, title))
            for row in found:
                if not row.holds:
                    print_text(f"{row.statement.place}: {row.statement.name}: {row.why}")
        failed = sum(not row.holds for row in every)
        print_text(f"{len(every) - failed} of {len(every)} statements hold")
    if not holds:
        raise typer.Exit(1)
