"""What runs the plans of a study: processes of this machine, or anything with the interface of ``concurrent.futures``."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


class LocalExecutor(Executor):
    """Processes of this machine. Where one of them is killed, new ones take their place."""

    def __init__(self, workers: int | None = None) -> None:
        self._workers = workers
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        # Forked processes would inherit threads that do not run in them.
        return ProcessPoolExecutor(self._workers, mp_context=multiprocessing.get_context("spawn"))

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As in ``concurrent.futures``."""
        try:
            return self._pool.submit(fn, *args, **kwargs)
        except BrokenExecutor:
            self._pool = self._new()
            return self._pool.submit(fn, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """As in ``concurrent.futures``."""
        self._pool.shutdown(wait, cancel_futures=cancel_futures)


class RayExecutor(Executor):
    """Ray's workers: of the cluster that ``ray.init`` joined, or of this machine. Ray itself repeats the work of a killed one."""

    def __init__(self, retries: int = 3) -> None:
        import ray

        if not ray.is_initialized():
            ray.init(include_dashboard=False, log_to_driver=False)
        self._run: Any = ray.remote(max_retries=retries)(_call)

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As in ``concurrent.futures``."""
        future: Future[T] = self._run.remote(fn, args, kwargs).future()
        return future


def _call(function: Callable[..., T], arguments: tuple[Any, ...], named: dict[str, Any]) -> T:
    return function(*arguments, **named)


def executor_of(given: Any) -> Executor:
    """What was passed as an executor: a ``distributed.Client`` has one."""
    if hasattr(given, "get_executor"):
        executor: Executor = given.get_executor()
        return executor
    chosen: Executor = given
    return chosen
