"""Measured files with what goes wrong in files: an answer in numbers, or the place in words."""

from __future__ import annotations

import re
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

import pytest
from cli.conftest import Call, Result

LESSONS = Path(__file__).parents[2] / "diagrams" / "lessons"
HEAD = "t [s],theta [rad]"
SECONDS = 240  # for a command, on a busy machine
BRIEF = 121  # lines of a file, for a trace
Rows = list[list[str]]


def measured() -> Rows:
    """Every eighth row of the swing."""
    lines = (LESSONS / "pendulum_swing.csv").read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines[lines.index(HEAD) + 1 :]][::8]


def written(rows: Rows, head: str = HEAD, between: str = ",", end: str = "\n") -> bytes:
    lines = [head.replace(",", between), *(between.join(row) for row in rows)]
    return (end.join(lines) + end).encode()


def cell(column: int, value: str) -> bytes:
    rows = measured()
    rows[7][column] = value
    return written(rows)


def scaled(column: int, power: int) -> bytes:
    """A column times a power of ten."""
    rows = measured()
    for row in rows:
        row[column] = f"{float(row[column])!r}e{power}"
    return written(rows)


def theta(value: str) -> bytes:
    return written([[t, value] for t, _ in measured()])


REFUSED: dict[str, Callable[[], bytes]] = {
    "a time is NaN": lambda: cell(0, "nan"),
    "a value is infinite": lambda: cell(1, "-inf"),
    "a value is text": lambda: cell(1, "abc"),
    "a time is text": lambda: cell(0, "abc"),
    "a time is missing": lambda: cell(0, ""),
    "a number is cut off": lambda: cell(1, "1e"),
    "a mark stands for a value": lambda: cell(1, "#N/A"),
    "a value is beyond all numbers": lambda: cell(1, "1e999"),
    "a value is huge": lambda: cell(1, "1e300"),
    "a time is huge": lambda: cell(0, "1e300"),
    "all values are NaN": lambda: theta("nan"),
    "all values are huge": lambda: scaled(1, 300),
    "all times are huge": lambda: scaled(0, 298),
    "a time stands twice": lambda: written(measured()[:50] + measured()[49:]),
    "the time goes back": lambda: written(measured()[:50] + measured()[40:]),
    "the time runs backwards": lambda: written(measured()[::-1]),
    "one row": lambda: written(measured()[:1]),
    "no row": lambda: written([]),
    "an empty file": lambda: b"",
    "a column is missing": lambda: written([row[:1] for row in measured()], "t [s]"),
    "a column has another name": lambda: written(measured(), "t [s],phi [rad]"),
    "no header": lambda: written(measured()[1:], ",".join(measured()[0])),
    "cut off in a line": lambda: written(measured()[:157]) + b"12.5",
    "a row is longer": lambda: cell(1, "0.5,1"),
    "a byte is zero": lambda: cell(1, "\0"),
    "a quote is open": lambda: cell(0, '"0.56'),
    "the header stands twice": lambda: written(measured()[:40]) + written(measured()[40:]),
    "no text at all": lambda: bytes(range(256)) * 20,
}
READ: dict[str, Callable[[], bytes]] = {
    "a byte order mark": lambda: b"\xef\xbb\xbf" + written(measured()),
    "UTF-16": lambda: written(measured()).decode().encode("utf-16"),
    "CRLF": lambda: written(measured(), end="\r\n"),
    "CR": lambda: written(measured(), end="\r"),
    "semicolons": lambda: written(measured(), between=";"),
    "decimal commas": lambda: written(
        [[value.replace(".", ",") for value in row] for row in measured()], between=";"
    ),
    "no end of line": lambda: written(measured())[:-1],
}
ODD: dict[str, Callable[[], bytes]] = {
    "a value is denormal": lambda: cell(1, "4.9e-324"),
    "the signal is constant": lambda: theta("0.5"),
    "the signal is zero": lambda: theta("0"),
    "all values are denormal": lambda: theta("5e-324"),
    "all values are tiny": lambda: scaled(1, -300),
    "all times are tiny": lambda: scaled(0, -15),
    "all times are large": lambda: scaled(0, 12),
    "two rows": lambda: written(measured()[:2]),
    "three rows": lambda: written(measured()[:3]),
    "a gap": lambda: written(measured()[:80] + measured()[180:]),
    "a spike": lambda: cell(1, "1e6"),
    "a value is NaN": lambda: cell(1, "nan"),
    "a cell is empty": lambda: cell(1, ""),
    "cut off behind a comma": lambda: written(measured()[:100]) + b"8.0,",
}


@pytest.fixture(autouse=True)
def no_hang() -> Iterator[None]:
    def late(number: int, frame: FrameType | None) -> None:
        pytest.fail(f"nothing came of it in {SECONDS} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture
def asked(call: Call, tmp_path: Path) -> Callable[..., Result]:
    """A command on the pendulum of the lessons, with these bytes as its measured file."""

    def command(verb: str, content: bytes, *options: str) -> Result:
        shutil.copy(LESSONS / "pendulum.yaml", tmp_path)
        (tmp_path / "pendulum_swing.csv").write_bytes(content)
        result = call(verb, tmp_path / "pendulum.yaml", *options)
        assert "internal error" not in result.out + result.err
        return result

    return command


@pytest.mark.parametrize("verb", ["check", "fit", "trace"])
@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_read_is_refused_with_its_place(
    asked: Callable[..., Result], what: str, verb: str
) -> None:
    result = asked(verb, REFUSED[what]())
    assert result.code == 2
    assert re.search(r"pendulum_swing\.csv|pendulum\.yaml:\d+", result.err)


@pytest.mark.parametrize("what", READ)
def test_other_ways_to_write_the_same_numbers_have_the_same_fit(
    asked: Callable[..., Result], what: str
) -> None:
    plain, other = asked("fit", written(measured())), asked("fit", READ[what]())
    assert plain.code == other.code == 0
    numbers = r"(?m)^ *(?:w0_squared|c) .*$"
    assert re.findall(numbers, plain.out) == re.findall(numbers, other.out) != []


@pytest.mark.parametrize("what", ODD)
def test_a_fit_of_odd_numbers_is_finite_or_refused(asked: Callable[..., Result], what: str) -> None:
    finite_or_refused(asked("fit", ODD[what]()))


@pytest.mark.parametrize("what", ["a value is NaN", "a cell is empty", "cut off behind a comma"])
def test_a_row_without_a_value_is_told(asked: Callable[..., Result], what: str) -> None:
    told = asked("check", ODD[what]())
    assert told.code == 0
    assert "theta has no value in 1 of " in told.out


@pytest.mark.slow
@pytest.mark.parametrize("what", ODD)
def test_a_trace_of_odd_numbers_is_finite_or_refused(
    asked: Callable[..., Result], what: str
) -> None:
    brief = b"".join(ODD[what]().splitlines(keepends=True)[:BRIEF])
    finite_or_refused(asked("trace", brief, "--effects", "1"))


def finite_or_refused(result: Result) -> None:
    if result.code:
        assert re.search(r"\w", result.err)
    else:
        # why an effect does not run is no result
        reasons = r"(?m)^note: .* (?:was|were) not tried: .*$"
        told = re.sub(reasons, "", result.out)
        assert not re.search(r"\b(nan|inf)\b", told)
        assert "VERDICT effect:  are" not in result.out  # an effect has a name
