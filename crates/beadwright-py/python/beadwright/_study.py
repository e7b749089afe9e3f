"""Many plans, on one machine or on many: a table that continues where it was stopped."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import time
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any, TypeAlias

from beadwright import _core, _pareto
from beadwright._errors import BeadwrightError
from beadwright._executors import LocalExecutor, executor_of
from beadwright._judging import simulate
from beadwright._part import Part
from beadwright._plan import Model, Plan, Process, part_of, plan, profile_of
from beadwright._profile import Profile, Value
from beadwright._progress import Progress, steps

#: A number of ``plan.metrics``; one of the deposit model, such as ``deposit.void_percent``; or a function of the plan.
Measure: TypeAlias = str | Callable[[Plan], float]
Sample: TypeAlias = Mapping[str, Value]

#: What is measured if nothing is asked for.
USUAL = ("arc_starts", "deposited_length_mm", "total_time_s", "wire_mass_kg", "coverage")

JOURNAL, TABLE = "done.jsonl", "study.parquet"


@dataclass(frozen=True)
class _Job:
    """One plan: what is changed in the profile, and the key that shows whether it was done before."""

    part: Part
    sample: dict[str, Value]
    key: str


def study(
    parts: Iterable[Model] | Model,
    grid: Mapping[str, Iterable[Value]] | None = None,
    *,
    samples: Iterable[Sample] | None = None,
    measures: Sequence[Measure] | Mapping[str, Measure] = USUAL,
    profile: Process = "cmt-al2319-kuka",
    folder: str | os.PathLike[str] = "beadwright-study",
    executor: Any = None,
    chunk: int = 4,
    retries: int = 3,
    progress: Progress = None,
) -> Study:
    """Plans every part with every sample of profile keys, and measures the plans.

    ``grid`` gives the values of each key, all combinations of which are planned; ``samples`` gives them one by one. The
    results are in ``folder``: study.parquet, whose bytes depend on the parts, samples and measures only, and a journal.
    Started again, a study continues: what was done with the same part, profile, measures and version is not done again.

    ``executor`` is anything with ``submit``, such as one of ``concurrent.futures``, a ``distributed.Client``, or
    :class:`RayExecutor`; processes of this machine if left out. Plans of one part are handed out ``chunk`` at a time, each
    planned with one thread. What fails because a worker was lost is done again, ``retries`` times. What Beadwright refuses
    has its sentence in the column ``error``.

    Raises :class:`BeadwrightError` where nothing can be done, and what a worker raised.
    """
    wanted, base = _named(measures), profile_of(profile)
    models = [parts] if isinstance(parts, Part | str | os.PathLike) else parts
    jobs = list(_jobs([part_of(part) for part in models], list(_samples(grid, samples)), base, wanted))
    journal = _Journal(Path(folder))
    left = {job.key: job for job in jobs if job.key not in journal.done}
    # An executor that was passed in lives on after the study.
    own: AbstractContextManager[Executor] = LocalExecutor() if executor is None else nullcontext(executor_of(executor))
    with steps(progress) as step, own as workers:
        came = _outcomes(workers, _chunks(left.values(), chunk), base, wanted, retries)
        # Closed before the workers are, so that a study that is stopped waits for the plans in flight only.
        with closing(came):
            for outcomes in came:
                journal.add(outcomes)
                if step is not None:
                    step("study", 1 - sum(key not in journal.done for key in left) / len(left))
    rows = [_row(job, journal.done[job.key], wanted) for job in jobs]
    result = Study(rows, Path(folder) / TABLE, planned=len(left))
    result._write()
    return result


class Study:
    """The table of a study. Made by :func:`study`."""

    def __init__(self, rows: list[dict[str, Any]], path: Path, planned: int) -> None:
        #: One for each plan: part, changed keys, measures, and the sentence of an error.
        self.rows = rows
        #: The Parquet file.
        self.path = path
        #: Number of plans made this time; the others were already known.
        self.planned = planned

    def table(self) -> Any:
        """The rows as a ``pyarrow.Table``."""
        import pyarrow as pa

        names = self.rows[0] if self.rows else {}
        return pa.table({name: pa.array([row[name] for row in self.rows]) for name in names})

    def _write(self) -> None:
        """Writes the Parquet file, which is complete or absent."""
        import pyarrow.parquet as pq

        beside = self.path.with_suffix(".tmp")
        pq.write_table(self.table(), beside)
        beside.replace(self.path)

    def pareto(self, *measures: str, greater: Collection[str] = ()) -> list[dict[str, Any]]:
        """The rows that no other beats in these measures. Less is better, except in those named in ``greater``."""
        return _pareto.front(self.rows, measures, greater)

    def plot(self, x: str, y: str, *, greater: Collection[str] = ()) -> Any:
        """All plans as points over two measures, and a line through the best ones, as a ``matplotlib`` figure."""
        return _pareto.figure(self.rows, x, y, self.pareto(x, y, greater=greater))

    def _repr_html_(self) -> str:
        return str(self.table().to_pandas()._repr_html_())

    def __repr__(self) -> str:
        return f"<Study {self.path}: {len(self.rows)} plans, {self.planned} of them made now>"


class _Journal:
    """What was done, line by line: whenever the study is stopped, only the plans in flight are lost."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / JOURNAL
        self.done: dict[str, dict[str, Any]] = {}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lines = self._path.read_text(encoding="utf-8").splitlines(keepends=True) if self._path.exists() else []
        except OSError as error:
            raise BeadwrightError(f"{folder} cannot be used: {error.strerror}.", str(folder)) from error
        for line in lines:
            # A study that was killed may have left half a line.
            if line.endswith("\n"):
                outcome = json.loads(line)
                self.done[outcome["key"]] = outcome
        if lines and not lines[-1].endswith("\n"):
            self._path.write_text("".join(lines[:-1]), encoding="utf-8")

    def add(self, outcomes: list[dict[str, Any]]) -> None:
        with self._path.open("a", encoding="utf-8") as file:
            file.writelines(json.dumps(outcome) + "\n" for outcome in outcomes)
        self.done.update((outcome["key"], outcome) for outcome in outcomes)


