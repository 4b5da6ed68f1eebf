"""Sets of real measurements, fetched for a user: files of their owners, and the diagrams on them.

`tracewire.data.index` says which sets there are.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

from tracewire.data.index import RAW, SETS, DataSet, Upstream
from tracewire.errors import DownloadError, Location, OptionError, Problem, unknown
from tracewire.extras import import_extra
from tracewire.files import write_file
from tracewire.shipped import shipped

DIAGRAMS = (".yaml", ".md")


def data_set(name: str) -> DataSet:
    """The set of a name. Raises OptionError."""
    if name not in SETS:
        raise OptionError([unknown("set of measurements", name, SETS)])
    return SETS[name]


def get_set(
    name: str,
    to: str | Path = ".",
    tell: Callable[[str], None] = lambda text: None,
    base: str = RAW,
) -> Path:
    """Bring a set: the folder `to`/`name` with its diagrams, and its files in `data/` below.

    A file that is there and has the right content is not fetched again; a diagram that is there is
    kept. tell: called with a line for each file. Raises OptionError where there is no such set, or
    no folder `to`; DownloadError where pooch is missing, the network, or the file is another.
    """
    chosen = data_set(name)
    if not Path(to).is_dir():
        hint = "Make the folder first, or name another."
        raise OptionError([Problem(f"there is no folder '{to}'", hint=hint)])
    home = Path(to) / name
    try:
        (home / "data").mkdir(parents=True, exist_ok=True)
        for file in chosen.files:
            fetch(chosen, file, home / "data", tell, base)
        for made, text_of in chosen.made.items():
            write_file(home / "data" / made, text_of(home / "data"))
            tell(f"made     {home / 'data' / made}")
        for source in sorted((shipped("diagrams") / "real" / name).glob("*")):
            if source.suffix in DIAGRAMS and not (home / source.name).exists():
                write_file(home / source.name, source.read_bytes())
                tell(f"copied   {home / source.name}")
    except OSError as error:
        hint = "Check its name and rights, and the space on the disk."
        what = f"'{error.filename or home}' cannot be written: {error.strerror or error}"
        raise DownloadError([Problem(what, hint=hint)]) from error
    return home


def fetch(
    chosen: DataSet,
    file: Upstream,
    folder: Path,
    tell: Callable[[str], None] = lambda text: None,
    base: str = RAW,
) -> None:
    """Fetch a file of a set into a folder, unless it is there. Raises DownloadError."""
    path = folder / file.name
    if path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == file.sha256:
        tell(f"is there {path}")
        return
    address = chosen.address(file, base)
    tell(f"fetching {address}")
    pooch = import_extra(
        "pooch", "data", "to fetch files", error=DownloadError, otherwise=_by_hand(path)
    )
    pooch.get_logger().setLevel("ERROR")  # what is fetched has been told
    try:
        pooch.retrieve(address, f"sha256:{file.sha256}", fname=file.name, path=folder)
    except ValueError as error:
        what = f"what came from {address} is not the file of this set: its SHA-256 is another"
        hint = f"It must be {file.sha256}. Nothing was kept."
        raise DownloadError([Problem(what, Location(str(path)), hint=hint)]) from error
    except Exception as error:  # of the library under pooch, whose errors have no common class
        if isinstance(error, OSError) and error.filename:
            raise
        what = f"{address} could not be fetched ({type(error).__name__})"
        hint = f"Check the network, and try again. {_by_hand(path)}"
        raise DownloadError([Problem(what, hint=hint)]) from error


def _by_hand(path: Path) -> str:
    return f"Or put the file to '{path}' yourself."
