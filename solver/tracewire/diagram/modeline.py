"""The first line of a diagram that tells an editor where its schema is."""

from __future__ import annotations

import os
import re
from pathlib import Path

from tracewire.errors import Location, OptionError

MODELINE = re.compile(r"^#\s*yaml-language-server\s*:.*$", re.MULTILINE)
ADDRESS = re.compile(r"^#\s*yaml-language-server\s*:\s*\$schema=(\S+)", re.MULTILINE)


def with_modeline(text: str, file: Path, schema: Path) -> str:
    """The text with the line that names the schema, relative to the file; an older one is replaced.

    Raises OptionError: the path has a blank, which ends it in the eyes of an editor.
    """
    address = _relative(schema, file.resolve().parent)
    if re.search(r"\s", address):
        what = f"an editor reads the path '{address}' only up to its blank"
        hint = "Write the schema into the diagram's folder, with --output."
        raise OptionError.one(what, Location(str(file)), hint=hint)
    line = f"# yaml-language-server: $schema={address}"
    mark = "\ufeff" if text.startswith("\ufeff") else ""
    found = MODELINE.search(text, len(mark))
    if found is not None:
        kept = "\r" if found.group().endswith("\r") else ""
        return text[: found.start()] + line + kept + text[found.end() :]
    ending = "\r\n" if "\r\n" in text else "\n"
    return f"{mark}{line}{ending}{text.removeprefix(mark)}"


def is_modeline(line: str) -> bool:
    """Whether a line tells an editor where the schema is."""
    return MODELINE.fullmatch(line) is not None


def moved_modeline(text: str, old: Path, new: Path) -> str:
    """The text of the file `old` as the file `new` has it: its line still names the same schema.

    An address on the network, and a path to what is not there, stay as they are.
    """
    found = ADDRESS.search(text)
    if found is None:
        return text
    schema = old.resolve().parent / found[1]
    try:
        is_there = schema.is_file()
    except (OSError, ValueError):
        is_there = False
    moved = _relative(schema, new.resolve().parent)
    if not is_there or re.search(r"\s", moved):
        return text
    return text[: found.start(1)] + moved + text[found.end(1) :]


def _relative(path: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(path.resolve(), folder)).as_posix()
    except ValueError:  # on another drive
        return path.resolve().as_uri()
