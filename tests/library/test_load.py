"""Libraries of the user's own: folders, files, clashes, and files that are broken."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import pytest
from tracewire.errors import BlockError
from tracewire.library import load_library

HEAD = "from tracewire.library import Block, Input, Output, Parameter\n"


def block(name: str, formula: str = "2") -> str:
    return f'{name} = Block("{name}", "A block.", outputs=(Output("y", "{formula}"),))\n'


def write(file: Path, *lines: str) -> Path:
    file.write_text(HEAD + "".join(lines), encoding="utf-8")
    return file


def test_a_folder_adds_its_blocks_to_the_shipped_ones(tmp_path: Path) -> None:
    write(tmp_path / "bearings.py", block("journal"), block("ball"))
    write(tmp_path / "chains.py", block("chain"))
    library = load_library([tmp_path])
    assert {"journal", "ball", "chain", "viscous"} <= set(library)
    assert library.families["ball"] == "bearings"
    assert library["ball"].place.file == "bearings.py"
    assert library["ball"].place.line == 3
    assert "journal" not in load_library()


def test_a_single_file_is_a_library_and_may_be_given_as_text(tmp_path: Path) -> None:
    file = write(tmp_path / "chains.py", block("chain"))
    assert "chain" in load_library([str(file)])


def test_two_names_for_one_block_are_one_block(tmp_path: Path) -> None:
    write(tmp_path / "chains.py", block("chain"), "cable = chain\n")
    assert [name for name in load_library([tmp_path]) if name in ("chain", "cable")] == ["chain"]


def test_a_family_called_math_does_not_shadow_the_standard_library(tmp_path: Path) -> None:
    write(tmp_path / "math.py", block("chain"))
    write(tmp_path / "chains.py", "import math\n", block("cable", "{math.floor(2.5)}"))
    text = (tmp_path / "chains.py").read_text("utf-8").replace('"{math', 'f"{math')
    (tmp_path / "chains.py").write_text(text, encoding="utf-8")
    assert load_library([tmp_path])["cable"].outputs[0].formula == "2"
    assert sys.modules["math"] is math
    assert "tracewire.blocks.math" not in sys.modules


@pytest.mark.parametrize("name", ["__init__.py", "_parts.py", "test_chains.py"])
def test_files_that_are_no_block_files_are_not_run(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("raise ValueError", encoding="utf-8")
    write(tmp_path / "chains.py", block("chain"))
    assert "chain" in load_library([tmp_path])


def test_a_file_is_read_again_only_where_it_has_changed(tmp_path: Path) -> None:
    file = write(tmp_path / "chains.py", block("chain"))
    first = load_library([tmp_path])
    assert load_library([tmp_path])["chain"] is first["chain"]
    write(file, block("chain", "3"))
    os.utime(file, ns=(1, 1))  # clocks of file systems are coarse
    assert load_library([tmp_path])["chain"].outputs[0].formula == "3"
    assert load_library()["viscous"] is first["viscous"]


def test_a_name_that_is_taken_is_refused_with_both_places(tmp_path: Path) -> None:
    write(tmp_path / "chains.py", block("viscous"))
    with pytest.raises(BlockError) as caught:
        load_library([tmp_path])
    shipped = load_library()["viscous"].place
    assert str(caught.value) == (
        f"chains.py:2: the block 'viscous' is already declared in {shipped}. Give it another name."
    )


@pytest.mark.parametrize("there", [True, False])
def test_a_folder_without_block_files_is_refused(tmp_path: Path, there: bool) -> None:
    folder = tmp_path if there else tmp_path / "nothing"
    with pytest.raises(BlockError) as caught:
        load_library([folder])
    assert str(caught.value) == (
        f"{folder}: {'there are no block files here' if there else 'this does not exist'}."
        " A library is a .py file of block declarations, or a folder of them."
    )


def test_a_file_that_is_not_python_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "blocks.yaml"
    file.write_text("a: 1", encoding="utf-8")
    with pytest.raises(BlockError, match=r"blocks\.yaml: this is not a Python file\."):
        load_library([file])


@pytest.mark.parametrize(
    ("code", "line", "reason"),
    [
        ("x = = 1\n", 2, "SyntaxError: invalid syntax"),
        ("import no_such_thing\n", 2, "ModuleNotFoundError: No module named 'no_such_thing'"),
        ("\nchain = Block('chain', 'A chain.', input=())\n", 3, "TypeError: "),
        ("def f():\n    return 1/0\nf()\n", 3, "ZeroDivisionError: division by zero"),
    ],
)
def test_a_broken_file_is_told_with_its_line(
    tmp_path: Path, code: str, line: int, reason: str
) -> None:
    file = write(tmp_path / "chains.py", code)
    with pytest.raises(BlockError) as caught:
        load_library([tmp_path])
    message = f"{file}:{line}: the block file cannot be read: {reason}"
    assert str(caught.value).startswith(message)


def test_the_problems_of_all_files_are_told_at_once(tmp_path: Path) -> None:
    write(tmp_path / "a.py", block("chain", "x"))
    write(tmp_path / "b.py", "x = = 1\n")
    write(tmp_path / "c.py", block("gain"))
    with pytest.raises(BlockError) as caught:
        load_library([tmp_path])
    files = [Path(problem.place.file).name for problem in caught.value.problems]
    assert files == ["a.py", "b.py", "c.py"]
