from __future__ import annotations

import contextlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from tracewire.data import Columns, read_columns, read_record
from tracewire.errors import DataError, Location

patient = settings(deadline=None)  # the first run may load scipy
Write = Callable[[str | bytes], Path]
TWO = "t,x\n0,1\n1,2\n"


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write_file(content: str | bytes) -> Path:
        path = tmp_path / "run.csv"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write_file


def problems(path: Path, columns: dict[str, str], **options: Any) -> list[tuple[int, str]]:
    """The line and the text without its place of each problem."""
    with pytest.raises(DataError) as caught:
        read_columns(path, columns, **options)
    assert {problem.place.file for problem in caught.value.problems} == {str(path)}
    return [
        (problem.place.line, str(problem).removeprefix(f"{problem.place}: "))
        for problem in caught.value.problems
    ]


def as_lists(columns: Columns) -> tuple[list[float], dict[str, list[float]], list[int]]:
    values = {name: series.tolist() for name, series in columns.values.items()}
    return columns.time.tolist(), values, columns.lines.tolist()


@pytest.mark.parametrize(
    "content",
    [
        "t,x\n0,1.5\n1,-2e3\n",
        "t;x\n0;1.5\n1;-2e3\n",
        "t\tx\n0\t1.5\n1\t-2e3\n",
        "t   x\n0 1.5\n 1\t-2e3\n",
        " t , x \n 0 , 1.5 \n 1 , -2e3 ",
        '"t","x"\n0,"1.5"\n1,-2e3\n',
        '"t" "x"\n0 "1.5"\n1 -2e3\n',
        "t,x\r\n0,1.5\r\n1,-2e3\r\n",
        "t,x\r0,1.5\r1,-2e3\r",
        "\ufefft,x\n0,1.5\n1,-2e3\n",
        "t [s],x (rad)\n0,1.5\n1,-2e3\n",
        "t,note,x\n0,fine,1.5\n1,,-2e3\n",
        "x,t\n1.5,0\n-2e3,1\n",
        "t,x,\n0,1.5,\n1,-2e3,\n",
        "t,1,x\n0,7,1.5\n1,8,-2e3\n",
    ],
)
def test_forms_of_a_table(content: str, write: Write) -> None:
    found = read_columns(write(content), {"angle": "x"}, "t")
    assert as_lists(found) == ([0, 1], {"angle": [1.5, -2000]}, [2, 3])


def test_lines_are_those_of_the_file(write: Write) -> None:
    path = write("# a\n\nt,x\n  # b\n0,1\n\n# c\n1,2\n")
    found = read_columns(path, {"x": "x"}, "t")
    assert found.lines.tolist() == [5, 8]
    assert found.file == str(path)


def test_columns_by_number_with_and_without_header(write: Write) -> None:
    for content in (TWO, "0,1\n1,2\n"):
        found = read_columns(write(content), {"x": "2", "again": "2", "clock": "1"}, "1")
        assert found.time.tolist() == found.values["clock"].tolist() == [0, 1]
        assert found.values["x"].tolist() == found.values["again"].tolist() == [1, 2]


def test_time_is_the_first_column_where_it_is_not_named(write: Write) -> None:
    assert read_columns(write(TWO), {"x": "x"}).time.tolist() == [0, 1]


def test_a_name_goes_before_a_number_and_a_whole_name_before_one_without_unit(
    write: Write,
) -> None:
    path = write("t,x [m],x,2\n0,1,2,3\n1,1,2,3\n")
    found = read_columns(path, {"a": "x", "b": "x [m]", "c": "2"}, "t")
    assert [found.values[name][0] for name in "abc"] == [2, 1, 3]


def test_header_in_the_comment_above_the_first_row(write: Write) -> None:
    path = write("# measured on Monday\n# t x\n0 1\n1 2\n")
    assert read_columns(path, {"x": "x"}, "t").values["x"].tolist() == [1, 2]


def test_delimiter_and_comment_that_are_given(write: Write) -> None:
    path = write("% t|x\n0|1\n1|2\n")
    assert read_columns(path, {"x": "x"}, "t", "|", "%").values["x"].tolist() == [1, 2]
    path = write("#t,#x\n0,1\n1,2\n")
    assert read_columns(path, {"x": "#x"}, "#t", comment="").values["x"].tolist() == [1, 2]


def test_series_cannot_be_written_to(write: Write) -> None:
    found = read_columns(write(TWO), {"x": "x"}, "t")
    for series in (found.time, found.values["x"], found.lines):
        with pytest.raises(ValueError, match="read-only"):
            series[0] = 7


def test_no_such_file(write: Write) -> None:
    path = write(TWO).with_name("run2.csv")
    said = (
        f"unknown file 'run2.csv' in '{path.parent}'; there are: run.csv. Did you mean 'run.csv'?"
    )
    assert problems(path, {"x": "x"}) == [(0, said)]


