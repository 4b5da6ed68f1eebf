"""The measured sets of diagrams/real, laid out from files at hand as `tracewire data get` does."""

from __future__ import annotations

from pathlib import Path

from tracewire.data.sets import data_set, get_set

ROOT = Path(__file__).parents[2]
REAL = ROOT / "diagrams" / "real"
SHARED = ROOT.parent / "shared" / "data"
DIAGRAMS = tuple(sorted(path.relative_to(REAL).as_posix() for path in REAL.glob("*/*.yaml")))


def lay_out(name: str, to: Path, shared: Path = SHARED) -> Path:
    """The folder `to`/`name` of a set: its diagrams, and `data/` with all files that they read.

    The files are links to `shared`/`name`, where each has the name that the index of the sets gives
    it; `get_set` then checks their SHA-256, and makes the CSV files and the diagrams. Nothing is
    fetched. Raises FileNotFoundError where a file is missing.
    """
    home = to / name
    data = home / "data"
    data.mkdir(parents=True, exist_ok=True)
    for file in data_set(name).files:
        source = (shared / name / file.name).resolve(strict=True)
        if not (data / file.name).exists():
            (data / file.name).symlink_to(source)
    return get_set(name, to)
