"""How a plate bends: as the command says, symmetric where the part is, and in proportion to the shrinkage."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Command, box

import beadwright
from beadwright import BeadwrightError, Plan

ROUGH = {"voxel": 8.0, "voxel_height": 4.0, "steps_at_most": 4}


@pytest.fixture(scope="module")
def wall() -> Plan:
    return beadwright.plan(box(80, 20, 8, centre=True), "cmt-steel-abb", strategy="contour")


def test_the_plate_bends_as_the_command_says(wall: Plan, command: Command, tmp_path: Path) -> None:
    bent = beadwright.distort(wall, **ROUGH)  # type: ignore[arg-type]
    assert bent.lift > 0 and bent.deviation > 0 and bent.eccentricity > 0
    wall.save(tmp_path, deposit=False, allow_findings=True)
    rough = ["--voxel", 8, "--voxel-height", 4, "--steps", 4]
    # plan.json rounds, and rough voxels take a bead or leave it.
    said = json.loads(command("distort", tmp_path / "plan.json", *rough, "--json").stdout)
    assert said["released"]["lift"]["largest"] == pytest.approx(bent.lift, rel=1e-2)
    assert said["eccentricity"]["score"]["mean"] == pytest.approx(bent.eccentricity, rel=1e-2)


def test_all_moves_in_proportion_to_the_shrinkage(wall: Plan) -> None:
    once, twice = (beadwright.distort(wall, calibration=factor, **ROUGH) for factor in (0.5, 1.0))  # type: ignore[arg-type]
    (places, moved), (same, more) = once.shape(), twice.shape()
    assert np.array_equal(places, same)
    assert np.abs(2 * moved - more).max() < 1e-6 * np.abs(more).max()
    # The figures are those of the shape.
    assert places.shape == moved.shape and places.shape[1] == 3
    assert once.shape(released=False).moved.shape == moved.shape
    # Opened clamps let the plate go.
    ranges = [once.values[state]["lift"]["range"] for state in ("clamped", "released")]
    assert ranges[0] < ranges[1]


def test_what_cannot_be_computed_is_refused(wall: Plan) -> None:
    with pytest.raises(BeadwrightError, match="clamps"):
        beadwright.distort(wall, clamps="glue")  # type: ignore[arg-type]
    with pytest.raises(BeadwrightError, match="calibration"):
        beadwright.distort(wall, calibration=1000.0)
    with pytest.raises(BeadwrightError, match="at least one step"):
        beadwright.distort(wall, steps_at_most=0)


def test_its_page_shows_the_bent_body(wall: Plan) -> None:
    page = beadwright.distort(wall, **ROUGH).html()  # type: ignore[arg-type]
    assert 'class="card bent"' in page and "released" in page
