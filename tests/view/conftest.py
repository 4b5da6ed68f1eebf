"""A small diagram in a file, a service for it, and its server in a thread."""

from __future__ import annotations

import struct
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.view import Service, open_server
from tracewire.view.server import PageServer

from benchmarks.view.chromium import Chromium

SPRING = """\
title: A mass on a spring
span: [0, 10]
record: [x, v]
parameters:
  k: {value: 4, unit: 1/s^2, fit: [1, 9]}
  start: {value: 100, unit: mm}
  twice: 2*k
  force: 0
  c: {value: 0.01, fit: [1e-4, 1]}
blocks:
  x: {type: integrator, of: v, start: start, unit: m}
  v: {type: integrator, of: a, unit: m/s}
  a: {type: expression, formula: "-k*x - c*v + 0*twice + force", unit: m/s^2}
presets:
  stiff: {k: 8}
scene:
  - box: {at: [x, 0], width: 0.1, height: 0.1}
"""


@pytest.fixture
def spring(tmp_path: Path) -> Path:
    """The file of the diagram above."""
    file = tmp_path / "spring.yaml"
    file.write_text(SPRING, encoding="utf-8")
    return file


@pytest.fixture
def service(spring: Path) -> Service:
    """What answers for that file."""
    return Service(spring)


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    """A browser without a window, one for all tests of a file."""
    with Chromium() as running:
        yield running


@contextmanager
def serving(service: Service) -> Iterator[PageServer]:
    """The server of a service while the block lasts."""
    server = open_server(service)
    thread = threading.Thread(target=server.serve_forever, args=(0.02,))
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def frame_in(answer: Any) -> tuple[dict[str, Any], list[Any]]:
    """The head and the arrays of a run."""
    import json

    assert isinstance(answer, bytes)
    (length,) = struct.unpack("<I", answer[:4])
    head = json.loads(answer[4 : 4 + length])
    assert (4 + length) % 8 == 0
    arrays, at = [], 4 + length
    for count, size in head["arrays"]:
        arrays.append(np.frombuffer(answer, dtype=f"<f{size}", count=count, offset=at))
        at += -(-count * size // 8) * 8
    assert at == len(answer)
    return head, arrays


@pytest.fixture
def key_of(service: Service) -> Callable[[str], str]:
    """What reads a text and gives its key."""

    def read(text: str) -> str:
        answer = service.answer("read", {"text": text})
        assert isinstance(answer, dict)
        return str(answer["key"])

    return read
