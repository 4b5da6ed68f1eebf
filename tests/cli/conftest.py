"""A small diagram, its measured file, and the command line as a function."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from tracewire.cli import main

SWING = """\
title: Pendulum with a dry bearing
span: [0, 4]
record: [theta, omega]
parameters:
  J: {value: 4.2e-4, unit: kg m^2}
  k: {value: 3.1e-3, unit: N m/rad, fit: [1e-3, 1e-2]}
  slip: {value: 5e-4, unit: N m, fit: free}
  phi: {value: 60, unit: deg}
blocks:
  theta: {type: integrator, of: omega, start: phi, unit: rad}
  omega: {type: integrator, of: alpha, unit: rad/s}
  column: {type: gain, of: theta, k: -k, unit: N m}
  bearing: {type: dry_friction, rate: omega, slip: slip}
  torque: {type: sum, of: [column, bearing]}
  alpha: {type: gain, of: torque, k: 1/J}
presets:
  free: {slip: 0}
measured:
  run_1: {file: run_1.csv, time: t, signals: {theta: {column: angle}}, start: {theta: 0.5}}
"""
MEASURED = "t,angle\n1.0,0.5\n1.5,0.2\n2.0,-0.3\n"


@dataclass(frozen=True)
class Result:
    """What a command printed, and its exit code."""

    code: int
    out: str
    err: str

    @property
    def data(self) -> Any:
        return json.loads(self.out)


Call = Callable[..., Result]


@pytest.fixture
def swing(tmp_path: Path) -> Path:
    (tmp_path / "run_1.csv").write_text(MEASURED, encoding="utf-8")
    file = tmp_path / "swing.yaml"
    file.write_text(SWING, encoding="utf-8")
    return file


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    def command(*arguments: object) -> Result:
        capsys.readouterr()
        code = main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert "Traceback" not in out + err
        return Result(code, out, err)

    return command
