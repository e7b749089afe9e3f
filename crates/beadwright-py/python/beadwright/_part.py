"""The part that is planned."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

from beadwright import _core
from beadwright._array import floats, indices
from beadwright._errors import BeadwrightError
from beadwright._profile import Profile

if TYPE_CHECKING:
    import numpy.typing as npt

    from beadwright._array import Floats, Indices

Unit: TypeAlias = Literal["mm", "cm", "m", "in"]
Stand: TypeAlias = Literal["flat", "orient"]
StrPath: TypeAlias = str | os.PathLike[str]
Turn: TypeAlias = tuple[float, float, float]
Shift: TypeAlias = tuple[float, float]


class Part:
    """A solid, or a wall given by curves, in mm and set on z = 0. Made by :meth:`read` and its siblings."""

    __slots__ = ("_inner", "_maker")
    _inner: _core.Part
    _maker: tuple[Any, ...]

    def __init__(self) -> None:
        raise TypeError("a part is made by Part.read, Part.from_triangles or Part.from_trimesh")

    @classmethod
    def _made(cls, maker: tuple[Any, ...]) -> Part:
        """The part of a call of the core, which is kept: a part travels to other processes as that call."""
        part = object.__new__(cls)
        kind, *arguments = maker
        part._inner = _core.Part.read(*arguments) if kind == "read" else _triangles(*arguments)
        part._maker = maker
        return part

    @classmethod
    def read(
        cls,
        path: StrPath,
        *,
        units: Unit | None = None,
        scale: float = 1.0,
        turn: Turn = (0.0, 0.0, 0.0),
        centre: bool = False,
        shift: Shift = (0.0, 0.0),
        stand: Stand | None = None,
        height: float | None = None,
        accept_damaged: bool = False,
    ) -> Part:
        """Reads STL, 3MF, OBJ, PLY, AMF, IGES (centre-lines of walls), DXF or SVG (outlines); the content decides.

        ``units`` of the file are guessed where they are left out; ``scale`` enlarges the part, ``turn`` turns it about x,
        then y, then z (°), ``centre`` moves its middle to x = y = 0, and ``shift`` then moves it along x and y (mm).
        ``stand="flat"`` lays it onto its largest flat face, ``"orient"`` onto that with the least overhang. Curves and
        outlines grow up to ``height`` (mm). From a file that ends too early, ``accept_damaged`` uses the triangles that it has.

        Raises :class:`BeadwrightError` with the path, the line where there is one, and what helps.
        """
        path = Path(path)
        try:
            content = path.read_bytes()
        except OSError as error:
            raise BeadwrightError(f"{path} cannot be read: {error.strerror}.", str(path)) from error
        placing = _placing(units, scale, turn, centre, shift, stand, height)
        return cls._made(("read", path.stem, str(path), content, accept_damaged, placing))

    @classmethod
    def example(cls, name: str) -> Part:
        """One of the parametric example parts, such as ``"propeller"``; :func:`examples` names them all."""
        placing = _placing(None, 1.0, (0.0, 0.0, 0.0), False, (0.0, 0.0), None, None)
        return cls._made(("read", name, name, _core.example_stl(name), False, placing))

    @classmethod
    def from_triangles(
        cls,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        name: str = "part",
        units: Unit = "mm",
        scale: float = 1.0,
        turn: Turn = (0.0, 0.0, 0.0),
        centre: bool = False,
        shift: Shift = (0.0, 0.0),
        stand: Stand | None = None,
    ) -> Part:
        """A solid from ``vertices`` (n × 3, in ``units``) and ``faces`` (m × 3, indices from 0, counter-clockwise seen from
        outside). It is mended as a file would be.

        Raises :class:`BeadwrightError` for other shapes, and for indices or coordinates that are impossible.
        """
        import numpy as np

        corners, triangles = np.asarray(vertices, dtype=np.float64), np.asarray(faces)
        for what, array in [("vertices", corners), ("faces", triangles)]:
            if array.ndim != 2 or array.shape[1] != 3:
                raise BeadwrightError(f"{what} have the shape {array.shape}; rows of three are expected.", what)
        if not np.issubdtype(triangles.dtype, np.integer) or triangles.min(initial=0) < 0:
            raise BeadwrightError("faces are indices of vertices: whole numbers from 0 up.", "faces")
        if triangles.max(initial=0) >= len(corners):
            raise BeadwrightError(f"a face names vertex {triangles.max()}; there are {len(corners)}.", "faces")
        placing = _placing(units, scale, turn, centre, shift, stand, None)
        indexed = np.ascontiguousarray(triangles, dtype=np.uint32)
        return cls._made(("triangles", name, np.ascontiguousarray(corners).tobytes(), indexed.tobytes(), placing))

    @classmethod
    def from_trimesh(cls, mesh: Any, *, name: str = "part", turn: Turn = (0.0, 0.0, 0.0)) -> Part:
        """A solid from a ``trimesh.Trimesh``; its units are taken where it has some, mm otherwise."""
        known: dict[str, Unit] = {"millimeters": "mm", "centimeters": "cm", "meters": "m", "inches": "in"}
        named = str(mesh.units or "mm")
        units = known.get(named, cast(Unit, named))
        return cls.from_triangles(mesh.vertices, mesh.faces, name=name, units=units, turn=turn)

    @classmethod
    def from_pyvista(cls, surface: Any, *, name: str = "part", units: Unit = "mm") -> Part:
        """A solid from a ``pyvista.PolyData``, whose faces are cut into triangles."""
        surface = surface.triangulate()
        return cls.from_triangles(surface.points, surface.faces.reshape(-1, 4)[:, 1:], name=name, units=units)

    def above(self, z: float) -> Part:
        """What lies above the height ``z`` (mm), set on z = 0."""
        part = object.__new__(Part)
        part._inner = self._inner.above(z)
        part._maker = ("above", self._maker, z)
        return part

    def preform(self, profile: Profile | StrPath = "cmt-al2319-kuka") -> Part:
        """The solid plus the stock that is milled off afterwards, by the section ``[preform]`` of a profile; it is planned like any part.

        Raises :class:`BeadwrightError` for a wall given by curves, and for a surface that is not closed.
        """
        wanted = profile if isinstance(profile, Profile) else Profile(profile)
        part = object.__new__(Part)
        part._inner = self._inner.preform(wanted._inner)
        part._maker = ("preform", self._maker, wanted.key)
        return part

    def directions(
        self, profile: Profile | StrPath = "cmt-al2319-kuka", *, lean: float = 45.0, tilt: float = 90.0
    ) -> list[dict[str, Any]]:
        """Ways to divide the solid into bodies, each built in a direction of its own, so that as little as possible overhangs: those that
        can be welded first, at last the whole of it in level layers.

        Each has ``bodies`` (for ``profile.set({"layers.bodies": ...})``), ``overhang`` (the area that leans by more than ``lean`` degrees
        from the direction in which it is built, mm²), ``tilt`` (the largest angle between a direction and the vertical, at most ``tilt``
        degrees: what the positioner can tilt), and ``lean``, which is ``None`` unless a tube has no better layers than those from which its
        walls lean by that many degrees. Each is planned for trial: ``metrics`` are those of its plan, ``refused`` is the reason why it cannot be
        welded. Both are ``None`` for level layers if another way can be welded.

        Raises :class:`BeadwrightError` for a wall given by curves, and for angles out of range.
        """
        for what, angle, most in [("lean", lean, 80.0), ("tilt", tilt, 180.0)]:
            if not 5.0 <= angle <= most:
                raise BeadwrightError(f"{what} = {angle}: an angle of 5 to {most:.0f} degrees is expected.", what)
        wanted = profile if isinstance(profile, Profile) else Profile(profile)
        return self._inner.directions(wanted._inner, lean, tilt)

    @property
    def figures(self) -> dict[str, Any] | None:
        """Mass, time and cost of a preform (kg, hours, the currency of the profile); ``None`` for a part as it is drawn."""
        return self._inner.figures

    @property
    def milled_faces(self) -> list[dict[str, Any]]:
        """The faces of the part that is milled from a preform, the largest first: ``area`` (mm²), ``place`` (mm), ``normal``, and
        ``stock``, the least, mean and greatest thickness of the metal over it (mm). Empty for a part as it is drawn.
        """
        return self._inner.milled_faces

    @property
    def name(self) -> str:
        """The name for files and headings."""
        return self._inner.name

    @property
    def is_solid(self) -> bool:
        """Whether it is a solid; a wall given by curves is not."""
        return self._inner.is_solid

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Lowest and highest coordinates, mm."""
        (a, b, c), (d, e, f) = self._inner.bounds
        return (a, b, c), (d, e, f)

    @property
    def volume(self) -> float | None:
        """Volume of a solid, mm³; exact where its surface is closed."""
        return self._inner.volume

    @property
    def vertices(self) -> Floats:
        """Corners of the mended solid, n × 3, mm; not copied."""
        return floats(self._mesh(self._inner.vertices))

    @property
    def faces(self) -> Indices:
        """Its triangles, m × 3, as indices of corners; not copied."""
        return indices(self._mesh(self._inner.faces))

    def _mesh(self, array: _core.Array | None) -> _core.Array:
        if array is None:
            raise BeadwrightError(f"{self.name} is a wall given by curves, and has no triangles.", self.name)
        return array

    @property
    def notes(self) -> list[str]:
        """What was mended, and what is not read."""
        return self._inner.notes

    @property
    def key(self) -> str:
        """A key of the part's content: the same for the same bytes placed alike."""
        return hashlib.sha256(repr(self._maker).encode()).hexdigest()

    def to_trimesh(self) -> Any:
        """The mended solid as ``trimesh.Trimesh``, mm."""
        import trimesh

        return trimesh.Trimesh(self.vertices, self.faces, process=False)

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade, (self._maker,)

    def __repr__(self) -> str:
        low, high = self.bounds
        size = " × ".join(f"{b - a:.1f}" for a, b in zip(low, high, strict=True))
        return f"<Part {self.name}: {size} mm>"


