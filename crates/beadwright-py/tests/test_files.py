"""Files: the same bytes as the command's, for any number of threads."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import Command, box, prism

import beadwright
from beadwright import BeadwrightError, Part, Plan, Profile


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("part", "profile", "strategy", "setting"),
    [
        ("cross", "cmt-al2319-kuka", None, {}),
        ("propeller", "cmt-al2319-kuka", "contour", {"layers.height": 2.5}),
        ("star", "cmt-steel-abb", "zigzag", {"fill.raster_angle": 30.0}),
        ("plate", "plasma-304-cnc", "hybrid", {}),
    ],
)
def test_the_bytes_are_the_commands(
    part: str, profile: str, strategy: str | None, setting: dict[str, float], command: Command, tmp_path: Path
) -> None:
    model = tmp_path / f"{part}.stl"
    assert command("example", part, "-o", model).returncode == 0
    options = ["--strategy", strategy] if strategy else []
    options += [word for key, value in setting.items() for word in ("--set", f"{key}={value}")]
    done = command("plan", model, "--profile", profile, *options, "-o", tmp_path / "theirs")
    assert done.returncode == 0, done.stderr
    plan = beadwright.plan(Part.read(model), Profile(profile).set(setting), strategy=strategy)
    written = plan.save(tmp_path / "ours")
    assert files(tmp_path / "ours") == files(tmp_path / "theirs")
    assert {path.name for path in written} == set(files(tmp_path / "ours"))


def test_other_posts_give_the_commands_bytes(command: Command, tmp_path: Path) -> None:
    model = tmp_path / "cross.stl"
    command("example", "cross", "-o", model)
    words = ["--profile", "cmt-steel-robots", "--post", "inform", "--post", "urscript", "--no-deposit"]
    done = command("plan", model, *words, "-o", tmp_path / "theirs")
    assert done.returncode == 0, done.stderr
    plan = beadwright.plan(model, "cmt-steel-robots")
    plan.save(tmp_path / "ours", post=["inform", "urscript"], deposit=False)
    theirs = files(tmp_path / "theirs")
    assert files(tmp_path / "ours") == theirs
    posted = plan.post("inform", "urscript")
    assert {name: text.encode() for name, text in posted.items()} == {name: theirs[name] for name in posted}
    assert len(posted) == len(theirs) - 3, "all but plan.json, metrics.json and report.html"


def test_threads_change_nothing() -> None:
    part = Part.example("star")
    one = beadwright.plan(part, threads=1).post()
    assert one == beadwright.plan(part, threads=3).post() == beadwright.plan(part).post()


def test_two_python_threads_give_the_same_bytes() -> None:
    parts = [Part.example("cross"), Part.example("gear"), box(60, 40, 10)] * 2

    def program(part: Part) -> dict[str, str]:
        return beadwright.plan(part, threads=1).post()

    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(program, parts))
    assert together == [program(part) for part in parts]


def test_metrics_are_those_of_the_file(cross: Plan, tmp_path: Path) -> None:
    cross.save(tmp_path)
    written = json.loads((tmp_path / "metrics.json").read_text())
    assert {name: written[name] for name in cross.metrics} == cross.metrics
    assert written["deposit"] == beadwright.simulate(cross).deposit


def test_a_folder_is_exchanged_as_a_set(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    beadwright.plan(box(60, 40, 10)).save(folder, deposit=False)
    (folder / "mine.txt").write_text("mine")
    before = set(files(folder))
    beadwright.plan(box(60, 40, 6)).save(folder, deposit=False)
    gone = before - set(files(folder))
    assert gone
    assert all("L00" in name for name in gone), "programs of layers that are no more"
    assert (folder / "mine.txt").read_text() == "mine"


def test_a_folder_that_cannot_be_written_is_named(cross: Plan, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(BeadwrightError, match="cannot be written"):
        cross.save(tmp_path / "file")


def test_a_dialect_without_its_section_is_refused(cross: Plan) -> None:
    with pytest.raises(BeadwrightError, match="gcode"):
        cross.post("gcode")
    with pytest.raises(BeadwrightError, match="basic"):
        cross.post("basic")


def test_what_should_not_be_started_is_not_written(tmp_path: Path) -> None:
    low, faces = prism([(0, 0), (60, 0), (60, 40), (0, 40)], 4)
    high, more = prism([(0, 0), (60, 0), (60, 40), (0, 40)], 4)
    part = Part.from_triangles(np.vstack([low, high + (0, 0, 20)]), np.vstack([faces, more + len(low)]))
    plan = beadwright.plan(part, strategy="contour")
    assert plan.forbidden
    with pytest.raises(BeadwrightError, match="allow_findings=True"):
        plan.save(tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert plan.save(tmp_path / "out", allow_findings=True)


@pytest.mark.parametrize("ending", ["csv", "parquet", "vtp", "3mf", "stl", "glb"])
def test_exports_are_as_large_as_the_commands(ending: str, command: Command, tmp_path: Path) -> None:
    plan = beadwright.plan(Part.example("cross"), strategy="contour")
    plan.save(tmp_path / "out", deposit=False)
    done = command("export", tmp_path / "out" / "plan.json", "-o", tmp_path / f"theirs.{ending}")
    assert done.returncode == 0, done.stderr
    plan.export(tmp_path / f"ours.{ending}")
    ours, theirs = ((tmp_path / f"{who}.{ending}").read_bytes() for who in ("ours", "theirs"))
    # plan.json has its places rounded, so that only the sizes are comparable.
    assert len(ours) == pytest.approx(len(theirs), rel=0.05)


def test_an_unknown_ending_is_refused(cross: Plan, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="parquet"):
        cross.export(tmp_path / "plan.docx")
