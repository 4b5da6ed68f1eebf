"""Ten broken files, one for each mistake that people make: each is refused with one clear line."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagram.small_library import made, refused
from tracewire.compile import compile
from tracewire.diagram.files import load_text
from tracewire.errors import DiagramError

FOLDER = Path(__file__).parent / "broken"
MESSAGES = {
    "unknown_block.yaml": (
        "4:17: block 'omega': unknown block type 'integrater'",
        "Did you mean 'integrator'?",
    ),
    "unknown_parameter.yaml": (
        "4:42: block 'column': unknown input or parameter of 'gain' 'gian'; there are: k, of",
    ),
    "unconnected_input.yaml": (
        "4:3: block 'omega': input 'of' is not connected. Write of: signal.",
    ),
    "unknown_signal.yaml": (
        "4:28: block 'column': unknown signal 'thta'; there are: column, theta.",
        "Did you mean 'theta'?",
    ),
    "two_definitions.yaml": (
        "6:3: two definitions of 'k': a block here, and a parameter in line 3.",
    ),
    "loop_through_subsystem.yaml": (
        "3:3: block 'a': algebraic loop without a solution, or with any: a -> b.sum_ -> c -> a.",
        "The gain round the loop is exactly 1: change it, or break it with a state",
    ),
    "contains_itself.yaml": (
        "10:21: block 'box.inner': subsystem 'stage' contains itself: stage -> box -> stage.",
    ),
    "not_yaml.yaml": ("3:39: this is not YAML", "Check indentation, colons, quotes and brackets"),
    "alias_bomb.yaml": ("2:4: the anchor or alias 'a' is not allowed in a diagram.",),
    "empty.yaml": (": the file is empty. A diagram has at least 'blocks:'.",),
}


def told_of(name: str) -> str:
    """The message with which a file is refused: where it is read, or where it is compiled."""
    text = load_text(FOLDER / name)
    told = refused(text, Path(name))
    if not told:
        with pytest.raises(DiagramError) as caught:
            compile(made(text, Path(name)))
        told = str(caught.value)
    return told


def test_there_is_a_message_for_each_file() -> None:
    assert sorted(MESSAGES) == sorted(file.name for file in FOLDER.glob("*.yaml"))


@pytest.mark.parametrize("name", MESSAGES)
def test_a_broken_file_is_refused(name: str) -> None:
    told = told_of(name)
    assert told.startswith(name)
    assert [part for part in MESSAGES[name] if part not in told] == []


@pytest.mark.parametrize("name", sorted(set(MESSAGES) - {"alias_bomb.yaml"}))
def test_one_mistake_is_told_in_one_line(name: str) -> None:
    parts = told_of(name).splitlines()
    assert len(parts) == 1, parts
