"""Long calls: progress, Ctrl-C, other threads, and a quick import."""

from __future__ import annotations

import _thread
import pickle
import signal
import subprocess
import sys
import threading

import pytest
from conftest import box

import beadwright
from beadwright import BeadwrightError, Part


def test_progress_comes_stage_by_stage() -> None:
    steps: list[tuple[str, float]] = []
    beadwright.plan(Part.example("cross"), progress=lambda stage, fraction: steps.append((stage, fraction)))
    assert {"plan"} <= {stage for stage, _ in steps} <= {"import", "slice", "plan", "deposit", "heat"}
    assert all(0 <= fraction <= 1 for _, fraction in steps)


def test_progress_is_called_on_the_callers_thread() -> None:
    threads: set[int] = set()
    beadwright.plan(Part.example("cross"), progress=lambda *_: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_what_progress_raises_ends_the_call() -> None:
    def stop(stage: str, fraction: float) -> None:
        raise RuntimeError(f"enough of {stage}")

    with pytest.raises(RuntimeError, match="enough of"):
        beadwright.plan(Part.example("propeller"), progress=stop)


def test_ctrl_c_ends_the_call() -> None:
    # Jobs in the background of a shell ignore it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            beadwright.plan(Part.example("propeller"), progress=lambda *_: _thread.interrupt_main())
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_bar_is_drawn(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    beadwright.plan(box(60, 40, 6), progress=True)
    assert "%" in capsys.readouterr().err


def test_other_threads_go_on_meanwhile() -> None:
    seen, done = threading.Event(), threading.Event()

    def other() -> None:
        # Waits for the call to begin, then runs Python while it lasts.
        began.wait()
        seen.set()

    began = threading.Event()
    thread = threading.Thread(target=other)
    thread.start()

    def step(stage: str, fraction: float) -> None:
        began.set()
        # The lock is ours here; the other thread can only go on while the library works.
        if seen.wait(10):
            done.set()

    beadwright.plan(Part.example("cross"), progress=step)
    thread.join()
    assert done.is_set()


def test_import_loads_nothing_heavy() -> None:
    script = "import sys, beadwright; print([name for name in ('numpy', 'pyarrow', 'tqdm') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_errors_travel_to_another_process() -> None:
    error = pickle.loads(pickle.dumps(BeadwrightError("It is too thin.", "layer 3", "Take a narrower bead.")))
    assert (error.place, error.remedy) == ("layer 3", "Take a narrower bead.")
    assert str(error) == "It is too thin. Take a narrower bead."


def test_every_public_name_is_there() -> None:
    assert all(hasattr(beadwright, name) for name in beadwright.__all__)
    assert beadwright.__all__ == sorted(beadwright.__all__)
