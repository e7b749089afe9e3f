"""The examples run, and what docs/python.md says."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest
from conftest import write_stl

from beadwright import Part

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
PAGE = Path(__file__).resolve().parents[3] / "docs" / "python.md"


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


def test_the_page_is_true(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for needed in ["tqdm", "pyarrow", "matplotlib"]:
        pytest.importorskip(needed)
    monkeypatch.chdir(tmp_path)
    for name in ["propeller", "cross"]:
        write_stl(Part.example(name), tmp_path / f"{name}.stl")
    known: dict[str, object] = {}
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), known)
    assert len(blocks) == 2
    assert (tmp_path / "out" / "PROPELLER.src").exists()
    assert (tmp_path / "study" / "study.parquet").exists()
