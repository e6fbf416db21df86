"""Jobs on several cores, in processes or threads, whose results come back in order."""

import functools
import multiprocessing
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, TypeVar

from scanplan.errors import StageError
from scanplan.geometry import fallbacks
from scanplan.stage import blas_memory, orphans

Job = TypeVar("Job")
Result = TypeVar("Result")

RunJobs = Callable[[Callable[..., Any], Iterable[tuple[Any, ...]]], Iterator[Any]]
"""`run(function, jobs)`: iterates over `function(*job)` of all jobs, in their order."""

JOBS_PER_CORE = 8
"""More balance jobs that take long, fewer begin less often and fill less memory."""

_setup_fault: Exception | None = None


@contextmanager
def open_pool(
    threads: int, setup: Callable[..., None] | None = None, *state: Any
) -> Iterator[RunJobs]:
    """Open a pool of worker processes; with one thread there is none, and the work is done here.

    Functions and their arguments are of modules, not of the script that is run.

    Parameters
    ----------
    setup : callable, optional
        `setup(*state)` is called once in every process that works, before its first job.

    Yields
    ------
    callable
        `run(function, jobs)`: iterates over `function(*job)` of all jobs, in their order. Jobs are
        taken from their iterable as workers become free, so that few wait.

    Raises
    ------
    StageError
        If a worker is ended from outside.
    """
    if threads <= 1:
        _set_up(setup, state)
        yield lambda function, jobs: (function(*job) for job in jobs)
        return
    # a forked child of a process with threads (Arrow, TBB) can hang, a spawned one cannot
    context = multiprocessing.get_context("spawn")
    with (
        _hide_script(),
        ProcessPoolExecutor(threads, context, _begin_worker, (setup, state)) as executor,
    ):
        try:
            yield lambda function, jobs: _run_in_order(
                executor, function, jobs, threads * JOBS_PER_CORE
            )
        except BrokenProcessPool:
            raise StageError(
                "a worker process was ended from outside, perhaps for want of memory; the same"
                " command goes on from here, with fewer --cores in less memory"
            ) from None
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            raise


def map_in_threads(
    function: Callable[[Job], Result], jobs: Iterable[Job], threads: int
) -> list[Result]:
    """Call a function of each job, in threads of this process.

    For work on large arrays that all jobs share, nearly all of which numpy does without Python's
    lock.

    Returns
    -------
    list
        What it returned, in the order of the jobs.
    """
    if threads <= 1:
        return [function(job) for job in jobs]
    with ThreadPoolExecutor(threads) as executor:
        return list(executor.map(function, jobs))


def begin_in_thread(
    function: Callable[..., Result], *arguments: Any, threads: int
) -> Callable[[], Result]:
    """Begin work on large arrays in another thread, where there is a core for it.

    Parameters
    ----------
    *arguments
        Its arguments.
    threads : int
        Of one alone the work is done when it is first asked for.

    Returns
    -------
    callable
        `wait()` returns what the function returned, at every call.
    """
    if threads <= 1:
        return functools.cache(lambda: function(*arguments))
    with_one = ThreadPoolExecutor(1)
    begun = with_one.submit(function, *arguments)
    with_one.shutdown(wait=False)
    return begun.result


@contextmanager
def _hide_script() -> Iterator[None]:
    """Let spawned processes import what they are given, and not this process's script.

    A stage's script imports Snakemake, and what only the stage itself needs.
    """
    script = sys.modules["__main__"]
    file = getattr(script, "__file__", None)
    if file is None:
        yield
        return
    del script.__file__
    try:
        yield
    finally:
        script.__file__ = file


def _set_up(setup: Callable[..., None] | None, state: tuple[Any, ...]) -> None:
    if setup is not None:
        setup(*state)


def _begin_worker(setup: Callable[..., None] | None, state: tuple[Any, ...]) -> None:
    global _setup_fault
    orphans.end_with_supervisor()
    try:
        blas_memory.take_work_space()
        _set_up(setup, state)
    except Exception as error:
        # raised here, it would look as if the process had been ended from outside
        _setup_fault = error


def _work(function: Callable[..., Any], job: tuple[Any, ...]) -> tuple[Any, int]:
    """Return what a job returns, and how many overlays it had done another way."""
    if _setup_fault is not None:
        raise _setup_fault
    fallbacks.take_fallbacks()
    return function(*job), fallbacks.take_fallbacks()


def _run_in_order(
    executor: ProcessPoolExecutor,
    function: Callable[..., Any],
    jobs: Iterable[tuple[Any, ...]],
    most_waiting: int,
) -> Iterator[Any]:
    waiting: deque[Future[tuple[Any, int]]] = deque()

    def take_first() -> Any:
        result, n_fallbacks = waiting.popleft().result()
        fallbacks.note_fallbacks(n_fallbacks)
        return result

    for job in jobs:
        waiting.append(executor.submit(_work, function, job))
        while waiting and (waiting[0].done() or len(waiting) > most_waiting):
            yield take_first()
    while waiting:
        yield take_first()
