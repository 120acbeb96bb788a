"""Executors of the parts of an ensemble: this thread, threads, processes, or an executor of the user.

Only a few parts are submitted at a time, so that memory does not grow with their number. A part that is lost
with its worker is submitted again; its results do not depend on the worker.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable, Generator, Iterator
from concurrent import futures
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice

from carom import checks

NAMES = ("threads", "processes", "serial")
SUBMISSIONS = 5  # greatest number of times that a part is submitted, if its worker is lost


def check_engine(executor) -> None:
    """Refuse a value that is neither the name of an engine nor an executor."""
    if executor in ("dask", "distributed"):
        raise ValueError(
            f"executor must be a client of dask for many machines, got {executor!r}: "
            "executor=distributed.Client() starts workers on this one"
        )
    if isinstance(executor, str):
        checks.choice("executor", executor, NAMES)
    elif isinstance(executor, type) or not (
        hasattr(executor, "get_executor") or hasattr(executor, "submit")
    ):
        raise TypeError(
            f"executor must be one of {', '.join(map(repr, NAMES))}, a concurrent.futures.Executor or a "
            f"dask.distributed.Client, got {checks.shown(executor)}"
        )


GUARD = (
    'a script that starts processes must begin its work below `if __name__ == "__main__":`, because each '
    'process imports the script; or use executor="threads"'
)


def check_processes(executor, **sent) -> None:
    """Refuse a start within a process that is being started, and what cannot be sent to processes."""
    if executor != "processes" and not isinstance(executor, futures.ProcessPoolExecutor):
        return
    import multiprocessing

    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise RuntimeError(GUARD)
    for name, one in sent.items():
        here = getattr(one, "__module__", "") == "__main__"
        try:
            pickle.dumps(one)
            if here and callable(one) and not hasattr(sys.modules["__main__"], "__file__"):
                raise TypeError("it is defined in an interactive session")
        except Exception as error:
            raise ValueError(
                f"{name} must be what a process can import (no lambda, no function within another one or in a "
                f"notebook), got {checks.shown(one)}: {error}; put it into a module, or use "
                'executor="threads"'
            ) from None


@contextmanager
def engine(executor, workers: int | None):
    """Yield (submit, wait for the first result, number of parts to submit at once)."""
    if isinstance(executor, str):
        count = workers or os.cpu_count() or 1
        if executor == "serial":
            yield _at_once, 1
            return
        if executor == "threads":
            pool = futures.ThreadPoolExecutor(count)
        else:
            import multiprocessing

            spawn = multiprocessing.get_context("spawn")
            pool = futures.ProcessPoolExecutor(count, mp_context=spawn)
        try:
            yield pool.submit, 2 * count
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
    elif hasattr(executor, "get_executor"):  # a client of dask.distributed
        pool = executor.get_executor(pure=False)
        cores = max(1, sum(executor.ncores().values()))
        yield pool.submit, 2 * (workers or cores)
    else:
        yield executor.submit, 2 * (workers or os.cpu_count() or 1)


def _at_once(function, *arguments) -> futures.Future:
    """Run a task in this thread, without delay."""
    done: futures.Future = futures.Future()
    try:
        done.set_result(function(*arguments))
    except Exception as error:
        done.set_exception(error)
    return done


def each(
    tasks: Iterator[tuple],
    function: Callable,
    executor,
    workers: int | None,
    stop: Callable[[], None],
    late: list,
) -> Generator:
    """Yield `function(*task)` for all tasks, in the order in which they are completed.

    At an interruption `stop` tells running tasks to end soon, and the results of those of this library's own
    executors are appended to `late`.
    """
    running: dict[futures.Future, tuple[tuple, int]] = {}
    try:
        with engine(executor, workers) as (submit, most):
            try:
                yield from _all(tasks, function, submit, most, running)
            except BaseException:
                stop()
                for future in running:
                    future.cancel()
                raise
    except (KeyboardInterrupt, GeneratorExit):
        mine = running if isinstance(executor, str) else ()
        found = [_outcome(future) for future in mine if not future.cancelled()]
        late.extend(result for result, error in found if error is None)
        raise


def _all(tasks, function: Callable, submit, most: int, running: dict) -> Generator:
    """Yield the results of all tasks, `most` of them `running` at a time; a lost one is submitted again."""

    def start(task: tuple, tried: int) -> None:
        running[submit(function, *task)] = task, tried

    for task in islice(tasks, most):
        start(task, 1)
    while running:
        finished, _ = futures.wait(running, return_when=futures.FIRST_COMPLETED)
        for future in finished:
            task, tried = running.pop(future)
            result, error = _outcome(future)
            if error is None:
                yield result
            elif tried < SUBMISSIONS and _lost(error):
                start(task, tried + 1)
            elif isinstance(error, BrokenProcessPool):
                raise RuntimeError(
                    f"a process ended before its runs were made: it was killed (memory), or {GUARD}"
                ) from error
            else:
                raise error
        for task in islice(tasks, most - len(running)):
            start(task, 1)


def _outcome(future: futures.Future) -> tuple[object, Exception | None]:
    """Return the result of a task, or the error with which it ended."""
    try:
        return future.result(), None
    except Exception as error:
        return None, error


def _lost(error: Exception) -> bool:
    """Return whether the worker failed, not the task."""
    names = {kind.__name__ for kind in type(error).__mro__}
    return bool(
        names & {"KilledWorker", "CancelledError", "FutureCancelledError", "CommClosedError"}
    )