def test_no_such_folder(tmp_path: Path) -> None:
    path = tmp_path / "data" / "run.csv"
    said = f"there is no file '{path}', and no folder '{path.parent}'. Check the path."
    assert problems(path, {}) == [(0, said)]


def test_a_file_where_a_folder_should_be(write: Write) -> None:
    path = write(TWO) / "run.csv"
    said = f"there is no file '{path}', and no folder '{path.parent}'. Check the path."
    assert problems(path, {}) == [(0, said)]


def test_a_folder(write: Write) -> None:
    folder = write(TWO).parent
    said = "the file is a folder; there are: run.csv. Name a file in it."
    assert problems(folder, {}) == [(0, said)]


@pytest.mark.skipif(os.name != "posix", reason="needs a device file")
def test_what_is_no_regular_file() -> None:
    said = "the file is not a regular file. Copy its content into a file."
    assert problems(Path("/dev/null"), {}) == [(0, said)]


def test_a_path_that_no_file_can_have() -> None:
    with pytest.raises(DataError, match=r"cannot be read: .*Check its name and permissions\."):
        read_columns("a\0b", {})
    with pytest.raises(DataError, match=r"cannot be read: .*too long.*Check its name"):
        read_columns("a" * 5000, {})


def test_too_large(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tracewire.data.content.FILE.most_bytes", 10)
    said = "the file is too large: 0 MB, and the limit is 0 MB. Split it, or keep every n-th row."
    assert problems(write(TWO), {"x": "x"}) == [(0, said)]


@pytest.mark.parametrize("content", ["", " \n\r\n", "\ufeff"])
def test_empty(content: str, write: Write) -> None:
    assert problems(write(content), {}) == [(0, "the file is empty. Its rows must hold numbers.")]


def test_nothing_but_comments(write: Write) -> None:
    path = write("# t,x\n")
    said = f"'{path}' holds nothing but comments. A series needs at least two rows of numbers."
    assert problems(path, {"x": "x"}, time="t") == [(0, said)]


def test_what_is_no_text(write: Write) -> None:
    said = "the file is not text: it holds a zero byte. Save it as text, in UTF-8."
    assert problems(write(b"t,x\n0,\0\n"), {}) == [(2, said)]
    said = "the byte 0x81 is not UTF-8 text. Save it as text, in UTF-8."
    assert problems(write(b"t,x\n0,\x81\n"), {}) == [(2, said)]


def test_problems_of_the_whole_file_stand_where_the_diagram_names_it(tmp_path: Path) -> None:
    place = Location("pendulum.yaml", 61, 12)
    with pytest.raises(DataError, match=r"^pendulum\.yaml:61:12: unknown file 'run\.csv'"):
        read_columns(tmp_path / "run.csv", {}, place=place)
    with pytest.raises(DataError, match=r"^pendulum\.yaml:61:12: '.*' is a folder"):
        read_columns(tmp_path, {}, place=place)


def test_a_delimiter_that_cannot_be_used(write: Write) -> None:
    said = "the delimiter {} cannot be used. Give one character, such as ',' or ';' or a tab"
    for delimiter in ("", ",,", "1", '"', "\n"):
        [(line, text)] = problems(write(TWO), {"x": "x"}, delimiter=delimiter)
        assert line == 0
        assert text.startswith(said.format(repr(delimiter)))


def test_no_such_column(write: Write) -> None:
    path = write("time,theta [rad]\n0,1\n1,2\n")
    there = f"in '{path}'; there are: theta [rad], time"
    assert problems(path, {"a": "thetta [rad]", "b": "3"}, time="tme") == [
        (0, f"unknown column 'thetta [rad]' {there}. Did you mean 'theta [rad]'?"),
        (0, f"there is no column 3 in '{path}', only 2."),
        (0, f"unknown column 'tme' {there}. Did you mean 'time'?"),
    ]


def test_a_name_where_there_is_no_header(write: Write) -> None:
    path = write("0,1\n1,2\n")
    said = f"'{path}' has no header, so there is no column 'x'. Give a number from 1 to 2."
    assert problems(path, {"x": "x"}) == [(0, said)]


@pytest.mark.parametrize("header", ["t,x,x", "t,x [m],x (cm)"])
def test_a_name_of_two_columns(header: str, write: Write) -> None:
    path = write(f"{header}\n0,1,2\n1,2,3\n")
    there = "there are: column 2, column 3. Give the number."
    said = f"'x' is the name of 2 columns of '{path}'; {there}"
    assert problems(path, {"x": "x"}, time="t") == [(0, said)]


def test_rows_of_another_width(write: Write) -> None:
    assert problems(write("t,x\n0,1\n1\n2,3,4\n3,4\n"), {"x": "x"}) == [
        (3, "1 cell, and 2 in the first row. Repair or remove this line."),
        (4, "3 cells, and 2 in the first row. Repair or remove this line."),
    ]


def test_decimal_commas(write: Write) -> None:
    hint = "Is it a decimal comma? Write 1.5, and not 1,5."
    assert problems(write("t,x\n0,0,1,5\n"), {"x": "x"}) == [
        (2, f"4 cells, and 2 in the first row. {hint}")
    ]
    assert problems(write("t;x\n0;1,5\n"), {"x": "x"}, decimal=".") == [
        (2, f"column 'x' is '1,5', which is not a number. {hint}")
    ]


def test_cells_that_are_no_numbers(write: Write) -> None:
    path = write("t,x\n0,abc\n1,1_000\n2,1.5D-3\n3,\n" + f"4,{'y' * 99}\n")
    assert problems(path, {"x": "x"}) == [
        (2, "column 'x' is 'abc', which is not a number."),
        (3, "column 'x' is '1_000', which is not a number."),
        (4, "column 'x' is '1.5D-3', which is not a number. Write exponents with e, as in 1e-3."),
        (5, "column 'x' is '', which is not a number. Leave out the rows without a value."),
        (6, f"column 'x' is '{'y' * 37}...', which is not a number."),
    ]


@pytest.mark.parametrize("cell", ["", "abc"])
def test_a_faulty_first_row_is_not_taken_for_a_header(cell: str, write: Write) -> None:
    [(line, text)] = problems(write(f"0,{cell}\n1,2\n2,3\n"), {"x": "2"})
    assert line == 1
    assert text.startswith(f"column 2 is '{cell}', which is not a number.")


def test_numbers_that_are_not_finite(write: Write) -> None:
    path = write("t,x,y,z\n0,nan,1,nan\n1,2,1,1\n2,-inf,1,1\n3,1,INF,1\n")
    hint = "Leave out the rows without a value."
    assert problems(path, {"x": "x", "y": "y"}) == [
        (2, f"column 'x' is not finite in 2 rows, first here. {hint}"),
        (5, f"column 'y' is not finite in this row. {hint}"),
    ]


def test_time_that_does_not_increase(write: Write) -> None:
    path = write("t,x\n0,1\n0.1,1\n0.1,1\n0.05,1\n1,1\nnan,1\n0.5,1\n")
    sort = "Sort the rows, in a series by clean: [sort]; or split the file, or choose rows by"
    once = "Keep one row for each time, in a series by clean: [{sort: {duplicates: first}}]."
    assert problems(path, {"x": "x"}, time="t") == [
        (4, f"time 0.1 stands twice, also in line 3. {once}"),
        (5, "time goes back to 0.05, from 0.1 in line 4; the same in 1 more rows: line 8. "
            f"{sort} `where`."),
        (7, "column 't' is not finite in this row. Leave out the rows without a value."),
    ]  # fmt: skip


def test_hundreds_of_rows_out_of_order_are_two_problems(write: Write) -> None:
    rows = [f"{t % 7},{t}" for t in range(700)] + ["6,0"] * 300
    told = problems(write("t,x\n" + "\n".join(rows)), {"x": "x"}, time="t")
    assert [line for line, _ in told] == [9, 702]
    assert "the same in 98 more rows: line 16, 23, 30 and so on" in told[0][1]
    assert "the same in 299 more rows: line 703, 704, 705 and so on" in told[1][1]


@pytest.mark.parametrize(
    ("cells", "times", "since"),
    [
        ("2024-03-12T12:00:00 2024-03-12T12:00:01.5", [0, 1.5], "2024-03-12T12:00:00"),
        ("2024-02-28T23:59:59,25 2024-03-01", [0, 86400.75], "2024-02-28T23:59:59.250000"),
        ("2024-03-12T13:00:00+01:00 2024-03-12T12:00:00.000000123Z", [0, 123e-9],
         "2024-03-12T12:00:00Z"),
        ("2024-03-12T12:00-0330 2024-03-12T15:31Z", [0, 60], "2024-03-12T15:30:00Z"),
    ],
)  # fmt: skip
def test_dates_are_seconds_from_the_earliest(
    cells: str, times: list[float], since: str, write: Write
) -> None:
    path = write("when;x\n" + "\n".join(f"{cell};1" for cell in cells.split()))
    found = read_columns(path, {"x": "x"}, "when")
    assert found.time.tolist() == pytest.approx(times, abs=1e-12)
    assert found.since == since


def test_dates_that_cannot_be_times(write: Write) -> None:
    mixed = write("t,x\n2024-03-12T12:00:00,1\n1.5,2\n")
    assert problems(mixed, {"x": "x"}) == [
        (2, "column 't' has dates in some rows, and numbers in others. Write all times alike."),
    ]
    zones = write("t,x\n2024-03-12T12:00:00Z,1\n2024-03-12T12:00:01,2\n")
    assert problems(zones, {"x": "x"}) == [
        (2, "column 't' has dates with a zone, and others without. Write all times alike."),
    ]
    wrong = write("t,x\n2024-02-28,1\n2024-02-30,2\n")
    assert "'2024-02-30', which is not a number. A column of time has" in problems(
        wrong, {"x": "x"}
    )[0][1]  # fmt: skip
    back = write("t,x\n2024-03-12T12:00:02,1\n2024-03-12T12:00:01,2\n")
    assert "time goes back to 0, from 1 in line 2" in problems(back, {"x": "x"})[0][1]


def test_a_date_is_a_number_of_no_signal(write: Write) -> None:
    path = write("t,x\n0,2024-03-12\n1,2024-03-13\n")
    assert "column 'x' is '2024-03-12', which is not a number" in problems(path, {"x": "x"})[0][1]


def test_a_date_has_no_unit(write: Write) -> None:
    path = write("when,x\n2024-03-12T12:00:00Z,1\n2024-03-12T12:00:01Z,2\n")
    record = read_record(path, {"x": "x"}, "when")
    assert record.steps == ("time: t = 0 is 2024-03-12T12:00:00Z, the earliest of the file",)
    with pytest.raises(DataError, match="are dates, and the time is said to be in ms"):
        read_record(path, {"x": "x"}, "when", time_unit="ms")


def test_too_few_rows(write: Write) -> None:
    hint = "A series needs at least two rows of numbers."
    said = f"the file has only one row of numbers. {hint}"
    assert problems(write("t,x\n0,1\n"), {"x": "x"}) == [(0, said)]
    assert problems(write("t,x\n"), {"x": "x"}) == [(0, f"the file has no row of numbers. {hint}")]


def test_quotes_that_do_not_end(write: Write) -> None:
    said = "a quoted cell does not end where it should. Repair or remove this line."
    assert problems(write('t,x\n0,"1\n1,2\n2,"3"4\n'), {"x": "x"}) == [(2, said), (4, said)]
    assert problems(write('"t,x\n0,1\n1,2\n'), {"x": "x"}) == [(1, said)]


def test_ten_problems_are_told_and_the_others_counted(write: Write) -> None:
    rows = [f"{i},{'bad' if i % 2 else 1}" for i in range(50)]
    rows[4] = "2,1"
    told = problems(write("\n".join(["t,x", *rows])), {"x": "x"})
    assert [line for line, _ in told] == [3, 5, 6, 7, 9, 11, 13, 15, 17, 19, 0]
    assert told[-1] == (0, "and 16 more such problems.")


finite = st.floats(allow_nan=False, allow_infinity=False)


@patient
@given(
    times=st.lists(finite, min_size=2, max_size=20, unique=True).map(sorted),
    data=st.data(),
    delimiter=st.sampled_from([",", ";", "\t", " "]),
)
def test_what_savetxt_wrote_is_read_exactly(
    times: list[float], data: st.DataObject, delimiter: str, tmp_path_factory: Any
) -> None:
    values = data.draw(arrays.arrays(np.float64, (len(times), 2), elements=finite))
    path = tmp_path_factory.getbasetemp() / "savetxt.csv"
    both = np.column_stack([times, values])
    header = delimiter.join(["t", "a", "b"])
    np.savetxt(path, both, fmt="%.17g", delimiter=delimiter, header=header)
    found = read_columns(path, {"a": "a", "b": "3"}, "t")
    assert np.array_equal(np.column_stack([found.time, *found.values.values()]), both)


texts = st.one_of(
    st.text(max_size=60),
    st.text(alphabet='01.,;-e "\t\n\r#t', max_size=60),
    st.binary(max_size=60),
)


@patient
@given(
    content=texts,
    want=st.sampled_from(["t", "1", "2", ""]),
    time=st.sampled_from([None, "t", "1"]),
    delimiter=st.one_of(st.none(), st.text(max_size=1)),
    comment=st.sampled_from(["#", "", "//"]),
)
@example(content=b"*", want="t", time=None, delimiter=None, comment="#")
def test_any_content_is_read_or_refused_with_a_message(
    content: str | bytes,
    want: str,
    time: str | None,
    delimiter: str | None,
    comment: str,
    tmp_path_factory: Any,
) -> None:
    path = tmp_path_factory.getbasetemp() / "random.csv"
    path.write_bytes(
        content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass")
    )
    with contextlib.suppress(DataError):
        found = read_columns(path, {"x": want}, time, delimiter, comment)
        assert len(found.time) == len(found.values["x"]) == len(found.lines) >= 2
        assert (np.diff(found.time) > 0).all()