def examples() -> list[str]:
    """Names of the example parts."""
    return _core.example_names()


def _placing(
    units: str | None,
    scale: float,
    turn: Turn,
    centre: bool,
    shift: Shift,
    stand: str | None,
    height: float | None,
) -> tuple[Any, ...]:
    if not 1e-6 <= scale <= 1e6:
        raise BeadwrightError(f"scale = {scale} is impossible; 1e-6 to 1e6 is possible.", "scale")
    if len(turn) != 3 or not all(abs(angle) < 1e6 for angle in turn):
        raise BeadwrightError(f"turn = {turn} is impossible: three angles in ° are expected, such as (90, 0, 0).", "turn")
    if len(shift) != 2 or not all(abs(length) <= 20_000 for length in shift):
        raise BeadwrightError(
            f"shift = {shift} is impossible: two lengths up to 20000 mm are expected, such as (250, -40).", "shift"
        )
    if stand not in (None, "flat", "orient"):
        raise BeadwrightError(f'stand = "{stand}" is unknown: "flat" and "orient" are known.', "stand")
    if height is not None and not 0.1 <= height <= 20_000:
        raise BeadwrightError(f"height = {height} is impossible; 0.1 to 20000 mm is possible.", "height")
    turned, shifted = tuple(float(angle) for angle in turn), tuple(float(length) for length in shift)
    return units, float(scale), turned, centre, shifted, stand, height


def _triangles(name: str, corners: bytes, triangles: bytes, placing: tuple[Any, ...]) -> _core.Part:
    return _core.Part.from_triangles(
        name, memoryview(corners).cast("d"), memoryview(triangles).cast("I"), placing
    )


def _remade(maker: tuple[Any, ...]) -> Part:
    if maker[0] == "above":
        return _remade(maker[1]).above(maker[2])
    if maker[0] == "preform":
        return _remade(maker[1]).preform(Profile(maker[2]))
    return Part._made(maker)
