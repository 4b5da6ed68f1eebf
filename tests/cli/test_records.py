"""A command whose arguments are records has an option for each field."""

from __future__ import annotations

from dataclasses import dataclass
from inspect import signature
from typing import Annotated, Any

import pytest
import typer
from tracewire.cli.app import VERBS
from tracewire.cli.records import Given, MotionPeriod, with_fields
from typer.testing import CliRunner


@dataclass(frozen=True)
class Colour:
    """A record with a field that must be given, and one with a default."""

    name: Annotated[str, typer.Option(help="Its name.")]
    depth: Annotated[float, typer.Option("--deep", help="How deep it is.")] = 0.5


def run(*arguments: str) -> tuple[Any, list[tuple[str, Colour, bool]]]:
    seen: list[tuple[str, Colour, bool]] = []

    def paint(wall: str, *, colour: Colour, twice: bool = False) -> None:
        """Paint a wall."""
        seen.append((wall, colour, twice))

    app = typer.Typer()
    app.command()(with_fields(paint))
    return CliRunner().invoke(app, list(arguments)), seen


def test_the_fields_are_options_and_the_command_gets_the_record() -> None:
    result, seen = run("north", "--name", "red", "--twice")
    assert result.exit_code == 0
    assert seen == [("north", Colour("red", 0.5), True)]
    assert run("north", "--name", "red", "--deep", "2")[1] == [("north", Colour("red", 2.0), False)]


def test_a_field_without_a_default_must_be_given() -> None:
    result, seen = run("north")
    assert result.exit_code == 2
    assert "--name" in result.output
    assert not seen


def test_help_and_name_are_those_of_the_command() -> None:
    result, _ = run("--help")
    assert "Paint a wall." in result.output
    assert "How deep it is." in result.output


def test_a_command_without_records_has_its_arguments() -> None:
    def plain(diagram: str, *, depth: int = 1) -> None:
        """Nothing."""

    assert list(signature(with_fields(plain)).parameters) == ["diagram", "depth"]


def test_records_are_values_that_can_be_made_in_python() -> None:
    assert Given(preset="slow") == Given("slow", None, None, None)
    assert MotionPeriod("2*pi/w", "0.5").times == ("2*pi/w", 0.5)


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb != "analyse"])
def test_no_command_has_many_arguments(verb: str) -> None:
    from importlib import import_module

    made = getattr(import_module(f"tracewire.cli.{verb}"), verb)
    if not isinstance(made, typer.Typer):
        assert len(signature(made).parameters) <= 12
