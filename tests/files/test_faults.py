"""Nothing under a final name is half a file, wherever the disk fails or the process dies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from files.faults import ERRORS, calls, failing, killed
from show.traces import FOUND
from tracewire.analyse.partial import Partial
from tracewire.cli.reporting import store
from tracewire.cli.setting import write_numbers
from tracewire.diagram import read_text
from tracewire.diagram.edit_values import set_values
from tracewire.errors import TracewireError
from tracewire.fit.checkpoint import Store
from tracewire.show.document import Figure, Report, Section
from tracewire.show.style import panels, save, styled
from tracewire.solve.code_store import CodeStore
from tracewire.solve.run import Run, Statistics
from tracewire.trace import save as save_trace

Make = Callable[[Path, float], object]
"""Writes files into a folder; another number gives another content."""

TEXT = "parameters:\n  k: {value: 1, fit: [0, 9]}\nblocks:\n  x: {type: constant, value: k}\n"
N = 400


def make_trace(folder: Path, number: float) -> None:
    save_trace(replace(FOUND, words=(str(number),)), folder / "trace.json")


def make_fit(folder: Path, number: float) -> None:
    criterion = SimpleNamespace(names=[], scales=1.0, evaluations=3)
    search: Any = SimpleNamespace(
        criterion=criterion,
        seed=1,
        best=np.full(N, number),
        best_value=number,
        iterations=2,
        history=[],
        state={},
    )
    Store(folder / "fit.json", "fminsearch")(search, True)


def make_partial(folder: Path, number: float) -> None:
    (folder / "sweep.npz").exists() or Partial(folder / "sweep.npz", {"a": 1}, N, 2).write()
    partial = Partial(folder / "sweep.npz", {"a": 1}, N, 2)
    partial.put(0, np.array([number, number]))
    partial.write()


def make_diagram(folder: Path, number: float) -> None:
    diagram = read_text(TEXT + "#" * 5000 + "\n", folder / "a.yaml")
    store(diagram, lambda: set_values(diagram, {"k": number}), True, None, str(folder / "a.patch"))


def make_report(ending: str) -> Make:
    def make(folder: Path, number: float) -> None:
        drawn = folder.parent / f"drawn {number}"  # a figure that fails is a line of the report
        drawn.exists() or drawn.write_bytes(bytes([int(number)]) * 5000)
        figures = tuple(Figure(f"{n}.png", n, lambda path: path.symlink_to(drawn)) for n in "ab")
        document = Report("A report", (Section("First", (f"{number}",) * 900, figures=figures),))
        document.write(folder / f"report.{ending}")

    return make


def make_run(ending: str) -> Make:
    def make(folder: Path, number: float) -> None:
        t = np.arange(float(N))
        run = Run(
            title="",
            t=t,
            signals={"x": number * t},
            units={},
            events=(),
            parameters={},
            start={},
            final={},
            statistics=Statistics(1, 0, 1, 0, 0.0),
        )
        run.save(folder / f"run.{ending}")

    return make


def make_numbers(ending: str) -> Make:
    def make(folder: Path, number: float) -> None:
        write_numbers(str(folder / f"a.{ending}"), {"x": number * np.arange(float(N))})

    return make


def make_figure(folder: Path, number: float) -> None:
    with styled():
        figure, (panel,) = panels([1.0])
        panel.set_title(f"{number}")
        save(figure, folder / "a.svg")


KINDS: dict[str, Make] = {
    "trace": make_trace,
    "fit": make_fit,
    "partial": make_partial,
    "apply": make_diagram,
    "md": make_report("md"),
    "html": make_report("html"),
    "run.csv": make_run("csv"),
    "run.npz": make_run("npz"),
    "numbers.csv": make_numbers("csv"),
    "numbers.npz": make_numbers("npz"),
    "figure": make_figure,
}


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in sorted(folder.iterdir())}


class Case:
    """A folder with old files, and what its files are once new ones were written."""

    def __init__(self, make: Make, folder: Path) -> None:
        self.make, self.folder = make, folder
        folder.mkdir()
        make(folder, 3.0)
        self.new = {**contents(folder)}
        self.reset(2.0)
        self.old = contents(folder)
        self.count = calls(lambda: make(folder, 3.0))
        self.new = contents(folder)
        assert self.new.keys() == self.old.keys()
        assert self.new != self.old
        assert self.count >= 4
        self.reset(2.0)
        assert contents(folder) == self.old

    def reset(self, number: float) -> None:
        for file in self.folder.iterdir():
            file.unlink()
        self.make(self.folder, number)

    def restore(self) -> None:
        for file in self.folder.iterdir():
            file.unlink()
        for name, content in self.old.items():
            (self.folder / name).write_bytes(content)

    def check(self, leftovers: bool) -> None:
        """Each file is the old one or the new one, and there is no other under a final name."""
        for name, content in contents(self.folder).items():
            if leftovers and name.startswith(".") and name.endswith(".part"):
                continue
            assert content in (self.old[name], self.new[name]), name
        assert contents(self.folder).keys() >= self.old.keys()

    def work(self) -> object:
        return self.make(self.folder, 3.0)


@pytest.fixture(params=KINDS)
def case(request: pytest.FixtureRequest, tmp_path: Path) -> Case:
    return Case(KINDS[request.param], tmp_path / "there")


@pytest.mark.parametrize("kind", ERRORS)
def test_an_older_file_survives_a_disk_that_fails_at_any_call(case: Case, kind: str) -> None:
    told = 0
    for at in range(1, case.count + 1):
        error = failing(case.work, at, ERRORS[kind])
        case.check(leftovers=False)
        assert error is None or isinstance(error, OSError | TracewireError)
        if isinstance(error, TracewireError):
            assert "cannot be written" in str(error)
        if error is None:
            assert contents(case.folder) == case.new  # what it did without was no part of a file
        told += error is not None
        case.restore()
    assert told > 0


def test_an_older_file_survives_a_kill_at_any_call(case: Case) -> None:
    for at in range(1, case.count + 1):
        assert killed(case.work, at)
        case.check(leftovers=True)
        case.restore()


def test_compiled_code_is_whole_or_none_after_any_fault(tmp_path: Path) -> None:
    content = b"code" * 3000

    def write() -> None:
        CodeStore(tmp_path / "core", lambda text: None).write("f", content)

    count = calls(write)
    assert count >= 4
    for at in range(1, count + 1):
        for act in ERRORS.values():
            assert failing(write, at, act) is None  # a run goes on without
            assert CodeStore(tmp_path / "core").read("f") in (None, content)
        assert killed(write, at)
        assert CodeStore(tmp_path / "core").read("f") in (None, content)
    write()
    assert CodeStore(tmp_path / "core").read("f") == content
