"""What would be built: metal is conserved, and programs lay what their plan does."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Command, box, path_length

import beadwright
from beadwright import BeadwrightError, Part, Plan, Profile

LINES = """; two beads side by side
G21 G90
G0 X0 Y0 Z10
G1 Z2 F600
M3
G1 X100 F630
M5
G0 Z10
G0 X100 Y5
G1 Z2 F600
M3
G1 X0 F630
M5
G0 Z10
M30
"""


@pytest.mark.parametrize("layer", [0, 3])
def test_a_height_field_holds_the_metal_of_its_layer(contours: Plan, layer: int) -> None:
    field = beadwright.height_field(contours, layer, 0.25)
    process = Profile(contours.profile)
    # Wire that goes in, for the time that the torch takes.
    rate = np.pi / 4 * process["wire.diameter"] ** 2 * process["process.wire_feed_speed"] * 1e3 / 60
    times = (
        np.linalg.norm(np.diff(np.vstack([each.points, each.points[:1]]), axis=0), axis=1)[: None if each.closed else -1]
        / each.pace[: None if each.closed else -1]
        for each in contours.layers[layer].passes
    )
    metal = sum(float(time.sum()) for time in times) * rate * process["process.efficiency"]
    assert field.heights.sum() * 0.25**2 == pytest.approx(metal, rel=0.02)
    assert field.heights.shape == (len(field.y), len(field.x))
    assert np.diff(field.x) == pytest.approx(0.25)


def test_a_layer_that_is_not_there(contours: Plan) -> None:
    with pytest.raises(BeadwrightError, match="there is no layer 999"):
        beadwright.height_field(contours, 999)


@pytest.mark.parametrize("dialect", ["krl"])
def test_a_program_builds_what_its_plan_does(contours: Plan, dialect: str) -> None:
    planned = beadwright.simulate(contours)
    files = contours.post(dialect)
    read = beadwright.simulate(files["CROSS.src"], modules=files, part=Part.example("cross"))
    assert read.totals["arc_starts"] == planned.totals["arc_starts"]
    assert read.totals["deposited_length_mm"] == pytest.approx(planned.totals["deposited_length_mm"], rel=1e-3)
    assert read.row["void %"] == pytest.approx(planned.row["void %"], abs=0.2)


def test_a_program_in_a_folder_finds_its_modules(contours: Plan, tmp_path: Path) -> None:
    contours.save(tmp_path, deposit=False)
    read = beadwright.simulate(tmp_path / "CROSS.src")
    assert read.totals["arc_starts"] == contours.metrics["arc_starts"]


def test_a_missing_module_is_named(contours: Plan) -> None:
    main = contours.post()["CROSS.src"]
    with pytest.raises(BeadwrightError, match="CROSS_L001"):
        beadwright.simulate(main)


def test_two_lines_of_g_code_have_their_length() -> None:
    judged = beadwright.simulate(LINES, profile="plasma-304-cnc", arc_on=["M3"], arc_off=["M5"])
    assert judged.totals["arc_starts"] == 2
    assert judged.totals["deposited_length_mm"] == pytest.approx(200)


def test_a_program_without_arc_says_so() -> None:
    with pytest.raises(BeadwrightError, match="arc"):
        beadwright.simulate("G21 G90\nG0 X0 Y0\nG0 X10\n", profile="plasma-304-cnc")


def test_a_printers_program_needs_the_profile_of_its_bead() -> None:
    printed = "G21\nG90\nM83\nG1 Z0.2 F600\nG1 X0 Y0\nG1 X50 E2 F1800\nG1 Y50 E2\n"
    with pytest.raises(BeadwrightError, match="printer's program"):
        beadwright.simulate(printed)
    judged = beadwright.simulate(printed, profile="fdm-abs-0.4")
    assert judged.totals["deposited_length_mm"] == pytest.approx(100)


def test_a_comparison_has_a_row_for_each_plan() -> None:
    part = box(60, 40, 6)
    compared = beadwright.compare(part, strategies=["contour", "zigzag"], grid=0.5)
    assert [judged.name for judged in compared] == ["contour", "zigzag"]
    for judged in compared:
        plan = beadwright.plan(part, strategy=judged.name)
        assert judged.totals["arc_starts"] == plan.metrics["arc_starts"]
        assert judged.totals["deposited_length_mm"] == pytest.approx(sum(each.length for each in plan.passes))
        assert len(judged.values["layers"]) == len(plan.layers)
    assert compared.best.row["score"] == min(compared.table()["score"])
    assert "<table>" in compared._repr_html_()
    assert compared.html().startswith("<!")


def test_only_chosen_layers_are_judged() -> None:
    [judged] = beadwright.compare(box(60, 40, 10), strategies=["contour"], layers=[1, 3], grid=0.5)
    assert [layer["index"] for layer in judged.values["layers"]] == [1, 3]


@pytest.mark.parametrize("grid", [0.0, 1e-3, 1e4])
def test_a_grid_that_cannot_be(grid: float) -> None:
    with pytest.raises(BeadwrightError, match="grid"):
        beadwright.simulate(beadwright.plan(box(120, 120, 4)), grid=grid)


def test_the_command_judges_alike(contours: Plan, command: Command, tmp_path: Path) -> None:
    contours.save(tmp_path, deposit=False)
    done = command("simulate", tmp_path / "plan.json", "--grid", 0.5, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    theirs, ours = json.loads(done.stdout), beadwright.simulate(contours, grid=0.5)
    assert ours.totals["deposited_length_mm"] == pytest.approx(theirs["totals"]["deposited_length_mm"], rel=1e-6)
    assert path_length(contours.passes[0].points, contours.passes[0].closed) > 0
    for name, value in theirs["deposit"].items():
        if isinstance(value, float):
            assert ours.deposit[name] == pytest.approx(value, rel=1e-2, abs=1e-2), name
