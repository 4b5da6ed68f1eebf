"""`tracewire view`: a diagram as a live page in the browser of this machine."""

from __future__ import annotations

import threading
from typing import Annotated

import typer

from tracewire.cli.options import Debug, DiagramPath, Libraries
from tracewire.cli.output import flush, print_json, print_text, working
from tracewire.errors import OptionError


def view(
    diagram: DiagramPath,
    port: Annotated[
        int, typer.Option(metavar="N", help="The port of this machine; 0 takes a free one.")
    ] = 0,
    present: Annotated[
        bool,
        typer.Option("--present", help="For a class: large, without editing or saving."),
    ] = False,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Only print the address.")
    ] = False,
    limit: Annotated[
        float, typer.Option(metavar="SECONDS", help="The time that a run of the page may take.")
    ] = 5.0,
    seconds: Annotated[
        float | None,
        typer.Option("--for", metavar="SECONDS", help="End by itself after this time."),
    ] = None,
    library: Libraries = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the address as JSON, for programs.")
    ] = False,
    debug: Debug = False,
) -> None:
    """Show a diagram as a live page: sliders for its parameters, and curves that follow them.

    The page is served on this machine only, to who has its address. Ctrl-C ends it.

    \b
    Examples:
      tracewire view pendulum.yaml
      tracewire view pendulum.yaml --present
      tracewire view pendulum.yaml --no-browser --port 8080
    """
    for name, value in (("--limit", limit), ("--for", 1.0 if seconds is None else seconds)):
        if not value > 0:
            raise OptionError.one(f"{name} {value:g} leaves no time", hint="Give seconds above 0.")
    with working(f"opening {diagram}"):
        from tracewire.view import Service, open_server

        service = Service(diagram, library or (), present=present, seconds=limit)
        server = open_server(service, port)
    try:
        if as_json:
            print_json({"address": server.address})
        else:
            print_text(f"{server.address}   (Ctrl-C ends it)")
        flush()
        if not no_browser:
            import webbrowser

            opening = threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True)
            opening.start()
        if seconds is not None:
            ending = threading.Timer(seconds, server.shutdown)
            ending.daemon = True
            ending.start()
        server.serve_forever(poll_interval=0.1)
    except KeyboardInterrupt:  # the way to end it, and no failure
        pass
    finally:
        server.server_close()
