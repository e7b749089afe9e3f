"""Heat is conserved, joints stay within reach, and a law that is fitted is found again."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Command, box

import beadwright
from beadwright import BeadLibrary, BeadwrightError, Plan, Profile


@pytest.fixture(scope="module")
def small() -> Plan:
    return beadwright.plan(box(60, 40, 6), strategy="contour")


def test_heat_is_conserved(small: Plan) -> None:
    heat = beadwright.heat(small)
    values = heat.values
    assert values["supplied"] == pytest.approx(values["lost"] + values["held"], rel=1e-3)
    assert [len(layer) for layer in heat.starts] == [len(layer.passes) for layer in small.layers]
    ambient = Profile(small.profile)["heat.ambient"]
    assert min(start for layer in heat.starts for start in layer) >= ambient - 1e-6


def test_temperatures_along_a_pass_are_not_copied(small: Plan) -> None:
    heat = beadwright.heat(small)
    along = heat.along(1, 0)
    assert along.ctypes.data == heat.along(1, 0).ctypes.data
    length = small.layers[1].passes[0].length
    assert len(along) == pytest.approx(length / heat.values["spacing"], abs=2)
    with pytest.raises(BeadwrightError, match="no pass"):
        heat.along(1, 999)


def test_a_limit_costs_time_and_holds(small: Plan) -> None:
    free, held = beadwright.heat(small), beadwright.heat(small, limit=60)
    assert max(start for layer in held.starts for start in layer) <= 60.5
    assert held.waits > 0
    assert held.seconds > free.seconds
    with pytest.raises(BeadwrightError, match="30 to 1500"):
        beadwright.heat(small, limit=25)


def test_heat_needs_its_sections() -> None:
    plan = beadwright.plan(box(20, 20, 2), Profile("fdm-abs-0.4"), strategy="contour")
    with pytest.raises(BeadwrightError, match="heat"):
        beadwright.heat(plan)


def test_a_robot_reaches_and_its_joints_are_steady(small: Plan) -> None:
    found = beadwright.reach(small, "kuka-kr20-r1810")
    assert found.reachable
    way = found.trajectory
    assert way is not None
    assert way.joints.shape == (len(way.seconds), 6)
    assert np.all(np.diff(way.seconds) > 0)
    assert np.abs(np.diff(way.joints, axis=0)).max() < 90, "no joint turns over between two points"


def test_a_part_too_far_away_is_out_of_reach(small: Plan) -> None:
    found = beadwright.reach(small, "ur5e", at=(5000, 0, 0))
    assert not found.reachable
    assert found.findings[0].fatal
    assert found.trajectory is None
    with pytest.raises(BeadwrightError, match="at = "):
        beadwright.reach(small, "ur5e", at=(1e9, 0, 0))


def test_the_command_reaches_alike(small: Plan, command: Command, tmp_path: Path) -> None:
    small.save(tmp_path, deposit=False)
    done = command("reach", tmp_path / "plan.json", "--cell", "abb-irb1410", "--json")
    theirs, ours = json.loads(done.stdout), beadwright.reach(small, "abb-irb1410").values
    assert ours["reachable"] == theirs["reachable"]
    assert ours["least_margin"] == pytest.approx(theirs["least_margin"], abs=0.01)


def test_an_unknown_cell_is_refused(small: Plan, tmp_path: Path) -> None:
    assert "ur5e" in beadwright.cells()
    with pytest.raises(BeadwrightError, match="ur5e"):
        beadwright.reach(small, "ur6e")
    with pytest.raises(BeadwrightError, match="cannot be read"):
        beadwright.reach(small, tmp_path / "cell.toml")


def law(current: float, speed: float) -> tuple[float, float]:
    """A bead that is linear in the coded inputs."""
    return 6 + 0.02 * (current - 120) - 0.3 * (speed - 8), 2.5 + 0.004 * (current - 120) - 0.1 * (speed - 8)


@pytest.fixture(scope="module")
def library() -> BeadLibrary:
    rows = [(c, v, *law(c, v)) for c in (90, 120, 150) for v in (6, 8, 10)]
    lines = [",".join(map(repr, map(float, row))) for row in rows]
    return BeadLibrary.fit("\n".join(["current_a,speed_mm_s,width_mm,height_mm", *lines]))


@pytest.mark.parametrize(("current", "speed"), [(90, 6), (113, 7.25), (149, 9.9)])
def test_a_law_is_found_again(library: BeadLibrary, current: float, speed: float) -> None:
    bead = library.predict(current=current, **{next(n["name"] for n in library.values["inputs"][1:]): speed})
    assert (bead.width, bead.height) == pytest.approx(law(current, speed), rel=1e-9)


def test_a_wanted_bead_is_found_within_the_limits(library: BeadLibrary) -> None:
    wished = library.predict({name["name"]: value for name, value in zip(library.values["inputs"], (130, 7), strict=True)})
    found = library.solve(width=wished.width, layer_height=wished.layer_height, limits={"current": (100, 140)})
    assert found.width == pytest.approx(wished.width, rel=0.006)
    assert found.layer_height == pytest.approx(wished.layer_height, rel=0.006)
    assert 100 <= found.parameters["current"] <= 140


def test_outside_the_measurements_nothing_is_predicted(library: BeadLibrary) -> None:
    first, second = (each["name"] for each in library.values["inputs"])
    with pytest.raises(BeadwrightError):
        library.predict({first: 500, second: 8})
    with pytest.raises(BeadwrightError):
        library.solve(width=60, layer_height=2)
    with pytest.raises(BeadwrightError, match="overlap"):
        library.predict({first: 120, second: 8}, overlap="wide")


def test_a_library_is_written_and_read(library: BeadLibrary, tmp_path: Path) -> None:
    library.write(tmp_path / "beads.toml")
    again = BeadLibrary.read(tmp_path / "beads.toml")
    assert again.values == library.values
    assert again._repr_svg_().startswith("<svg")


def test_a_broken_table_names_its_line() -> None:
    with pytest.raises(BeadwrightError, match="line 3"):
        BeadLibrary.fit("current_a,width_mm,height_mm\n100,5,2\n110,wide,2\n")


def test_the_demonstration_says_that_it_is_one() -> None:
    assert BeadLibrary.fit(beadwright.demonstration_csv()).values["synthetic"]
