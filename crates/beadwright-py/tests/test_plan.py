"""Plans: areas, volumes and lengths that are known, and arrays that are the library's own memory."""

from __future__ import annotations

import gc
import hashlib
import json
import pickle
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pytest
from conftest import box, path_length, polygon, prism, shoelace, stl

import beadwright
from beadwright import BeadwrightError, Part, Plan


@pytest.mark.parametrize(("x", "y", "z"), [(60, 40, 10), (35, 80, 6)])
def test_a_box_is_cut_into_rectangles(x: float, y: float, z: float) -> None:
    plan = beadwright.plan(box(x, y, z), strategy="contour")
    assert [layer.z for layer in plan.layers] == pytest.approx(np.arange(2, z + 1, 2))
    assert [layer.index for layer in plan.layers] == list(range(len(plan.layers)))
    for layer in plan.layers:
        assert layer.height == pytest.approx(2)
        assert layer.slice_area == pytest.approx(x * y, rel=1e-6)
        [island] = layer.islands
        assert shoelace(island.outer) == pytest.approx(x * y, rel=1e-6)
        assert not island.holes
    assert plan.metrics["part_volume_mm3"] == pytest.approx(x * y * z, rel=1e-6)
    assert plan.metrics["mesh_volume_mm3"] == pytest.approx(x * y * z)


def test_holes_count_against_the_area() -> None:
    outer, inner = prism(polygon(64, 40), 6), prism(polygon(64, 15), 6)
    corners = np.vstack([outer[0], inner[0]])
    # The wall of the hole looks inwards; its lids cancel where the slices are cut.
    faces = np.vstack([outer[1], inner[1][:, ::-1] + len(outer[0])])
    layer = beadwright.plan(Part.from_triangles(corners, faces), strategy="contour").layers[1]
    [island] = layer.islands
    [hole] = island.holes
    area = 32 * np.sin(2 * np.pi / 64) * (40**2 - 15**2)
    assert shoelace(island.outer) + shoelace(hole) == pytest.approx(area, rel=1e-5)
    assert shoelace(hole) < 0, "holes run clockwise"
    assert layer.slice_area == pytest.approx(area, rel=1e-5)


def test_lengths_are_those_of_the_points(contours: Plan) -> None:
    for each in contours.passes:
        assert each.length == pytest.approx(path_length(each.points, each.closed))
        assert len(each.width) == len(each.pace) == len(each.points)
    total = sum(each.length for each in contours.passes)
    assert contours.metrics["deposited_length_mm"] == pytest.approx(total), "the profile has no overlaps"
    assert contours.metrics["arc_starts"] == len(contours.passes)


def test_metrics_have_the_attributes_that_they_declare(cross: Plan) -> None:
    metrics = cross.metrics
    declared = get_type_hints(beadwright.Metrics)
    assert set(declared) == set(metrics) <= set(dir(metrics))
    for name, kind in declared.items():
        assert getattr(metrics, name) == metrics[name]
        assert isinstance(metrics[name], kind), name
    assert metrics.total_time_s > metrics.arc_time_s > 0
    assert pickle.loads(pickle.dumps(metrics)) == metrics
    assert json.loads(json.dumps(metrics)) == metrics
    with pytest.raises(AttributeError, match='no total "total_time"; use arc_starts, '):
        getattr(metrics, "total_time")  # noqa: B009


def test_metal_is_wire(contours: Plan) -> None:
    profile = beadwright.Profile(contours.profile)
    area = np.pi / 4 * profile["wire.diameter"] ** 2
    wire = contours.metrics["wire_length_m"] * 1e3 * area
    assert contours.metrics["wire_mass_kg"] == pytest.approx(wire * profile["wire.density"] / 1e6)


def test_torch_points_lie_at_the_top_of_their_layer_and_inside(contours: Plan) -> None:
    for layer in contours.layers:
        rings = np.vstack([island.outer for island in layer.islands])
        for each in layer.passes:
            assert np.allclose(each.points[:, 2], layer.z)
            assert np.all(each.points[:, :2] >= rings.min(axis=0) - 0.01)
            assert np.all(each.points[:, :2] <= rings.max(axis=0) + 0.01)


@pytest.mark.parametrize("strategy", ["contour", "zigzag", "loop"])
def test_arrays_are_the_librarys_own_memory(strategy: str) -> None:
    plan = beadwright.plan(Part.example("cross"), strategy=strategy)
    each = plan.layers[0].passes[0]
    for name in ["points", "width", "pace"]:
        array = getattr(each, name)
        assert array.ctypes.data == getattr(each._inner, name).address
        assert array.ctypes.data == getattr(each, name).ctypes.data, "asked twice, the memory is the same"
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    ring = plan.layers[0].islands[0].outer
    assert ring.ctypes.data == plan.layers[0]._inner.islands[0][0].address


def test_one_width_is_held_once() -> None:
    contours = beadwright.plan(Part.example("cross"), beadwright.Profile().set(layers__level=False), strategy="contour")
    widths = [each.width for each in contours.passes]
    constant = [width for width in widths if width.strides == (0,)]
    assert constant
    assert all(np.ptp(width) == 0 for width in constant)
    one = next(each for each in contours.passes if each.width.strides == (0,))
    with pytest.raises(BufferError):
        hashlib.sha256(one._inner.width)


def test_an_array_outlives_its_plan() -> None:
    plan = beadwright.plan(box(40, 30, 4), strategy="contour")
    points = plan.layers[1].passes[0].points
    kept = points.copy()
    del plan
    gc.collect()
    np.zeros(1_000_000)
    assert np.array_equal(points, kept)


