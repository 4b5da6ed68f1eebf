"""`--executor`: workers that are not threads of this process."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Annotated, cast

import typer

from tracewire.cli.limits import LIMITS
from tracewire.errors import OptionError, Problem
from tracewire.extras import import_extra

SCHEME = "dask://"
ADDRESS = "Give the address of a dask scheduler: dask://HOST:PORT."

ExecutorAddress = Annotated[
    str,
    typer.Option(
        "--executor",
        metavar="ADDRESS",
        help="Let other processes or machines work: dask://HOST:PORT of a dask scheduler.",
        show_default=False,
    ),
]


@contextmanager
def executor_at(address: str) -> Iterator[Executor | None]:
    """The executor at an address; None where none is given. Raises OptionError."""
    if not address:
        yield None
        return
    if not address.startswith(SCHEME):
        raise OptionError([Problem(f"'{address}' is no executor", hint=ADDRESS)])
    distributed = import_extra("distributed", "scale", "for dask", error=OptionError)
    try:
        at = "tcp://" + address.removeprefix(SCHEME)
        client = distributed.Client(at, timeout=LIMITS.scheduler)
    except (OSError, ValueError) as error:
        what = f"no dask scheduler answers at '{address}' ({error})"
        raise OptionError([Problem(what, hint=ADDRESS)]) from error
    with client:
        yield cast(Executor, client.get_executor())
