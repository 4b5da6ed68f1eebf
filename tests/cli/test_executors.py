"""`--executor`: a sweep on a dask cluster, and the messages where there is none."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from tracewire.cli import main

BALL = """\
span: [0, 3]
parameters: {restitution: 0.8}
blocks:
  x: {type: integrator, of: v, start: 10}
  v: {type: integrator, of: g}
  g: {type: constant, value: -9.81}
record: [x]
events:
  - {when: x, crosses: down, set: {v: -restitution*v}}
"""
CLUSTER = """
import sys
sys.path[:0] = {path!r}
from distributed import Client, LocalCluster
from tracewire.cli import main
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            client.run(sys.path.extend, {path!r})
        at = cluster.scheduler_address.replace("tcp://", "dask://")
        sys.exit(main([*sys.argv[1:], "--executor", at]))
"""


@pytest.fixture
def ball(tmp_path: Path) -> list[str]:
    file = tmp_path / "ball.yaml"
    file.write_text(BALL, encoding="utf-8")
    return ["sweep", str(file), "--over", "restitution=0.5:0.9:12", "--keep", "max(x)", "--json"]


def test_a_sweep_on_a_cluster_is_that_of_threads(
    ball: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(ball) == 0
    here = json.loads(capsys.readouterr().out)
    script = tmp_path / "cluster.py"
    script.write_text(CLUSTER.format(path=sys.path), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(script), *ball], capture_output=True, text=True, check=True
    )
    assert json.loads(done.stdout) == here


def test_what_is_no_address_is_told(ball: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*ball, "--executor", "cluster:80"]) == 2
    assert "'cluster:80' is no executor. Give the address" in capsys.readouterr().err


def test_a_trace_takes_an_address_too(capsys: pytest.CaptureFixture[str]) -> None:
    lesson = Path(__file__).parents[2] / "diagrams" / "lessons" / "pendulum.yaml"
    assert main(["trace", str(lesson), "--executor", "cluster:80"]) == 2
    assert "'cluster:80' is no executor. Give the address" in capsys.readouterr().err


def test_nobody_at_an_address_is_told(
    ball: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tracewire.cli.executors.LIMITS.scheduler", 0.5)
    assert main([*ball, "--executor", "dask://127.0.0.1:1"]) == 2
    assert "no dask scheduler answers at 'dask://127.0.0.1:1'" in capsys.readouterr().err


def test_a_missing_package_is_told(
    ball: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert main([*ball, "--executor", "dask://127.0.0.1:1"]) == 2
    assert "pip install 'tracewire[scale]'" in capsys.readouterr().err
