"""`tracewire show`: what a diagram says, in tables, equations or Python."""

from __future__ import annotations

from typing import Annotated

import typer

from tracewire.cli.options import AsJson, Debug, DiagramPath, Libraries, load_model
from tracewire.cli.output import print_json, print_table, print_text


def show(
    diagram: DiagramPath,
    equations: Annotated[bool, typer.Option("--equations", help="The flat equations.")] = False,
    source: Annotated[bool, typer.Option("--source", help="The equations as Python.")] = False,
    text: Annotated[
        bool, typer.Option("--text", help="The diagram as one YAML text, all written out.")
    ] = False,
    parameters: Annotated[bool, typer.Option("--parameters", help="The parameters.")] = False,
    tree: Annotated[bool, typer.Option("--tree", help="Blocks and subsystems.")] = False,
    library: Libraries = None,
    as_json: AsJson = False,
    debug: Debug = False,
) -> None:
    """Show a diagram: parameters, states, recorded signals and places where an effect may be tried.

    Options choose single parts; several may be given.

    \b
    Examples:
      tracewire show pendulum.yaml --tree
      tracewire show pendulum.yaml --source > pendulum.py
      tracewire show chain.yaml --text
    """
    from tracewire.diagram import write_out
    from tracewire.show import summary

    model = load_model(diagram, library)
    whole = not (equations or source or text or parameters or tree)
    if as_json:
        data = summary.overview(model)
        if equations:
            data["equations"] = model.equations.split("\n")
        if source:
            data["source"] = model.source
        if text:
            data["text"] = write_out(model.diagram)
        if tree:
            data["tree"] = summary.tree(model.diagram)
        print_json(data)
        return
    if whole:
        print_text(model.flat.title)
    if whole or parameters:
        print_table(summary.parameters_table(model))
    if whole:
        for table in (
            summary.states_table(model),
            summary.recorded_table(model),
            summary.places_table(model),
        ):
            if table.rows:
                print_table(table)
        if model.flat.presets:
            print_text(f"presets: {', '.join(model.flat.presets)}")
        if model.diagram.measured:
            print_text(f"measured: {', '.join(model.diagram.measured)}")
    if tree:
        print_text(summary.tree_text(model.diagram))
    if equations:
        print_text(model.equations)
    if source:
        print_text(model.source.rstrip("\n"))
    if text:
        print_text(write_out(model.diagram).rstrip("\n"))
