"""`tracewire check`: is everything in order with a diagram and its data?"""

from __future__ import annotations

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import print_json, print_text, working


def check(
    diagram: DiagramPath,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Check a diagram, its formulas and its measured files, and say what is in it.

    Everything that is wrong in the diagram is told at once, with file, line and column. Of each
    measured series it tells what is done to the data (-), and what is odd about them (!).

    \b
    Example:
      tracewire check pendulum.yaml
    """
    from tracewire.show.summary import contents, contents_text, series_contents
    from tracewire.solve import parameter_values

    model = load_model(diagram, library)
    for preset in ("", *model.flat.presets):  # they must be what the diagram requires
        parameter_values(model, {}, preset)
    measured = []
    if model.diagram.measured:
        with working("reading the measured series"):
            from tracewire.residual import load_measured

            measured = [series_contents(series) for series in load_measured(model)]
    found = contents(model)
    if as_json:
        print_json({"problems": [], **found, "measured": measured})
        return
    print_text(contents_text(found, measured))
    print_text("no problems")
