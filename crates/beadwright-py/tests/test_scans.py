"""A scan's distances are those that were put in, corrected layers make up for them, and programs with a danger are found."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Array, Command, box, write_stl

import beadwright
from beadwright import BeadwrightError, Noise, Part, Plan


def raised_box(off: float, step: float = 2.0) -> Array:
    """Points on the top and the sides of a box of 60 x 40 x 20 mm, that far outside it."""
    x, y = np.arange(1.0, 60.0, step), np.arange(1.0, 40.0, step)
    z = np.arange(2.0, 20.0, step)
    top = np.stack([*np.meshgrid(x, y), np.full((len(y), len(x)), 20.0 + off)], -1).reshape(-1, 3)
    side = np.stack([np.full((len(z), len(y)), 60.0 + off), *np.meshgrid(y, z)], -1).reshape(-1, 3)
    return np.vstack([top, side])


@pytest.mark.parametrize("off", [0.3, -0.2])
def test_points_lie_as_far_from_the_part_as_they_were_put(off: float, tmp_path: Path) -> None:
    part, points = box(60, 40, 20), raised_box(off)
    found = beadwright.deviation(part, points, allowance=1.0)
    assert found.distances == pytest.approx(off, abs=1e-9)
    assert found.figures["mean"] == pytest.approx(off)
    assert found.figures["within" if off > 0 else "below"] == pytest.approx(1.0)
    assert found.doubts == []
    # The same from a file in another unit.
    np.savetxt(tmp_path / "scan.xyz", points / 10)
    read = beadwright.deviation(part, tmp_path / "scan.xyz", units="cm", allowance=1.0)
    assert read.figures["mean"] == pytest.approx(off, abs=1e-6)


def test_a_plan_lies_on_its_part(command: Command, tmp_path: Path) -> None:
    part = box(60, 40, 20)
    plan = beadwright.plan(part, strategy="contour")
    found = beadwright.deviation(part, plan)
    assert found.agreement is not None and found.agreement > 0.8
    write_stl(part, tmp_path / "part.stl")
    plan.save(tmp_path / "out", deposit=False, allow_findings=True)
    said = command("deviation", tmp_path / "part.stl", tmp_path / "out/plan.json", "--units", "mm", "--json")
    assert json.loads(said.stdout)["built"]["agreement"] == pytest.approx(found.agreement)


def scan_of(plan: Plan, layer: int, raised: float) -> Array:
    """The top of a layer where its islands lie, that much too high, mm."""
    outline = plan.layers[layer].islands[0].outer
    low, high = outline.min(0), outline.max(0)
    grid = np.stack(np.meshgrid(*(np.arange(low[k], high[k], 1.0) for k in (0, 1))), -1).reshape(-1, 2)
    # Even-odd rule, edge by edge.
    inside = np.zeros(len(grid), dtype=bool)
    for a, b in zip(outline, np.roll(outline, -1, 0), strict=True):
        crosses = (a[1] > grid[:, 1]) != (b[1] > grid[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            x = (b[0] - a[0]) * (grid[:, 1] - a[1]) / (b[1] - a[1]) + a[0]
        inside ^= crosses & (grid[:, 0] < x)
    top = plan.layers[layer].z + raised
    return np.column_stack([grid[inside], np.full(inside.sum(), top)])


def test_layers_that_follow_make_up_for_a_build_that_is_too_high(
    contours: Plan, command: Command, tmp_path: Path
) -> None:
    even = beadwright.adapt(contours, scan_of(contours, 3, 0.0), 4)
    high = beadwright.adapt(contours, scan_of(contours, 3, 0.6), 4)
    assert high.values["error"]["mean"] - even.values["error"]["mean"] == pytest.approx(0.6, abs=0.01)
    assert high.values["metal"][0] < even.values["metal"][0]
    assert len(high.layers) <= len(even.layers)
    written = high.save(tmp_path / "adapted", post="krl")
    assert {"adapt.html", "CROSS.src", "plan.json"} <= {path.name for path in written}
    # The command finds the same.
    contours.save(tmp_path / "out", deposit=False, allow_findings=True)
    np.savetxt(tmp_path / "scan.xyz", scan_of(contours, 3, 0.6), fmt="%.9f")
    said = command(
        "adapt", tmp_path / "out/plan.json", "--scan", tmp_path / "scan.xyz", "--after-layer", 4, "-o", tmp_path / "again", "--json"
    )
    values = json.loads(said.stdout)
    assert values["metal"] == pytest.approx(high.values["metal"], abs=1e-4)
    assert values["layers"] == len(high.layers)
    # plan.json rounds, so their numbers may differ in the last digit.
    ours, theirs = ((tmp_path / folder / "CROSS.src").read_text().splitlines() for folder in ("adapted", "again"))
    assert [line.split(" ")[0] for line in ours] == [line.split(" ")[0] for line in theirs]


def test_scans_that_cannot_be_true_are_refused(contours: Plan) -> None:
    with pytest.raises(BeadwrightError, match="mm apart"):
        beadwright.adapt(contours, scan_of(contours, 3, 25.0), 4)
    with pytest.raises(BeadwrightError, match="rows of three"):
        beadwright.adapt(contours, np.zeros((4, 2)), 4)
    with pytest.raises(BeadwrightError, match="layer 999 is not one of them"):
        beadwright.adapt(contours, scan_of(contours, 3, 0.0), 999)


def test_feedback_by_place_ends_nearer_to_the_plan_than_none(contours: Plan) -> None:
    built = beadwright.build(contours, seed=3)
    assert built.rms("place") < built.rms("none")
    assert built.values == beadwright.build(contours, seed=3, threads=1).values
    assert built.values != beadwright.build(contours, seed=4).values
    # Nothing goes wrong: a plan is built as it is, whatever is measured.
    quiet = Noise(passes=0.0, along=0.0, drift=0.0)
    even = beadwright.build(contours, ("none",), noise=quiet)
    assert even.rms("none") < built.rms("none")
    assert built.html().startswith("<!")
    with pytest.raises(BeadwrightError, match="correlation"):
        beadwright.build(contours, noise=Noise(correlation=0.0))


def test_what_goes_around_cannot_be_built_here() -> None:
    profile = beadwright.Profile("cmt-steel-robots").set({"layers.chart": "cylinder:axis=z,radius=20"})
    plan = beadwright.plan(Part.example("hub"), profile)
    with pytest.raises(BeadwrightError, match="unrolled layers"):
        beadwright.build(plan)


def test_a_rapid_move_with_the_arc_on_is_found() -> None:
    safe = "G21 G90\nG0 X0 Y0 Z10\nG1 Z2 F600\nM3\nG1 X100 F630\nM5\nG0 Z10\nM30\n"
    rapid = safe.replace("M5", "G0 X0\nM5")
    quiet, found = (beadwright.check(text, profile="plasma-304-cnc") for text in (safe, rapid))
    assert [fault.kind for fault in found] != [fault.kind for fault in quiet]
    new = next(fault for fault in found if fault.kind not in {each.kind for each in quiet})
    assert new.line == 6 and new.remedy
    assert str(new) == new.sentence


def test_a_notebook_shows_the_report(contours: Plan) -> None:
    page = contours.show(deposit=False)
    assert page.startswith("<!") and "cross" in page
    frame = page._repr_html_()
    assert frame.startswith("<iframe") and "<script" not in frame


def test_a_picture_of_heights_has_their_scale(contours: Plan) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    field = beadwright.height_field(contours, 0, 1.0)
    axes = field.show()
    mesh = axes.collections[0]
    assert mesh.get_array().max() == pytest.approx(field.heights.max())
    assert "mm" in axes.get_xlabel()
