"""`tracewire.toml`: the libraries of the project that a person works in.

The file is looked for in the folder where a command is started, and upwards from there. It is never
looked for beside the diagram: a diagram of someone else must not bring Python that is run.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from tracewire.cli.output import note
from tracewire.errors import Location, OptionError, Problem, unknown
from tracewire.files import working_folder

NAME = "tracewire.toml"
KEYS = ("libraries",)
EXAMPLE = 'libraries = ["./blocks"]'


def with_project(given: Sequence[str] | None) -> list[str]:
    """The libraries of the project, which are told on stderr, and those of the command line.

    Raises OptionError: a `tracewire.toml` that is not well formed.
    """
    here = working_folder()
    file = None if here is None else _project_file(here)
    found = [] if file is None else _libraries(file)
    if found:
        note(f"libraries of {file}: {', '.join(found)}")
    folder = Path() if file is None else file.parent
    return [*(str(folder / path) for path in found), *(given or [])]


def _project_file(start: Path) -> Path | None:
    """The nearest file of the name that belongs to the person who runs this."""
    for folder in (start, *start.parents):
        file = folder / NAME
        if not file.is_file():
            continue
        # on POSIX: another person may have put it into a folder above, such as /tmp
        if hasattr(os, "geteuid") and file.stat().st_uid != os.geteuid():
            note(f"{file} belongs to another user, so it is not used.")
            continue
        return file
    return None


def _libraries(file: Path) -> list[str]:
    import tomllib

    place = Location(str(file))
    try:
        data = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # among them text that is not TOML, or not UTF-8
        what = f"this cannot be read as TOML: {error}"
        raise OptionError([Problem(what, place, (), f"Write it like {EXAMPLE}.")]) from None
    if strangers := [key for key in data if key not in KEYS]:
        raise OptionError([unknown("key", key, KEYS, place) for key in strangers])
    found = data.get("libraries", [])
    if not isinstance(found, list) or not all(isinstance(path, str) for path in found):
        what = "'libraries' must be a list of paths"
        raise OptionError([Problem(what, place, (), f"Write it like {EXAMPLE}.")])
    return found
