#!/usr/bin/env python3
"""Measures studies of many plans on the engines they may run on: overheads, efficiency, and whether the bytes are the same.

    python benches/study.py [--plans 1000] [--workers 2] [--engines threads,local,dask,ray] [--kill]

Needs the package (crates/beadwright-py), pyarrow, and for their engines distributed and ray. The reference is a loop in one
process with one thread. Speed-up is its time over the engine's, start not counted. Busy is the share of the workers' time that
went into plans, and overhead what is left of it for each plan: both are clear of whatever else the machine does meanwhile.
With --kill a worker is killed midway, except in the loop.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import beadwright

STRATEGIES = ["contour", "zigzag"]


@contextmanager
def local(workers: int) -> Iterator[object]:
    with beadwright.LocalExecutor(workers) as executor:
        # Started before the clock is.
        list(executor.map(abs, range(4 * workers)))
        yield executor


@contextmanager
def dask(workers: int) -> Iterator[object]:
    from distributed import Client, LocalCluster

    with LocalCluster(
        n_workers=workers, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as cluster, Client(cluster) as client:
        client.gather(client.map(load, range(4 * workers)))
        yield client


@contextmanager
def ray(workers: int) -> Iterator[object]:
    # Ray takes the machine's address otherwise.
    os.environ["RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER"] = "0"
    import ray as engine

    engine.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
    executor = beadwright.RayExecutor()
    [future.result() for future in [executor.submit(load, number) for number in range(4 * workers)]]
    yield executor
    engine.shutdown()


@contextmanager
def loop(workers: int) -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as executor:
        yield executor


def load(number: int) -> str:
    """Loads the package in a worker."""
    return beadwright.__version__ + str(number)


ENGINES: dict[str, Callable[[int], object]] = {"loop": loop, "local": local, "dask": dask, "ray": ray}


def kill_one(seconds: float) -> None:
    """Kills a process below this one that plans, after some seconds."""

    def kill() -> None:
        time.sleep(seconds)
        below = subprocess.run(["ps", "-eo", "pid,ppid,pcpu,args"], capture_output=True, text=True).stdout.splitlines()
        rows = [line.split(None, 3) for line in below[1:]]
        own, grown = {str(os.getpid())}, True
        while grown:
            more = {pid for pid, parent, *_ in rows if parent in own} - own
            own, grown = own | more, bool(more)
        words = ("spawn_main", "ray::", "distributed")
        busy = [row for row in rows if row[0] in own - {str(os.getpid())} and any(word in row[3] for word in words)]
        busy = [row for row in busy if "resource_tracker" not in row[3]]
        if busy:
            os.kill(int(max(busy, key=lambda row: float(row[2]))[0]), signal.SIGKILL)

    threading.Thread(target=kill, daemon=True).start()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--plans", type=int, default=1000)
    arguments.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    arguments.add_argument("--engines", default="local,dask,ray")
    arguments.add_argument("--chunk", type=int, default=4)
    arguments.add_argument("--part", default="cross")
    arguments.add_argument("--kill", action="store_true")
    given = arguments.parse_args()
    part, count = beadwright.Part.example(given.part), given.plans // len(STRATEGIES)
    heights = [1.8 + 0.6 * k / count for k in range(count)]
    samples = [{"fill.strategy": name, "layers.height": height} for name in STRATEGIES for height in heights]
    print(f"{len(samples)} plans of {given.part}, {given.workers} workers, chunks of {given.chunk}; load {os.getloadavg()[0]:.1f}")
    print(f"{'engine':8} {'start s':>8} {'study s':>8} {'plan ms':>8} {'overhead ms':>12} {'busy':>7} {'speed-up':>9}  bytes")
    folder, reference, alone = Path(tempfile.mkdtemp()), b"", 0.0
    for name in ["loop", *given.engines.split(",")]:
        workers, begin = 1 if name == "loop" else given.workers, time.perf_counter()
        with ENGINES[name](workers) as executor:
            started = time.perf_counter()
            if given.kill and name != "loop":
                kill_one(alone / workers / 2)
            done = beadwright.study(part, samples=samples, folder=folder / name, executor=executor, chunk=given.chunk)
            took = time.perf_counter() - started
        content = done.path.read_bytes()
        alone, reference = alone or took, reference or content
        seconds = [json.loads(line)["seconds"] for line in (folder / name / "done.jsonl").read_text().splitlines()]
        each, spent = 1e3 * sum(seconds) / len(samples), 1e3 * took * workers / len(samples)
        same = "same" if content == reference else "DIFFERENT"
        row = f"{name:8} {started - begin:8.1f} {took:8.1f} {each:8.1f} {spent - each:12.1f} {100 * each / spent:5.0f} %"
        print(f"{row} {alone / took:9.2f}  {same}", flush=True)
    shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
