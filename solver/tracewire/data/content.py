"""What a file is: its bytes, the kind of file that they tell, and their text."""

from __future__ import annotations

import os
import stat
from collections.abc import Sequence
from pathlib import Path

from tracewire.data.limits import FILE
from tracewire.errors import DataError, Location, Problem, unknown

AS_TEXT = "Save it as text, in UTF-8."
AS_CSV = "Open it, and save the sheet or table as CSV (text with commas)."
UNPACK = "Unpack it, and name the file with the numbers."

# what a file is by its first bytes, whatever its name says
KINDS: tuple[tuple[bytes, str, str], ...] = (
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook (.xls), or another Office file", AS_CSV),
    (b"%PDF", "a PDF", "Ask for the numbers as CSV."),
    (b"\x1f\x8b", "a gzip archive", UNPACK),
    (b"BZh", "a bzip2 archive", UNPACK),
    (b"\xfd7zXZ", "an xz archive", UNPACK),
    (b"7z\xbc\xaf", "a 7-zip archive", UNPACK),
    (b"Rar!", "a RAR archive", UNPACK),
    (b"\x93NUMPY", "an array of numpy (.npy)", "Write it with numpy.savetxt."),
    (b"SQLite format 3", "an SQLite database", "Export the table as CSV."),
    (b"\x89PNG", "a picture", "Give the numbers as CSV."),
    (b"\xff\xd8\xff", "a picture", "Give the numbers as CSV."),
    (b"{\\rtf", "a text document (.rtf)", "Save it as plain text."),
)
IN_ZIP = (
    (b"opendocument.spreadsheet", "a spreadsheet of OpenDocument (.ods)", AS_CSV),
    (b"word/", "a Word document (.docx)", "Give the numbers as CSV."),
    (b".npy", "an archive of numpy (.npz)", "Write the arrays with numpy.savetxt."),
)
MARKUP = (b"<html", b"<!doctype html", b"<?xml")
ZIP, WORKBOOK = b"PK\x03\x04", b"xl/"


def content_of(path: Path, place: Location) -> bytes:
    """The bytes of a regular file of at most 200 MB; DataError where it is none or is empty."""
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise _refused(place, path, "is a folder", "Name a file in it.", _names(path))
        if not stat.S_ISREG(status.st_mode):
            raise _refused(place, path, "is not a regular file", "Copy its content into a file.")
        if status.st_size > FILE.most_bytes:
            size, limit = (f"{count / 1e6:.0f} MB" for count in (status.st_size, FILE.most_bytes))
            what = f"is too large: {size}, and the limit is {limit}"
            raise _refused(place, path, what, "Split it, or keep every n-th row.")
        content = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError) as error:
        raise DataError([_missing(path, place)]) from error
    except (OSError, ValueError) as error:  # ValueError: a path that no file can have
        what = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        raise _refused(place, path, what, "Check its name and permissions.") from error
    if not content.strip(b"\xef\xbb\xbf \t\r\n"):
        raise _refused(place, path, "is empty", "Its rows must hold numbers.")
    return content


def is_workbook(content: bytes) -> bool:
    """Whether a file is an Excel workbook (.xlsx)."""
    return content.startswith(ZIP) and _in_zip(content, WORKBOOK)


def refuse_other_kinds(content: bytes, path: Path, place: Location) -> None:
    """Raise DataError with its name where the file is of a known kind that is not read."""
    head = content[:4096]
    if content.startswith(ZIP):
        known = (kind for kind in IN_ZIP if _in_zip(content, kind[0]))
        _, name, hint = next(known, (b"", "a zip archive", UNPACK))
        raise _other(place, path, name, hint)
    for mark, name, hint in KINDS:
        if content.startswith(mark):
            raise _other(place, path, name, hint)
    if content[:1] == b"\x80" and content[1:2] in b"\2\3\4\5" and content.rstrip()[-1:] == b".":
        hint = "It is never opened, since that could run any program. Write the numbers as CSV."
        raise _other(place, path, "a pickle of Python", hint)
    if head.lstrip(b"\xef\xbb\xbf \t\r\n").lower().startswith(MARKUP):
        raise _other(place, path, "a web page or XML, whatever its name says", AS_CSV)


def _in_zip(content: bytes, mark: bytes) -> bool:
    return mark in content[:4096] or mark in content[-65536:]


def text_of(content: bytes, path: Path) -> tuple[list[str], tuple[str, ...]]:
    """The lines of a text, and what is odd about its characters.

    Text is UTF-8; with a mark for it UTF-16; else it is read as Windows-1252, the usual one of
    laboratory programs, with a remark. Raises DataError where it is no text at all.
    """
    remarks: tuple[str, ...] = ()
    if content.startswith((b"\xff\xfe", b"\xfe\xff")) and len(content) % 2 == 0:
        try:
            return _lines(content.decode("utf-16")), ("the file is in UTF-16, and not in UTF-8",)
        except UnicodeDecodeError:
            pass  # the message below names the byte
    if (zero := content.find(b"\0")) >= 0:
        raise _at(path, content, zero, "the file is not text: it holds a zero byte")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        byte = f"0x{content[error.start]:02x}"
        try:
            text = content.decode("cp1252")
        except UnicodeDecodeError:
            raise _at(path, content, error.start, f"the byte {byte} is not UTF-8 text") from error
        line = content.count(b"\n", 0, error.start) + 1
        shown = text[len(content[: error.start].decode("cp1252"))]
        remarks = (
            f"the file is not in UTF-8; it is read as Windows-1252, where the byte {byte} in line "
            f"{line} is '{shown}'",
        )
    return _lines(text), remarks


def _lines(text: str) -> list[str]:
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _at(path: Path, content: bytes, index: int, what: str) -> DataError:
    spot = Location(str(path), content.count(b"\n", 0, index) + 1)
    return DataError([Problem(what, spot, hint=AS_TEXT)])


def _names(folder: Path) -> list[str]:
    try:
        return sorted(entry.name for entry in os.scandir(folder) if entry.is_file())
    except OSError:
        return []


def _missing(path: Path, place: Location) -> Problem:
    folder = path.parent
    if not folder.is_dir():
        return Problem(
            f"there is no file '{path}', and no folder '{folder}'", place, hint="Check the path."
        )
    names = _names(folder)
    alike = [name for name in names if Path(name).suffix == path.suffix]
    problem = unknown("file", path.name, alike or names, place)
    return Problem(f"{problem.what} in '{folder}'", place, problem.exists, problem.hint)


def _other(place: Location, path: Path, name: str, hint: str) -> DataError:
    return _refused(place, path, f"is {name}, and not a table of text", hint)


def _refused(
    place: Location, path: Path, what: str, hint: str, exists: Sequence[str] = ()
) -> DataError:
    named = f"'{path}'" if place.file != str(path) else "the file"
    return DataError([Problem(f"{named} {what}", place, tuple(exists), hint)])
