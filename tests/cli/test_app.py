"""The command line as a whole: help, exit codes, and errors in words."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tracewire
from tracewire.cli import main
from tracewire.errors import DataError, FitError, Location, Problem

LESSON = Path(__file__).parents[2] / "diagrams" / "lessons" / "pendulum.yaml"
SOLVER = Path(tracewire.__file__).parents[1]
VERBS = ("check", "show", "draw", "run", "fit", "trace", "report", "sweep", "blocks")


def raising(error: BaseException) -> Callable[..., None]:
    def fail(*_: object, **__: object) -> None:
        raise error

    return fail


def test_help_opens_with_examples_and_names_every_verb(call: Any) -> None:
    told = call("--help")
    assert told.code == 0
    before_options = told.out.partition("Options")[0]
    assert before_options.count("tracewire ") >= 5
    assert all(f" {verb} " in told.out for verb in VERBS)


def test_help_gives_the_whole_first_sentence_of_each_verb(call: Any) -> None:
    told = " ".join(call("--help").out.split())
    assert (
        "Check diagrams, their formulas and their measured files, and say what is in them." in told
    )
    assert "..." not in told.partition("Commands:")[2]


@pytest.mark.parametrize("group", [[], ["analyse"], ["data"], ["new"]])
def test_without_a_verb_it_helps(call: Any, group: list[str]) -> None:
    told = call(*group)
    assert (told.code, told.err) == (0, "")
    assert told.out == call(*group, "--help").out
    assert "\nCommands:\n" in told.out


@pytest.mark.parametrize("verb", VERBS)
def test_each_verb_has_help_and_the_common_options(call: Any, verb: str) -> None:
    told = call(verb, "--help")
    assert told.code == 0
    assert all(option in told.out for option in ("--json", "--library", "--debug", "Example"))


def test_version(call: Any) -> None:
    assert call("--version").out == f"tracewire {tracewire.__version__}\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ["chek"],
            "No such command 'chek'. Did you mean 'check', 'schema'? See 'tracewire --help'.",
        ),
        (
            ["effects"],
            "No such command 'effects'. It is 'blocks' here. See 'tracewire --help'.",
        ),
        (["simulate", "a.yaml"], "No such command 'simulate'. It is 'run' here."),
        (["run"], "Missing argument 'DIAGRAM'. See 'tracewire run --help'."),
        (["run", "a.yaml", "--rtol", "small"], "'--rtol'"),
        (["run", "a.yaml", "--span", "1"], "'--span' requires 2 arguments"),
        (["show", "a.yaml", "--equation"], "--equations"),
        (["show", "a.yaml", "b"], "unexpected argument: b. See 'tracewire show --help'."),
        (["show", "a.yaml", "b", "c"], "unexpected arguments: b c. See"),
    ],
)
def test_a_wrong_command_line_is_told_in_one_line(
    call: Any, arguments: list[str], said: str
) -> None:
    told = call(*arguments)
    assert told.code == 2
    assert told.out == ""
    assert said in told.err
    assert told.err.count("\n") == 1


def test_a_file_behind_json_is_told_where_results_go(call: Any) -> None:
    told = call("trace", "a.yaml", "--json", "out.json").data["error"][0]
    assert told["what"] == "unexpected argument: out.json"
    assert told["hint"].startswith("--json prints to the screen; --save out.json keeps the result.")
    told = call("show", "a.yaml", "--json", "out.json").data["error"][0]
    assert told["hint"].startswith("--json prints to the screen: `--json > out.json` writes that")


def test_a_wrong_command_line_is_json_too(call: Any) -> None:
    told = call("run", "--json")
    assert told.code == 2
    assert [problem["what"] for problem in told.data["error"]] == ["Missing argument 'DIAGRAM'"]


def test_problems_stand_one_a_line_and_in_json(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    problems = [
        Problem("the first is wrong", Location("a.yaml", 3, 5, "omega"), ("x", "y"), "Do this."),
        Problem("the second\nis wrong"),
    ]
    monkeypatch.setattr("tracewire.diagram.read", raising(DataError(problems)))
    told = call("check", swing, "--json")
    assert told.code == 2
    assert told.err.splitlines() == [
        "a.yaml:3:5: block 'omega': the first is wrong; there are: x, y. Do this.",
        "the second is wrong.",
    ]
    assert told.data["error"][0] == {
        "file": "a.yaml",
        "line": 3,
        "column": 5,
        "block": "omega",
        "what": "the first is wrong",
        "exists": ["x", "y"],
        "hint": "Do this.",
    }
    assert len(told.data["error"]) == 2


def test_work_that_failed_exits_with_1(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.diagram.read", raising(FitError([Problem("no fit")])))
    assert call("check", swing).code == 1


def test_an_unexpected_error_asks_for_a_report(
    call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.diagram.read", raising(ZeroDivisionError("by\nzero")))
    told = call("check", swing)
    assert told.code == 1
    assert told.err == (
        "internal error (ZeroDivisionError: by zero). "
        "Please report it; --debug shows the traceback.\n"
    )


def test_debug_shows_the_traceback(
    swing: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("tracewire.diagram.read", raising(ZeroDivisionError("zero")))
    assert main(["check", str(swing), "--debug"]) == 1
    assert "Traceback" in capsys.readouterr().err


def inside_a_class() -> RuntimeError:
    """What Python 3.11 makes of an interrupt while it makes a class."""
    error = RuntimeError("Error calling __set_name__")
    error.__cause__ = KeyboardInterrupt()
    return error


def inside_a_module() -> ImportError:
    """What pybind11 makes of an interrupt while a module of C++ is loaded."""
    error = ImportError("initialization failed")
    error.__cause__ = KeyboardInterrupt()
    return error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), inside_a_class(), inside_a_module()])
def test_an_interrupt_is_told_and_exits_with_130(
    error: BaseException, call: Any, swing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.diagram.read", raising(error))
    told = call("check", swing)
    assert told.code == 130
    assert told.err.splitlines()[-1] == "interrupted; nothing was finished."


def test_the_package_runs_as_a_module(swing: Path) -> None:
    # the module's own process: no terminal, the exit code of main, and nothing on stderr
    done = subprocess.run(
        [sys.executable, "-m", "tracewire", "check", swing.name],
        cwd=swing.parent,
        env={"PYTHONPATH": str(SOLVER), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("no problems\n")


HEAVY = ("numpy", "scipy", "networkx", "matplotlib", "pint", "llvmlite", "numba", "rich")
HEAVY += ("http.server", "tracewire.view", "quickjs")


VIEWED = ["numpy", "http.server", "tracewire.view", "quickjs"]  # before a page asks


@pytest.mark.parametrize(
    ("arguments", "imported"),
    [
        (["--version"], []),
        (["--help"], []),
        (["trace", "--help"], []),
        (["blocks", "gain"], []),
        (["check", "LESSON"], ["numpy"]),
        (["draw", "LESSON", "--output", "PICTURE"], ["numpy", "quickjs"]),
        (["view", "LESSON", "--no-browser", "--for", "0.1"], VIEWED),
        (["run", "LESSON"], ["numpy", "llvmlite", "rich"]),
    ],
)
def test_a_verb_imports_what_it_needs(
    arguments: list[str], imported: list[str], tmp_path: Path
) -> None:
    """Each of the others takes a tenth of a second and more."""
    files = {"LESSON": str(LESSON), "PICTURE": str(tmp_path / "a.svg")}
    given = [files.get(word, word) for word in arguments]
    program = (
        f"import sys; from tracewire.cli import main; main({given!r}); "
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={"PYTHONPATH": str(SOLVER), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == str(imported)
