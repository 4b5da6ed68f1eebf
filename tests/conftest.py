"""What all tests have in common."""

from __future__ import annotations

import os
import signal
from collections.abc import Generator, Iterator
from typing import Any

import pytest
from hypothesis import settings

# the workers of pytest share the cores, and some tests call what is inside a fit. numpy reads it
# when it is imported
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a busy machine is no fault of what is tested, and neither is luck: the examples stay the same
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("new", deadline=None, derandomize=False, print_blob=True)
settings.load_profile("same")

ABSENT = "the measured series are not here"
"""Why a test is skipped that needs records which are not part of this project."""


def pytest_addoption(parser: pytest.Parser) -> None:
    text = "a test that is skipped has failed, unless it needs records that are not in the project"
    parser.addoption("--none-skipped", action="store_true", help=text)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, Any]:
    """A report of a test, which has failed where it must not be skipped."""
    return _none_skipped((yield), item.config)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Generator[None, Any, Any]:
    """A report of a file, which is skipped as a whole where an import of it fails."""
    return _none_skipped((yield), collector.config)


def _none_skipped(report: Any, config: pytest.Config) -> Any:
    """Where all that the tests need is installed, as in CI, a skip means that it is not."""
    if report.outcome == "skipped" and config.getoption("none_skipped"):
        _, _, reason = report.longrepr
        if ABSENT not in reason:
            report.outcome, report.longrepr = "failed", f"skipped under --none-skipped: {reason}"
    return report


@pytest.fixture(autouse=True)
def _ctrl_c() -> Iterator[None]:
    """Ctrl-C as a program has it that a user starts, also where the tests run in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
