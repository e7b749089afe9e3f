"""Parts: volumes, places, units, and what is refused."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import box, polygon, prism, stl

from beadwright import BeadwrightError, Part, Profile, examples, plan


@pytest.mark.parametrize(("x", "y", "z"), [(30, 20, 10), (100, 7.5, 2), (12.5, 12.5, 250)])
def test_a_box_has_the_volume_of_a_box(x: float, y: float, z: float) -> None:
    part = box(x, y, z)
    assert part.volume == pytest.approx(x * y * z)
    assert part.bounds == ((0, 0, 0), (x, y, z))
    assert part.is_solid


@pytest.mark.parametrize("sides", [3, 6, 64])
def test_a_prism_has_the_volume_of_a_prism(sides: int) -> None:
    part = Part.from_triangles(*prism(polygon(sides, 40), 15))
    assert part.volume == pytest.approx(sides / 2 * 40**2 * np.sin(2 * np.pi / sides) * 15)


@pytest.mark.parametrize(
    ("turn", "size"), [((90, 0, 0), (30, 10, 20)), ((0, 90, 0), (10, 20, 30)), ((0, 0, 90), (20, 30, 10))]
)
def test_a_turn_exchanges_the_sides(turn: tuple[float, float, float], size: tuple[float, float, float]) -> None:
    part = box(30, 20, 10, turn=turn)
    low, high = part.bounds
    assert np.subtract(high, low) == pytest.approx(size)
    assert low[2] == pytest.approx(0)
    assert part.volume == pytest.approx(6000)


@pytest.mark.parametrize("angle", [13, 45, 71])
def test_a_turn_about_the_vertical_keeps_the_volume_and_grows_the_extent(angle: float) -> None:
    low, high = box(30, 20, 10, turn=(0, 0, angle)).bounds
    a = np.radians(angle)
    expected = (30 * np.cos(a) + 20 * np.sin(a), 30 * np.sin(a) + 20 * np.cos(a), 10)
    assert np.subtract(high, low) == pytest.approx(expected)


def test_scale_and_units_enlarge() -> None:
    assert box(30, 20, 10, scale=2.0).volume == pytest.approx(8 * 6000)
    assert box(3, 2, 1, units="in").volume == pytest.approx(6 * 25.4**3)
    assert box(3, 2, 1, units="cm").volume == pytest.approx(6000)


def test_the_middle_comes_to_the_origin() -> None:
    assert box(30, 20, 10, centre=True).bounds == ((-15, -10, 0), (15, 10, 10))


@pytest.mark.parametrize("placing", [{}, {"centre": True}, {"turn": (0, 0, 37)}, {"turn": (90, 0, 0), "stand": "flat"}])
@pytest.mark.parametrize("shift", [(250, -40), (-7.25, 0), (0, 0)])
def test_a_shift_moves_the_part_after_all_else(placing: dict[str, object], shift: tuple[float, float]) -> None:
    (a, b, c), (d, e, f) = box(30, 20, 10, **placing).bounds
    low, high = box(30, 20, 10, shift=shift, **placing).bounds
    assert low == pytest.approx((a + shift[0], b + shift[1], c))
    assert high == pytest.approx((d + shift[0], e + shift[1], f))


def test_a_part_is_laid_flat() -> None:
    low, high = box(30, 20, 10, turn=(90, 0, 0), stand="flat").bounds
    assert high[2] - low[2] == pytest.approx(10), "its largest face lies below"


def test_what_lies_above_a_plane() -> None:
    upper = box(30, 20, 10).above(4)
    assert upper.volume == pytest.approx(30 * 20 * 6)
    assert upper.bounds[0][2] == pytest.approx(0)
    with pytest.raises(BeadwrightError, match="10.00 mm high"):
        box(30, 20, 10).above(11)


def test_a_preform_holds_its_part_with_stock() -> None:
    profile = Profile().set({"preform.side": 3, "preform.top": 2, "preform.bottom": 1, "preform.cut_height": 4})
    part = box(60, 40, 20)
    preform = part.preform(profile)
    (a, b, c), (d, e, f) = preform.bounds
    assert (d - a, e - b, f - c) == pytest.approx((66, 46, 27), abs=1.1), "steps of half a layer"
    assert part.figures is None and part.milled_faces == []
    assert preform.figures["preform_kg"] > preform.figures["part_kg"]  # type: ignore[index]
    faces = preform.milled_faces
    assert [round(face["area"]) for face in faces] == [2400, 2400, 1200, 1200, 800, 800]
    assert all(face["stock"][0] > 0.9 for face in faces)
    sides = [face["stock"][1] for face in faces if abs(face["normal"][2]) < 0.1]
    assert sides == pytest.approx([3] * 4, abs=0.01)
    assert plan(preform, profile).metrics["milled_part_volume_mm3"] == pytest.approx(60 * 40 * 20)


def test_an_arm_that_overhangs_is_a_body_of_its_own() -> None:
    # A post of 40 × 40 mm, with an arm of 90 mm at 60 mm above the plate; all of it is seen from the corner between them.
    outline = [(20, 60), (110, 60), (110, 90), (-20, 90), (-20, 0), (20, 0)]
    part = Part.from_triangles(*prism(np.array(outline, dtype=float), 40), turn=(90, 0, 0))
    profile = Profile("cmt-steel-abb")
    *divided, level = part.directions(profile)
    best = divided[0]
    assert level["overhang"] == pytest.approx(90 * 40, rel=0.05) and len(level["bodies"]) == 1
    assert best["overhang"] < 36 and len(best["bodies"]) == 2
    assert best["refused"] is None and best["metrics"]["layers"] > 60
    assert level["metrics"] is None and level["refused"] is None, "not needed"
    assert all(found["tilt"] <= 30 for found in part.directions(profile, tilt=30))
    welded = plan(part, profile.set({"layers.bodies": best["bodies"]}))
    assert any("welded as 2 bodies" in note for note in welded.notes)
    assert welded.metrics["arc_starts"] == best["metrics"]["arc_starts"]
    with pytest.raises(BeadwrightError, match="5 to 80 degrees"):
        part.directions(profile, lean=90)


def test_a_file_and_its_triangles_are_the_same_part(tmp_path: Path) -> None:
    corners, faces = prism(polygon(6, 32), 16)
    corners = corners.astype(np.float32).astype(np.float64)
    path = tmp_path / "six.stl"
    path.write_bytes(stl(corners, faces))
    part = Part.read(path)
    assert part.name == "six"
    assert part.volume == pytest.approx(Part.from_triangles(corners, faces).volume, rel=1e-12)


def test_triangles_are_the_librarys_own_memory() -> None:
    part = box(30, 20, 10)
    corners, faces = part.vertices, part.faces
    assert corners.shape == (8, 3)
    assert faces.shape == (12, 3)
    assert corners.ctypes.data == part._inner.vertices.address  # type: ignore[union-attr]
    assert faces.ctypes.data == part._inner.faces.address  # type: ignore[union-attr]
    assert not corners.flags.writeable
    a, b, c = (corners[faces[:, k]] for k in range(3))
    assert np.sum(a * np.cross(b, c)) / 6 == pytest.approx(part.volume), "the divergence theorem"


def test_a_part_travels_to_another_process() -> None:
    for part in [box(30, 20, 10), Part.example("gear"), box(30, 20, 10).above(3), box(30, 20, 10).preform()]:
        again = pickle.loads(pickle.dumps(part))
        assert again.key == part.key
        assert np.array_equal(again.vertices, part.vertices)
    assert box(30, 20, 10).key != box(30, 20, 11).key
    assert box(30, 20, 10).key != box(30, 20, 10, turn=(0, 0, 1)).key
    assert box(30, 20, 10).key != box(30, 20, 10, shift=(0, 1)).key


@pytest.mark.parametrize("name", ["cross", "propeller", "vase"])
def test_examples_are_parts(name: str) -> None:
    assert name in examples()
    assert (Part.example(name).volume or 0) > 0


def test_an_example_is_the_file_that_the_command_writes() -> None:
    root = Path(__file__).resolve().parents[3]
    assert np.array_equal(Part.example("propeller").vertices, Part.read(root / "examples" / "propeller.stl").vertices)


def test_a_drawing_grows_to_its_height(tmp_path: Path) -> None:
    path = tmp_path / "plate.svg"
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
                    '<path d="M5 5H55V35H5Z"/></svg>')
    part = Part.read(path, height=8.0)
    assert part.volume == pytest.approx(50 * 30 * 8, rel=1e-6)
    with pytest.raises(BeadwrightError) as caught:
        Part.read(path)
    assert caught.value.remedy == "height=… sets it, in mm."


def test_trimesh_goes_in_and_out() -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=25)
    part = Part.from_trimesh(mesh)
    assert part.volume == pytest.approx(mesh.volume)
    assert part.to_trimesh().is_watertight
    mesh.units = "inches"
    assert Part.from_trimesh(mesh).volume == pytest.approx(mesh.volume * 25.4**3)


def test_pyvista_goes_in() -> None:
    pyvista = pytest.importorskip("pyvista")
    cube = pyvista.Cube(x_length=30, y_length=20, z_length=10)
    assert Part.from_pyvista(cube).volume == pytest.approx(6000)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(BeadwrightError, match="cannot be read") as caught:
        Part.read(tmp_path / "none.stl")
    assert caught.value.place == str(tmp_path / "none.stl")


def test_a_broken_line_is_named(tmp_path: Path) -> None:
    path = tmp_path / "broken.stl"
    path.write_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n")
    with pytest.raises(BeadwrightError) as caught:
        Part.read(path)
    assert caught.value.place == f"{path}, line 4"
    assert str(path) in str(caught.value)


def test_a_file_cut_short_is_refused_or_taken_as_it_is(tmp_path: Path) -> None:
    corners, faces = prism([(0, 0), (30, 0), (30, 20), (0, 20)], 10)
    path = tmp_path / "short.stl"
    path.write_bytes(stl(corners, faces)[:-20])
    with pytest.raises(BeadwrightError, match="accept_damaged=True"):
        Part.read(path)
    assert Part.read(path, accept_damaged=True).faces.shape[0] == 11


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        ([[0, 0], [1, 0]], [[0, 1, 1]], r"vertices have the shape \(2, 2\)"),
        ([[0, 0, 0]], [[0, 0, 1]], "names vertex 1; there are 1"),
        ([[0, 0, 0]], [[0, 0, -1]], "whole numbers from 0 up"),
        ([[0, 0, 0]], [[0.0, 0.5, 0.0]], "whole numbers from 0 up"),
        ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], "corner 2 .* not a finite number"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], "nothing to build"),
    ],
)
def test_triangles_that_cannot_be(vertices: object, faces: object, message: str) -> None:
    with pytest.raises(BeadwrightError, match=message):
        Part.from_triangles(vertices, faces)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "placing",
    [
        {"units": "furlong"},
        {"scale": 0},
        {"turn": (1, 2)},
        {"shift": (1, 2, 3)},
        {"shift": (1e9, 0)},
        {"stand": "on its head"},
    ],
)
def test_a_placing_that_cannot_be(placing: dict[str, object]) -> None:
    with pytest.raises(BeadwrightError) as caught:
        box(30, 20, 10, **placing)
    assert caught.value.place == next(iter(placing))
