"""Studies: the same table wherever they ran, also after a worker was killed or the study was stopped."""

from __future__ import annotations

import json
import os
import signal
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from conftest import box

import beadwright
from beadwright import BeadwrightError, LocalExecutor, Part, Plan, RayExecutor, Study, study

pytest.importorskip("pyarrow")

GRID: dict[str, list[Any]] = {"layers.height": [1.5, 2.0, 2.5], "fill.strategy": ["contour", "zigzag"]}


def parts() -> list[Part]:
    return [box(60, 40, 10), box(35, 80, 6)]


def longest(plan: Plan) -> float:
    """A measure of one's own."""
    return max(each.length for each in plan.passes)


def dying(plan: Plan) -> float:
    """Kills the first worker that comes by."""
    mark = Path(os.environ["BEADWRIGHT_MARK"])
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0


def failing(plan: Plan) -> float:
    """A measure with a fault of its own."""
    raise ZeroDivisionError(plan.part)


class Counting(Executor):
    """Counts what it is given, and may lose some of it."""

    def __init__(self, lost: int = 0) -> None:
        self.submitted, self.lost = 0, lost

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.submitted += 1
        future: Future[Any] = Future()
        if self.submitted <= self.lost:
            future.set_exception(BrokenExecutor("a worker was lost"))
        else:
            future.set_result(fn(*args, **kwargs))
        return future


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return study(parts(), GRID, folder=tmp_path_factory.mktemp("study"), executor=ThreadPoolExecutor(1))


def test_rows_are_those_of_plans(reference: Study) -> None:
    assert len(reference.rows) == 12
    for row in reference.rows[:4]:
        profile = beadwright.Profile().set({key: row[key] for key in GRID})
        plan = beadwright.plan(parts()[0], profile)
        assert row["total_time_s"] == plan.metrics["total_time_s"]
        assert row["arc_starts"] == plan.metrics["arc_starts"]


def test_the_file_is_the_table(reference: Study) -> None:
    import pyarrow.parquet as pq

    assert pq.read_table(reference.path).to_pylist() == reference.rows


@pytest.mark.parametrize("workers", [1, 2])
def test_processes_give_the_same_bytes(reference: Study, workers: int, tmp_path: Path) -> None:
    with LocalExecutor(workers) as executor:
        again = study(parts(), GRID, folder=tmp_path, executor=executor, chunk=workers)
    assert again.path.read_bytes() == reference.path.read_bytes()


