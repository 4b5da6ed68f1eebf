"""What the page shows as files: a figure, a script that makes the same run, the diagram."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.view import Service
from view.conftest import SPRING, frame_in

LESSONS = Path(__file__).parents[2] / "diagrams" / "lessons"


def key_of(service: Service) -> str:
    read: Any = service.answer("read", {"text": service._text()})
    return str(read["key"])


@pytest.mark.parametrize("series", ["", "swing"])
def test_a_script_makes_the_same_run(tmp_path: Path, series: str) -> None:
    for file in LESSONS.glob("pendulum*"):
        shutil.copy(file, tmp_path)
    service = Service(tmp_path / "pendulum.yaml")
    request = {"key": key_of(service), "parameters": {"c": 0.1}, "series": series}
    exported: Any = service.answer("export", request | {"kind": "script"})
    assert exported["name"] == "pendulum.py"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", exported["text"]],
        cwd=tmp_path, env={"PYTHONPATH": ":".join(sys.path)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = np.genfromtxt(tmp_path / "pendulum_run.csv", delimiter=",", names=True)
    head, arrays = frame_in(service.answer("run", request))
    shown = arrays[head["panels"][0]["lines"][0]["values"]]
    assert np.interp(rows["t"], arrays[head["t"]], shown) == pytest.approx(rows["theta"], abs=1e-2)
    assert (rows["t"][0], rows["t"][-1]) == (arrays[head["t"]][0], arrays[head["t"]][-1])


def test_a_figure_has_what_is_recorded(service: Service) -> None:
    exported: Any = service.answer("export", {"key": key_of(service), "kind": "figure"})
    assert exported["name"] == "spring.svg"
    assert "<svg" in exported["text"] and "A mass on a spring" in exported["text"]


def test_a_diagram_has_the_values_of_the_sliders(service: Service, spring: Path) -> None:
    request = {"key": key_of(service), "kind": "diagram", "parameters": {"k": 5}}
    exported: Any = service.answer("export", request)
    assert exported["text"] == SPRING.replace("value: 4", "value: 5")
    assert spring.read_text(encoding="utf-8") == SPRING


def test_what_cannot_be_exported_is_told(service: Service) -> None:
    answer: Any = service.answer("export", {"key": key_of(service), "kind": "film"})
    assert "unknown export 'film'" in answer["problems"][0]["text"]
    read: Any = service.answer("read", {"text": SPRING + "# more\n"})
    answer = service.answer("export", {"key": read["key"], "kind": "script"})
    assert "Save the text first." in answer["problems"][0]["text"]
