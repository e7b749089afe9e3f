"""The examples run."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize(("name", "needs"), [("ten_lines", "numpy"), ("optimise", "optuna"), ("sweep", "pyarrow")])
def test_an_example_runs(
    name: str, needs: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip(needs)
    monkeypatch.chdir(tmp_path)
    # Not as __main__: the call is below that guard, as in any script that starts processes.
    example = runpy.run_path(str(EXAMPLES / f"{name}.py"))
    if "main" in example:
        example["main"]()
    assert capsys.readouterr().out
