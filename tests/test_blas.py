"""Fits and traces let linear algebra use one thread, and set it back."""

from __future__ import annotations

import pytest
import scipy.linalg  # noqa: F401  # has a BLAS of its own
from residual.models import OSCILLATOR, K, T, made, oscillation, series
from threadpoolctl import threadpool_info, threadpool_limits
from tracewire.fit import Progress, fit


def threads() -> set[int]:
    return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}


def test_a_fit_uses_one_thread_of_blas_and_sets_it_back() -> None:
    measured = series(oscillation(T, 0.9))
    seen = list[set[int]]()

    def note(_: Progress) -> None:
        seen.append(threads())

    with threadpool_limits(2, user_api="blas"):
        found = fit(made(OSCILLATOR, ("x",)), [measured], progress=note)
        assert threads() == {2}
    assert found.values["k"] == pytest.approx(K, rel=1e-3)
    assert seen
    assert set.union(*seen) == {1}