def test_dask_gives_the_same_bytes(reference: Study, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": None, "host": "127.0.0.1"}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        again = study(parts(), GRID, folder=tmp_path, executor=client)
    assert again.path.read_bytes() == reference.path.read_bytes()


@pytest.mark.skipif("BEADWRIGHT_RAY" not in os.environ, reason="Ray takes half a minute; BEADWRIGHT_RAY=1 asks for it")
def test_ray_gives_the_same_bytes(reference: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # On loopback; Ray takes the machine's address otherwise.
    monkeypatch.setenv("RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER", "0")
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=1, include_dashboard=False, log_to_driver=False)
    try:
        assert {node["NodeManagerAddress"] for node in ray.nodes()} == {"127.0.0.1"}
        again = study(parts(), GRID, folder=tmp_path, executor=RayExecutor())
    finally:
        ray.shutdown()
    assert again.path.read_bytes() == reference.path.read_bytes()


def test_what_is_done_is_not_done_again(reference: Study, tmp_path: Path) -> None:
    first, second = Counting(), Counting()
    half: dict[str, list[Any]] = {"layers.height": [1.5, 2.0], "fill.strategy": ["contour", "zigzag"]}
    assert study(parts(), half, folder=tmp_path, executor=first).planned == 8
    whole = study(parts(), GRID, folder=tmp_path, executor=second, chunk=1)
    assert (first.submitted, second.submitted, whole.planned) == (2, 4, 4)
    assert whole.path.read_bytes() == reference.path.read_bytes()
    assert study(parts(), GRID, folder=tmp_path, executor=Counting()).planned == 0


def test_half_a_line_of_the_journal_is_done_again(reference: Study, tmp_path: Path) -> None:
    study(parts(), GRID, folder=tmp_path, executor=Counting())
    journal = tmp_path / "done.jsonl"
    text = journal.read_text()
    journal.write_text(text[:-20])
    again = study(parts(), GRID, folder=tmp_path, executor=Counting())
    assert again.planned == 1
    assert again.path.read_bytes() == reference.path.read_bytes()
    assert all(json.loads(line) for line in journal.read_text().splitlines())


def test_a_killed_worker_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BEADWRIGHT_MARK", str(tmp_path / "killed"))
    with LocalExecutor(2) as executor:
        done = study(parts(), GRID, measures=[dying, "arc_starts"], folder=tmp_path / "s", executor=executor)
    assert (tmp_path / "killed").exists()
    assert [row["dying"] for row in done.rows] == [1.0] * 12


def test_what_is_lost_is_handed_out_again(reference: Study, tmp_path: Path) -> None:
    executor = Counting(lost=2)
    again = study(parts(), GRID, folder=tmp_path, executor=executor)
    assert executor.submitted == 6
    assert again.path.read_bytes() == reference.path.read_bytes()


def test_what_is_lost_too_often_is_raised(tmp_path: Path) -> None:
    with pytest.raises(Exception, match="a worker was lost"):
        study(parts(), GRID, folder=tmp_path, executor=Counting(lost=100))


def test_a_fault_of_a_measure_is_raised_and_not_tried_again(tmp_path: Path) -> None:
    with LocalExecutor(1) as executor, pytest.raises(ZeroDivisionError, match="box"):
        study(parts(), GRID, measures=[failing], folder=tmp_path, executor=executor)
    assert not (tmp_path / "study.parquet").exists()


def test_a_stopped_study_goes_on(reference: Study, tmp_path: Path) -> None:
    def stop(stage: str, fraction: float) -> None:
        if fraction > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study(parts(), GRID, folder=tmp_path, executor=Counting(), progress=stop)
    rest = study(parts(), GRID, folder=tmp_path, executor=Counting())
    assert rest.planned == 8, "the first four are known"
    assert rest.path.read_bytes() == reference.path.read_bytes()


def test_a_sample_that_cannot_be_has_its_sentence(tmp_path: Path) -> None:
    samples: list[dict[str, Any]] = [{"bead.width": 7.0}, {"bead.width": -1.0}]
    done = study(box(60, 40, 6), samples=samples, folder=tmp_path, executor=Counting())
    assert [row["error"] is None for row in done.rows] == [True, False]
    assert "bead.width = -1" in done.rows[1]["error"]
    assert done.rows[1]["arc_starts"] is None


def test_measures_of_every_kind(tmp_path: Path) -> None:
    measures: dict[str, Any] = {"longest": longest, "void": "deposit.void_percent", "time": "total_time_s"}
    [row] = study(box(60, 40, 6), measures=measures, folder=tmp_path, executor=ThreadPoolExecutor(1)).rows
    plan = beadwright.plan(box(60, 40, 6))
    assert row["longest"] == longest(plan)
    assert row["time"] == plan.metrics["total_time_s"]
    assert row["void"] == beadwright.simulate(plan).deposit["void_percent"]


def test_an_unknown_measure_names_those_that_are(tmp_path: Path) -> None:
    [row] = study(box(60, 40, 6), measures=["colour"], folder=tmp_path, executor=Counting()).rows
    assert "total_time_s" in row["error"]


def test_nobody_beats_the_front(reference: Study) -> None:
    best = reference.pareto("total_time_s", "arc_starts")
    assert best
    for row in reference.rows:
        beaten = [
            other
            for other in best
            if other["total_time_s"] <= row["total_time_s"] and other["arc_starts"] <= row["arc_starts"]
        ]
        assert beaten, "each row is on the front or beaten by it"
    most = reference.pareto("coverage", greater=["coverage"])
    assert {row["coverage"] for row in most} == {max(row["coverage"] for row in reference.rows)}


def test_a_figure_is_drawn(reference: Study, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    reference.plot("total_time_s", "wire_mass_kg").savefig(tmp_path / "pareto.svg")
    assert "total_time_s" in (tmp_path / "pareto.svg").read_text() or (tmp_path / "pareto.svg").stat().st_size > 10_000


def test_a_study_has_a_grid_or_samples(tmp_path: Path) -> None:
    with pytest.raises(BeadwrightError, match="either"):
        study(box(60, 40, 6), GRID, samples=[{}], folder=tmp_path)


def test_progress_ends_at_one(tmp_path: Path) -> None:
    seen: list[float] = []
    study(parts(), GRID, folder=tmp_path, executor=Counting(), progress=lambda _, fraction: seen.append(fraction))
    assert seen == sorted(seen)
    assert seen[-1] == 1