def _named(measures: Sequence[Measure] | Mapping[str, Measure]) -> dict[str, Measure]:
    if isinstance(measures, Mapping):
        return dict(measures)
    return {each if isinstance(each, str) else each.__name__: each for each in measures}


def _samples(grid: Mapping[str, Iterable[Value]] | None, samples: Iterable[Sample] | None) -> Iterator[dict[str, Value]]:
    if grid is not None and samples is not None:
        raise BeadwrightError("a study has either a grid or samples.", "samples")
    if samples is not None:
        yield from map(dict, samples)
        return
    keys = list(grid or {})
    for values in itertools.product(*((grid or {})[key] for key in keys)):
        yield {key: _plain(value) for key, value in zip(keys, values, strict=True)}


def _plain(value: Any) -> Any:
    """A NumPy number as a Python number."""
    return value.item() if hasattr(value, "item") else value


def _jobs(
    parts: Sequence[Part], samples: Sequence[dict[str, Value]], base: Profile, measures: Mapping[str, Measure]
) -> Iterator[_Job]:
    given = [f"{name}={each if isinstance(each, str) else _place(each)}" for name, each in measures.items()]
    settings = [json.dumps({key: _plain(value) for key, value in sample.items()}, sort_keys=True) for sample in samples]
    for part in parts:
        common = [_core.VERSION, part.key, base.key, *given]
        for sample, setting in zip(samples, settings, strict=True):
            yield _Job(part, sample, hashlib.sha256("\0".join([*common, setting]).encode()).hexdigest())


def _place(measure: Callable[[Plan], float]) -> str:
    return f"{measure.__module__}.{measure.__qualname__}"


def _chunks(jobs: Iterable[_Job], size: int) -> Iterator[list[_Job]]:
    """Jobs of one part, a few at a time: the part travels once with them."""
    for _, own in itertools.groupby(jobs, key=lambda job: id(job.part)):
        while some := list(itertools.islice(own, max(size, 1))):
            yield some


def _outcomes(
    workers: Executor, chunks: Iterable[list[_Job]], base: Profile, measures: dict[str, Measure], retries: int
) -> Generator[list[dict[str, Any]], None, None]:
    """Hands the chunks out, and yields what comes back, as it comes; what was lost with its worker is handed out again."""
    ended: SimpleQueue[Future[list[dict[str, Any]]]] = SimpleQueue()
    running: dict[Future[list[dict[str, Any]]], tuple[list[_Job], int]] = {}

    def hand_out(jobs: list[_Job], tries: int) -> None:
        plain = [(job.sample, job.key) for job in jobs]
        future = workers.submit(_measure_all, jobs[0].part, base, plain, measures)
        running[future] = jobs, tries
        future.add_done_callback(ended.put)

    for jobs in chunks:
        hand_out(jobs, 0)
    try:
        while running:
            future = ended.get()
            jobs, tries = running.pop(future)
            error = future.exception()
            if error is None:
                yield future.result()
            elif tries < retries and _is_lost(error):
                hand_out(jobs, tries + 1)
            else:
                raise error
    finally:
        for future in running:
            future.cancel()


def _is_lost(error: BaseException) -> bool:
    """Whether it is the worker that failed, not what it did."""
    lost = {"BrokenExecutor", "BrokenProcessPool", "KilledWorker", "CommClosedError", "WorkerCrashedError", "RayError"}
    return any(kind.__name__ in lost for kind in type(error).__mro__) and "RayTaskError" not in type(error).__name__


def _measure_all(
    part: Part, base: Profile, samples: list[tuple[dict[str, Value], str]], measures: dict[str, Measure]
) -> list[dict[str, Any]]:
    """Makes and measures the plans of a chunk, in a worker."""
    return [_measured(part, base, sample, measures) | {"key": key} for sample, key in samples]


def _measured(part: Part, base: Profile, sample: dict[str, Value], measures: dict[str, Measure]) -> dict[str, Any]:
    begin = time.perf_counter()
    try:
        made = plan(part, base.set(sample), threads=1)
        deposit = simulate(made, threads=1).deposit if any(_of_deposit(each) for each in measures.values()) else {}
        values = {name: _value(made, deposit, each) for name, each in measures.items()}
        return {"values": values, "error": None, "seconds": time.perf_counter() - begin}
    except BeadwrightError as error:
        return {"values": {}, "error": str(error), "seconds": time.perf_counter() - begin}


def _of_deposit(measure: Measure) -> bool:
    return isinstance(measure, str) and measure.startswith("deposit.")


def _value(made: Plan, deposit: dict[str, Any], measure: Measure) -> float | None:
    if not isinstance(measure, str):
        return float(measure(made))
    values, name = (deposit, measure.removeprefix("deposit.")) if _of_deposit(measure) else (made.metrics, measure)
    if name not in values:
        raise BeadwrightError(f'there is no measure "{measure}"; use {", ".join(sorted(values))}.', "measures")
    value = values[name]
    return None if value is None else float(value)


def _row(job: _Job, outcome: dict[str, Any], measures: Iterable[str]) -> dict[str, Any]:
    values = {name: outcome["values"].get(name) for name in measures}
    return {"part": job.part.name, **job.sample, **values, "error": outcome["error"], "key": job.key}
