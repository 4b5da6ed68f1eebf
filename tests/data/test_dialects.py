"""Text files as laboratories write them: decimal commas, preambles, units, odd characters."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tracewire.data import column_unit, read_columns
from tracewire.errors import DataError

patient = settings(deadline=None)  # the first run may load scipy
Write = Callable[[str | bytes], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write_file(content: str | bytes) -> Path:
        path = tmp_path / "lab.csv"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write_file


def told(path: Path, **options: Any) -> str:
    with pytest.raises(DataError) as caught:
        read_columns(path, {"x": "x"}, "t", **options)
    return str(caught.value).replace(str(path), "lab.csv")


@pytest.mark.parametrize(
    "content",
    [
        "t;x\n0;1,5\n0,5;-2e3\n",
        "t\tx\n0\t1,5\n0,5\t-2e3\n",
        "t x\n0 1,5\n,5 -2000,\n",
        't,x\n"0","1,5"\n"0,5","-2e3"\n',
        "ball;t;x\nGolf Ball;0;1,5\nGolf Ball;0,5;-2e3\n",
    ],
)
def test_decimal_commas_are_read_and_told(content: str, write: Write) -> None:
    found = read_columns(write(content), {"x": "x"}, "t")
    assert (found.time.tolist(), found.values["x"].tolist()) == ([0, 0.5], [1.5, -2000])
    assert found.remarks == ("the numbers are read with a decimal comma",)


def test_semicolons_without_any_comma_need_no_remark(write: Write) -> None:
    assert read_columns(write("t;x\n0;1.5\n1;2\n"), {"x": "x"}, "t").remarks == ()


def test_a_comma_that_may_stand_between_thousands_is_asked_about(write: Write) -> None:
    path = write("t;x\n0;1,250\n1;2,500\n")
    assert told(path) == (
        "lab.csv:2: '1,250' and others like it may have a decimal comma, or one for thousands. "
        "Say format: {decimal: ','}, or write the numbers as in 1234.5."
    )
    assert read_columns(path, {"x": "x"}, "t", decimal=",").values["x"].tolist() == [1.25, 2.5]
    clear = write("t;x\n0,5;1,250\n1;2,500\n")  # 0,5 tells that it is decimal
    assert read_columns(clear, {"x": "x"}, "t").values["x"].tolist() == [1.25, 2.5]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("t;x\n0;1,5\n1;2,5\n2;3.5\n", "lab.csv:4: column 'x' is '3.5', which is not a number. "
         "Other numbers of this file have a decimal comma: write all alike."),
        ("t;x\n0;1\n1;1.234,5\n2;3,5\n", "'1.234,5', which is not a number. Write large numbers"),
        ('t,x\n0,1\n1,"1,234.5"\n', "'1,234.5', which is not a number. Write large numbers wit"),
        ("t,x\n0,1\n1,1'234.5\n", "which is not a number. Write large numbers without marks"),
        ("t,x\n0,1\n1,OVLD\n", "'OVLD', which is not a number. It marks a value that the ins"),
        ("t,x\n0,1\n1,---\n", "'---', which is not a number. It marks a value that"),
        ("t,x\n0,1\n1,#DIV/0!\n", "'#DIV/0!', which is not a number. It marks a value"),
        ("t,x\n0,1\n1,N/A\n", "'N/A', which is not a number. It marks a value"),
        ("t,x\n0,1\n1,\n", "'', which is not a number. Leave out the rows without a value."),
        ("t,x\n0,1\n1,\u22122\n", "Its minus is another character than '-': replace it in the"),
        ("t,x\n0,1\n1,2.5 V\n", "'2.5 V', which is not a number. A cell holds a number alone"),
        ("t,x\n12:00:01.5,1\n12:00:02.0,2\n", "column 't' is '12:00:01.5', which is not a number. "
         "A column of time has seconds, or dates as ISO 8601 writes them: 2024-03-12T12:00:01.5+"),
        ("t,x\n12.03.2024 12:00:01,1\n", "A column of time has seconds, or dates as ISO 8601"),
        ("t,x\n12.03.2024,1\n", "A column of time has seconds, or dates as ISO 8601 writes"),
        ("t,x\n0,1\n1,2\nt,x\n2,3\n", "lab.csv:4: the header stands here once more. "
         "Where a second record begins, split the file; else remove this line."),
        ("t,x\n0,1\n1,2\nend of file\n", "lab.csv:4: 1 cell, and 2 in the first row. Repair or"),
        ("t,x\n0,1\nfoo,bar\n1,2\n", "lab.csv:3: column 't' is 'foo', which is not a number."),
    ],
)  # fmt: skip
def test_messages_on_cells(content: str, said: str, write: Write) -> None:
    assert said in told(write(content))


@pytest.mark.parametrize(
    "content",
    [
        "Messung 3\nDatum: 12.03.2024\n\nt;x\n0;1\n1;2\n",
        "Logger X, serial 7, rate 100 Hz\nt,x\n0,1\n1,2\n",
        "a comment line\nt x\n 0.00  1.00 \n 1.00  2.00 \n",  # as Scilab's fprintfMat writes it
        "t of the run\nx is in mm\n\nt,x\n0,1\n1,2\n",
        "serial\n1234\n\nt,x\n0,1\n1,2\n",
        "sep=;\nt;x\n0;1\n1;2\n",
        "% Octave\n% t x\n0 1\n1 2\n# end\n",
    ],
)
def test_lines_before_the_table_are_left_out_and_told(content: str, write: Write) -> None:
    found = read_columns(write(content), {"x": "x"}, "t")
    assert (found.time.tolist(), found.values["x"].tolist()) == ([0, 1], [1, 2])
    assert found.remarks[0].endswith("before the table left out, as no part of it")


def test_a_first_row_of_another_width_is_not_left_out(write: Write) -> None:
    path = write("0,1,2\n0,1\n1,2\n")
    with pytest.raises(DataError, match="3 cells, and 2 in the first row"):
        read_columns(path, {"x": "2"}, "1")


def test_text_before_numbers_without_names_leaves_numbers_to_name_them(write: Write) -> None:
    found = read_columns(write("made by Scilab 6.1\n0 1 5\n1 2 6\n"), {"x": "3"}, "1")
    assert found.values["x"].tolist() == [5, 6]


@pytest.mark.parametrize(
    "content",
    [
        "t [ms],x [deg]\n0,1\n1,2\n",
        "t (ms);x (deg)\n0;1\n1;2\n",
        "t,x\n[ms],[deg]\n0,1\n1,2\n",
        "t;x\nms;deg\n0;1\n1;2\n",
        "t [ms] x [deg]\n0 1\n1 2\n",
        "# t [ms] x [deg]\n0 1\n1 2\n",
        "t;x;\nms;deg;\n0;1;\n1;2;\n",
        "t;x\nms;deg\n0;1;\n1;2;\n",
    ],
)
def test_units_of_the_header_are_found(content: str, write: Write) -> None:
    path = write(content)
    found = read_columns(path, {"x": "x"}, "t")
    assert (found.time_unit, found.units) == ("ms", {"x": "deg"})
    assert found.values["x"].tolist() == [1, 2]
    assert column_unit(path, "x") == "deg"


def test_a_unit_of_what_cannot_be_read_is_none(tmp_path: Path) -> None:
    assert column_unit(tmp_path / "none.csv", "x") == ""


def test_laboratory_encodings_are_read_with_a_remark(write: Write) -> None:
    found = read_columns(write("t;x [°]\r\n0;1\r\n1;2\r\n".encode("cp1252")), {"x": "x"}, "t")
    assert found.units == {"x": "°"}
    assert found.remarks == (
        "the file is not in UTF-8; it is read as Windows-1252, where the byte 0xb0 in line 1 "
        "is '°'",
    )
    found = read_columns(write("t\tx [µN]\r\n0\t1\r\n1\t2\r\n".encode("utf-16")), {"x": "x"}, "t")
    assert found.units == {"x": "µN"}
    assert found.remarks == ("the file is in UTF-16, and not in UTF-8",)


def test_delimiters_behind_the_last_cell_are_no_cells(write: Write) -> None:
    for content in ("t,x\n0,1,\n1,2,\n", "t,x,,\n0,1\n1,2\n", "t,x\n0,1,,\n1,2\n"):
        assert read_columns(write(content), {"x": "x"}, "t").values["x"].tolist() == [1, 2]
    assert "3 cells, and 2 in the first row" in told(write("t,x\n0,1,7\n1,2\n"))


def test_rows_are_chosen_by_text_and_number(write: Write) -> None:
    rows = "ball,drop,t,x\nGolf,1,0,1\nGolf,1,1,2\nGolf,2,0,5\nGolf,2.0,1,6\nIron,1,0,bad\n"
    found = read_columns(write(rows), {"x": "x"}, "t", where={"ball": "Golf", "drop": 2})
    assert (found.values["x"].tolist(), found.lines.tolist()) == ([5, 6], [4, 5])
    assert told(write(rows), where={"ball": "Gold"}) == (
        "lab.csv: no row of 'lab.csv' has 'Gold' in the column 'ball'; there are: Golf, Iron. "
        "Correct `where`."
    )
    assert told(write(rows), where={"ball": "Golf", "drop": 3}) == (
        "lab.csv: no row of 'lab.csv' has '3' in the column 'drop' where 'ball' is 'Golf'; there "
        "are: 1, 2, 2.0. Correct `where`."
    )
    assert "unknown column 'bal' in" in told(write(rows), where={"bal": "Golf"})


def test_a_file_without_time_has_an_interval(write: Write) -> None:
    found = read_columns(write("x\n5\n6\n7\n"), {"x": "x"}, every=0.1)
    assert found.time == pytest.approx([0, 0.1, 0.2])
    assert "the interval of rows must be above zero, not 0" in told(write("x\n1\n2\n"), every=0)
    assert "the decimal sign ';' cannot be used. It is '.' or ','." in told(
        write("t,x\n0,1\n"), decimal=";"
    )


finite = st.floats(-1e9, 1e9)


@patient
@given(
    rows=st.lists(st.tuples(finite, finite), min_size=2, max_size=12),
    dialect=st.sampled_from(
        [(",", "."), (";", "."), (";", ","), ("\t", ","), (" ", ","), (" ", ".")]
    ),
    preamble=st.sampled_from(["", "Logger\n", "Run 3 of 7\nby me\n\n"]),
    units=st.booleans(),
    tail=st.booleans(),
    breaks=st.sampled_from(["\n", "\r\n", "\r"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "cp1252", "utf-16"]),
)
def test_a_table_in_any_dialect_reads_back_the_same(
    rows: list[tuple[float, float]],
    dialect: tuple[str, str],
    preamble: str,
    units: bool,
    tail: bool,
    breaks: str,
    encoding: str,
    tmp_path_factory: Any,
) -> None:
    delimiter, decimal = dialect
    names = ["t [µs]", "a [°]", "b"] if units else ["t", "a", "b"]
    end = delimiter if tail and delimiter != " " else ""
    lines = [delimiter.join(names) + end]
    for i, row in enumerate(rows):
        cells = [f"{number:.17g}".replace(".", decimal) for number in (i / 8, *row)]
        lines.append(delimiter.join(cells) + end)
    text = (preamble + "\n".join(lines)).replace("\n", breaks)
    path = tmp_path_factory.getbasetemp() / "dialect.csv"
    path.write_bytes(text.encode(encoding))
    found = read_columns(path, {"a": "a", "b": "b"}, "t")
    assert found.time == pytest.approx(np.arange(len(rows)) / 8, abs=0)
    assert np.array_equal(np.column_stack([found.values["a"], found.values["b"]]), np.array(rows))
    assert found.units["a"] == ("°" if units else "")
