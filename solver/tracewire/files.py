"""Files are written whole: beside, flushed to the disk, and only then under their own name."""

from __future__ import annotations

import contextlib
import csv
import errno
import io
import os
import secrets
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, cast

from tracewire.errors import OptionError

PERMISSIONS = 0o666  # of a new file, less the user's umask
HINT = "Name a file in a folder that exists and may be written to, and check the space on the disk."
"""What to do about a file that cannot be written."""


def write_file(path: str | Path, content: str | bytes, permissions: int = PERMISSIONS) -> Path:
    """Write text (UTF-8, line ends as they are) or bytes; see `replacing`. Raises OSError."""
    with replacing(path, permissions) as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return Path(path)


def write_rows(path: str | Path, header: Sequence[str], rows: Iterable[Iterable[object]]) -> Path:
    """Write a .csv file with a row of names; floats keep all digits. Raises OSError."""
    with replacing(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        writer = csv.writer(text)
        writer.writerow(header)
        writer.writerows([repr(v) if isinstance(v, float) else v for v in row] for row in rows)
        text.detach()  # flushes it, and leaves the file open
    return Path(path)


def check_writable(path: str | Path) -> None:
    """Raises OSError where a file of this name could not be written now; leaves nothing."""
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    part = _part(target)
    os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL))
    part.unlink()


@contextmanager
def replacing(path: str | Path, permissions: int = PERMISSIONS) -> Iterator[IO[bytes]]:
    """A binary file to write to, which becomes `path` when the block ends well.

    Until then, and where the block or the disk fails, an older file of that name stays as it is;
    its permissions go over to the new one. A link stays a link. A pipe or a device has no older
    content, and is written as it is. A process that is killed leaves `.NAME.XXXXXXXX.part` at most.
    Raises OSError.
    """
    target = Path(os.path.realpath(path))
    old = target.stat() if target.exists() else None
    if old is not None and not target.is_file():
        with open(target, "wb") as file:
            yield file
        return
    part = _part(target)
    try:
        descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, permissions)
        with cast(IO[bytes], open(descriptor, "wb")) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        if old is not None:
            os.chmod(part, old.st_mode & 0o7777)
        os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
        raise
    _keep_name(target.parent)


def working_folder() -> Path | None:
    """The folder in which this program works; None where it has been deleted."""
    try:
        return Path.cwd().resolve()
    except OSError:
        return None


@contextmanager
def writing(path: str | Path) -> Iterator[None]:
    """Tell in words that a file cannot be written. Raises OptionError for an OSError."""
    try:
        yield
    except OSError as error:
        what = f"'{path}' cannot be written: {error.strerror or error}"
        raise OptionError.one(what, hint=HINT) from error


def _part(target: Path) -> Path:
    """Another name each time: two processes that write the same file do not share it."""
    return target.with_name(f".{target.name[:60]}.{secrets.token_hex(4)}.part")


def _keep_name(folder: Path) -> None:
    """Flush the names in a folder, so that a loss of power does not undo the replacement.

    The file itself is complete by now: where the system does not flush folders, it stays so.
    """
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
