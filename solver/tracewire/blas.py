"""Linear algebra on one thread: the matrices of fits and traces are small."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Let numpy and scipy use one thread of BLAS inside a `with`, or in a function with this
    decorator.

    Threads of BLAS wait for each other busily, and take the cores from the runs.
    """
    import scipy.linalg  # noqa: F401  # only a library that is loaded can be limited
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1, user_api="blas"):
        yield
