"""Independent work side by side: in threads of this process, or wherever an executor runs it.

A job is a function of a number and a `StopFlag`. Threads call it as it is: the core and numpy let
go of Python's lock. An executor of `concurrent.futures` (of processes, dask, MPI) gets the job
pickled, with several numbers at a time; a process that has seen a job keeps it, and with it the
machine code of its model."""

from __future__ import annotations

import hashlib
import os
import pickle
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Generic, TypeVar

from tracewire.errors import OptionError, Problem, SimulationError, TracewireError
from tracewire.solve.interrupt import Interrupted, StopFlag, until_interrupted
from tracewire.solve.limits import PARALLEL
from tracewire.solve.progress import PartProgress

T = TypeVar("T")
Job = Callable[..., T]
"""A function of some arguments and a `StopFlag`; it is picklable where an executor is to run it."""

Arguments = tuple[Any, ...]
"""Those of a job, but for the `StopFlag`."""


class WorkerEnded(SimulationError):
    """A worker of an executor was killed, and the executor does not replace it."""


class Crew(Generic[T]):
    """Who carries out a job: `submit` its arguments, and take from `done` what became of them."""

    def __init__(
        self, job: Job[T], pool: Executor, stop_flag: StopFlag, remote: bool, workers: int
    ) -> None:
        self.job, self.pool, self.stop_flag, self.workers = job, pool, stop_flag, workers
        self.waiting: dict[Future[Any], Sequence[tuple[Any, ...]]] = {}
        self.seconds = 0.0  # of a task, the last time
        self.content = pickle.dumps(job) if remote else b""
        self.key = hashlib.sha256(self.content).digest()

    @property
    def has_room(self) -> bool:
        """Whether another task would not only wait."""
        return len(self.waiting) < max(1, PARALLEL.ahead * self.workers)

    @property
    def chunk(self) -> int:
        """How many tasks are handed out at once."""
        return max(1, int(PARALLEL.chunk / self.seconds)) if self.content and self.seconds else 1

    def submit(self, tasks: Sequence[tuple[Any, ...]]) -> None:
        """Hand out some tasks, each with the arguments of the job."""
        if self.content:
            future = self.pool.submit(_elsewhere, self.key, self.content, tasks)
        else:
            future = self.pool.submit(_here, self.job, tasks, self.stop_flag)
        self.waiting[future] = tasks

    def drop(self) -> None:
        """Forget what has not begun."""
        for future in [future for future in self.waiting if future.cancel()]:
            del self.waiting[future]

    def done(self) -> Iterator[tuple[tuple[Any, ...], T | TracewireError]]:
        """What has ended, at least one task, with its arguments.

        Raises WorkerEnded where a worker has ended that the executor does not replace.
        """
        ended, _ = wait(self.waiting, PARALLEL.patience, FIRST_COMPLETED)
        while self.waiting and not ended:
            _end_where_one_was_killed(self.pool)
            ended, _ = wait(self.waiting, PARALLEL.patience, FIRST_COMPLETED)
        for future in ended:
            tasks = self.waiting.pop(future)
            try:
                results, seconds = future.result()
            except BrokenExecutor as error:
                what = f"a worker of the executor has ended ({error})"
                raise WorkerEnded([Problem(what, hint="Give a new executor.")]) from error
            self.seconds = seconds / len(tasks)
            yield from zip(tasks, results, strict=True)


def _end_where_one_was_killed(pool: Executor) -> None:
    """End the processes of a pool of which one was killed, so that its futures end, too.

    The pool sees that by itself, but not where the process was killed in the middle of a message:
    then the pool waits for the rest of it as long as the other end of that pipe is open, here and
    in the other processes.
    """
    processes = [*(getattr(pool, "_processes", None) or {}).values()]
    if all(process.exitcode in (None, 0) for process in processes):
        return
    for process in processes:
        process.kill()
    writer = getattr(getattr(pool, "_result_queue", None), "_writer", None)
    if writer is not None and not writer.closed:
        writer.close()