@pytest.mark.parametrize("strategy", ["contour", "loop", "spiral"])
def test_a_quarter_turn_and_a_mirror_change_nothing(strategy: str) -> None:
    corners, faces = prism([(0, 0), (70, 0), (70, 30), (20, 45)], 6)
    as_is = beadwright.plan(Part.from_triangles(corners, faces), strategy=strategy)
    quarter = Part.from_triangles(corners, faces, turn=(0, 0, 90))
    mirrored = Part.from_triangles(corners * (-1, 1, 1), faces[:, ::-1])
    # `loop` searches on a lattice that is the same for all parts, and does not turn with them.
    near = 1e-2 if strategy == "loop" else 1e-3
    for other in [beadwright.plan(part, strategy=strategy) for part in (quarter, mirrored)]:
        for name in ["arc_starts", "deposited_length_mm", "part_volume_mm3"]:
            assert other.metrics[name] == pytest.approx(as_is.metrics[name], rel=near), name


def test_thin_walls_are_reported_with_their_place() -> None:
    corners, faces = prism([(0, 0), (60, 0), (60, 40), (0, 40)], 6)
    fin, more = prism([(100, 0), (101, 0), (101, 40), (100, 40)], 6)
    part = Part.from_triangles(np.vstack([corners, fin]), np.vstack([faces, more + len(corners)]))
    plan = beadwright.plan(part, strategy="contour")
    [warning] = [warning for warning in plan.warnings if warning.kind == "island-too-small"]
    assert warning.layers == [(0, 2)]
    assert warning.count == 3
    assert warning.total == pytest.approx(3 * 40)
    assert 100 <= warning.place[0] <= 101
    assert "narrower bead" in warning.remedy
    assert warning.sentence.endswith(warning.remedy)


def test_the_strategy_takes_the_place_of_the_profiles(contours: Plan, cross: Plan) -> None:
    assert contours.strategy == "contour"
    assert cross.strategy == "loop"
    assert {each.kind for each in contours.passes} == {"contour"}


def test_an_unknown_strategy_is_refused() -> None:
    with pytest.raises(BeadwrightError, match="zigzag"):
        beadwright.plan(box(40, 30, 4), strategy="zigzaq")


def test_a_part_too_small_for_millimetres_is_refused() -> None:
    with pytest.raises(BeadwrightError, match="mm") as caught:
        beadwright.plan(Part.from_triangles(*prism([(0, 0), (3, 0), (3, 2), (0, 2)], 1)))
    assert caught.value.place is not None


def test_a_file_in_inches_asks_for_its_unit(tmp_path: Path) -> None:
    path = tmp_path / "inch.stl"
    path.write_bytes(stl(*prism([(0, 0), (3, 0), (3, 2), (0, 2)], 1)))
    with pytest.raises(BeadwrightError, match='units="in"'):
        beadwright.plan(path)
    assert beadwright.plan(Part.read(path, units="in"), strategy="contour").layers


@pytest.mark.parametrize("threads", [0, 5000])
def test_threads_that_cannot_be(threads: int) -> None:
    with pytest.raises(BeadwrightError, match="1 to 1024"):
        beadwright.plan(box(40, 30, 4), threads=threads)


def test_a_layer_is_a_picture(contours: Plan) -> None:
    picture = ElementTree.fromstring(contours.layers[0].svg("One & only"))
    assert picture.tag.endswith("svg")
    assert picture[0].text == "One & only"
    assert contours.layers[0]._repr_svg_().startswith("<svg")


def test_a_plan_is_a_page(contours: Plan) -> None:
    page = contours._repr_html_()
    assert ElementTree.fromstring(f"<div>{page}</div>") is not None
    assert f"{contours.metrics['arc_starts']}</td>" in page


def test_a_table_holds_every_piece(contours: Plan) -> None:
    pytest.importorskip("pyarrow")
    table = contours.table()
    columns = {name: table[name].to_numpy() for name in table.schema.names if name != "kind"}
    ends = [np.column_stack([columns[f"{axis}{end} (mm)"] for axis in "xyz"]) for end in (0, 1)]
    lengths = np.linalg.norm(ends[1] - ends[0], axis=1)
    assert lengths.sum() == pytest.approx(contours.metrics["deposited_length_mm"])
    assert np.allclose(columns["time (s)"], lengths / columns["speed (mm/s)"])


def test_pyvista_and_trimesh_get_the_beads(contours: Plan) -> None:
    pyvista, trimesh = pytest.importorskip("pyvista"), pytest.importorskip("trimesh")
    lines = contours.to_pyvista()
    assert isinstance(lines, pyvista.PolyData)
    assert lines.compute_cell_sizes()["Length"].sum() == pytest.approx(contours.metrics["deposited_length_mm"])
    built = contours.to_trimesh()
    assert isinstance(built, trimesh.Trimesh)
    assert built.bounds[1][2] == pytest.approx(contours.layers[-1].z, abs=1.0)


def test_findings_are_those_of_metrics_json(tmp_path: Path) -> None:
    profile = beadwright.Profile("cmt-al2319-kuka").set({"check.max_void": 0.01})
    plan = beadwright.plan(Part.example("cross"), profile, strategy="contour")
    plan.save(tmp_path / "out")
    written = json.loads((tmp_path / "out" / "metrics.json").read_text())["findings"]
    ours = plan.findings()
    assert [(each.kind, each.severity, each.count, each.text) for each in ours] == [
        (each["kind"], each["severity"], each["count"], each["text"]) for each in written
    ]
    assert "void" in [each.kind for each in ours]
    order = [["serious", "doubt", "note"].index(each.severity) for each in ours]
    assert order == sorted(order)
    assert all(str(each) == f"{each.text} {each.remedy}".strip() for each in ours)
