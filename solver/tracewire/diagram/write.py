"""A diagram's text as a file."""

from __future__ import annotations

from pathlib import Path

from tracewire.diagram.diagram import Diagram
from tracewire.diagram.files import absent_series
from tracewire.diagram.read import read_text
from tracewire.errors import DiagramError, OptionError, Place
from tracewire.files import write_file


def write(diagram: Diagram, path: str | Path, overwrite: bool = False) -> Path:
    """Write the diagram's text to a file, and return its path.

    Raises OptionError where another file is there already and `overwrite` is not said, or the file
    cannot be written; DiagramError where files that the diagram names are not found from there.
    """
    target = Path(path)
    try:
        own = target.exists() and diagram.file.exists() and target.samefile(diagram.file)
        if target.exists() and not own and not overwrite:
            hint = "Choose another name, or say that it may be overwritten."
            raise OptionError.one("there is a file of this name", Place(str(target)), hint=hint)
        if target.resolve().parent != diagram.file.resolve().parent:
            moved = read_text(diagram.text, target, library=diagram.library)
            there = absent_series(diagram)
            lost = [p for name, p in absent_series(moved).items() if name not in there]
            if lost:
                raise DiagramError(lost)
        write_file(target, diagram.text)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        what = f"the file cannot be written: {reason}"
        raise OptionError.one(what, Place(str(target)), hint="Check its folder.") from None
    return target