class _Here(Executor):
    """One worker, which is the thread that asks."""

    def submit(self, function: Callable[..., T], /, *arguments: Any, **named: Any) -> Future[T]:
        future: Future[T] = Future()
        future.set_result(function(*arguments, **named))
        return future


@contextmanager
def crew(
    job: Job[T], stop_flag: StopFlag, workers: int | None = None, executor: Executor | None = None
) -> Iterator[Crew[T]]:
    """Threads, as many as there are `workers`, or an executor; what waits at the end is dropped.

    One worker is the thread that asks, so that its callbacks run there.

    Raises OptionError: less than one worker, a job that cannot be sent.
    """
    count = worker_count(workers)
    if executor is None and count == 1:
        yield from _working(Crew(job, _Here(), stop_flag, False, 0))
        return
    if executor is None:
        with ThreadPoolExecutor(count, thread_name_prefix="tracewire") as pool:
            yield from _working(Crew(job, pool, stop_flag, False, count))
        return
    if workers is None:
        count = getattr(executor, "_max_workers", None) or count
    try:
        made = Crew(job, executor, stop_flag, True, count)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        what = f"this cannot be sent to another process: {error}"
        hint = "Give functions that a module defines, not a lambda or one inside of another."
        raise OptionError([Problem(what, hint=hint)]) from error
    yield from _working(made)


def _working(made: Crew[T]) -> Iterator[Crew[T]]:
    try:
        yield made
    except BaseException:
        made.stop_flag.asked = True
        raise
    finally:
        made.drop()


def carry_out(
    job: Job[T],
    tasks: Sequence[Arguments],
    take: Callable[[Arguments, T | TracewireError], Arguments | None],
    *,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: PartProgress | None = None,
) -> bool:
    """Do a job for each of the tasks, side by side; whether the user has stopped it by Ctrl-C.

    `take` gets what became of each task, in the order in which they end, and gives the task that
    goes on from it, or None. After Ctrl-C what has begun comes to its end and is given, too.

    Raises OptionError: less than one worker, a job that cannot be sent; WorkerEnded where a
    worker has ended that the executor does not replace.
    """
    ready = list(reversed(tasks))
    with until_interrupted() as stop_flag, crew(job, stop_flag, workers, executor) as made:
        while (ready and not stop_flag.asked) or made.waiting:
            if stop_flag.asked:
                made.drop()
            while ready and made.has_room and not stop_flag.asked:
                share = max(1, len(ready) // max(1, made.workers))  # all workers have something
                made.submit([ready.pop() for _ in range(min(made.chunk, share))])
            for arguments, result in made.done():
                follow = take(arguments, result)
                if follow is not None:
                    ready.append(follow)
                if progress is not None and not isinstance(result, Interrupted):
                    progress.step()
        return stop_flag.asked


def worker_count(workers: int | None) -> int:
    """The number of workers, the cores unless given. Raises OptionError."""
    if workers is not None and workers < 1:
        what = f"{workers} workers cannot work"
        raise OptionError([Problem(what, hint="Give a whole number above 0, or None.")])
    return workers or cores()


def cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _here(
    job: Job[T], tasks: Sequence[tuple[Any, ...]], stop_flag: StopFlag
) -> tuple[list[T | TracewireError], float]:
    """What the job makes of some tasks, and the seconds that it took."""
    began, results = time.perf_counter(), list[T | TracewireError]()
    for arguments in tasks:
        if stop_flag.asked:
            results.append(Interrupted([Problem("interrupted before it began")]))
            continue
        try:
            results.append(job(*arguments, stop_flag))
        except TracewireError as error:
            results.append(error)
    return results, time.perf_counter() - began


def _elsewhere(
    key: bytes, content: bytes, tasks: Sequence[tuple[Any, ...]]
) -> tuple[list[Any], float]:
    return _here(_job(key, content), tasks, StopFlag())


@lru_cache(maxsize=PARALLEL.jobs)
def _job(key: bytes, content: bytes) -> Job[Any]:
    return pickle.loads(content)  # type: ignore[no-any-return]
