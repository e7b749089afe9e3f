"""Layers and their passes. Their numbers are those of the library: nothing is copied, nothing can be written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from beadwright import _core
from beadwright._array import floats

if TYPE_CHECKING:
    from beadwright._array import Floats


class Island(NamedTuple):
    """One area of a slice."""

    outer: Floats
    """Its outline, n × 2, mm, counter-clockwise; the first point is not repeated."""
    holes: list[Floats]
    """Its holes, clockwise."""


class Pass:
    """A path that is welded with the arc on."""

    __slots__ = ("_inner",)

    def __init__(self, core: _core.Pass) -> None:
        self._inner = core

    @property
    def kind(self) -> str:
        """What it is for: contour, infill, skeleton, wall or spot."""
        return self._inner.kind

    @property
    def closed(self) -> bool:
        """Whether it ends where it began; its first point is then not repeated."""
        return self._inner.closed

    @property
    def wait(self) -> float:
        """How long the torch waits before it, s."""
        return self._inner.wait

    @property
    def length(self) -> float:
        """Its length, mm."""
        return self._inner.length

    @property
    def points(self) -> Floats:
        """Where the torch goes, n × 3, mm; z is the top of the layer."""
        return floats(self._inner.points)

    @property
    def width(self) -> Floats:
        """Width of the bead from each point to the next, n, mm."""
        return floats(self._inner.width)

    @property
    def pace(self) -> Floats:
        """Speed at which the nominal wire feed lays the metal from each point to the next, n, mm/s."""
        return floats(self._inner.pace)

    def __repr__(self) -> str:
        return f"<Pass {self.kind}: {self.length:.1f} mm>"


class Layer:
    """A layer: the area of the part to be filled, and the passes that fill it."""

    __slots__ = ("_inner",)

    def __init__(self, core: _core.Layer) -> None:
        self._inner = core

    @property
    def index(self) -> int:
        """Its number, from 0."""
        return self._inner.index

    @property
    def z(self) -> float:
        """Its top, mm."""
        return self._inner.z

    @property
    def height(self) -> float:
        """Its thickness, mm."""
        return self._inner.height

    @property
    def slice_area(self) -> float:
        """Area of the slice, mm²."""
        return self._inner.slice_area

    @property
    def planned_area(self) -> float:
        """Area that beads cover, mm²."""
        return self._inner.planned_area

    @property
    def islands(self) -> list[Island]:
        """The slice."""
        return [Island(floats(outer), [floats(hole) for hole in holes]) for outer, holes in self._inner.islands]

    @property
    def passes(self) -> list[Pass]:
        """Its passes in the order in which they are welded."""
        return [Pass(core) for core in self._inner.passes]

    def svg(self, title: str | None = None) -> str:
        """Its picture."""
        return self._inner.svg(title or f"Layer {self.index + 1}, z {self.z:.2f} mm")

    def _repr_svg_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        return f"<Layer {self.index}: z {self.z:.2f} mm, {len(self._inner.passes)} passes>"


@dataclass(frozen=True)
class Finding:
    """Something that is wrong with a plan, doubtful, or worth knowing."""

    kind: str
    """Name of the check or warning, such as ``void`` or ``in-the-air``, or ``model``, ``plan`` or ``refused``."""
    severity: Literal["serious", "doubt", "note"]
    """How much it matters."""
    count: int
    """How many such findings this one stands for."""
    layer: int | None
    """Index of the layer; none when it concerns the whole plan."""
    pass_: int | None
    """Index of the pass in its layer."""
    place: tuple[float, float, float] | None
    """Where, mm."""
    size: float | None
    """How large, in the unit that the sentence names."""
    text: str
    """What is wrong, and where."""
    remedy: str
    """What to do; empty where that depends on the part."""
    sentence: str
    """Both for people."""

    @classmethod
    def _of(cls, value: dict[str, Any], sentence: str) -> Finding:
        place = value["place"]
        return cls(
            kind=value["kind"],
            severity=value["severity"],
            count=value["count"],
            layer=value["layer"],
            pass_=value["pass"],
            place=None if place is None else (place[0], place[1], place[2]),
            size=value["size"],
            text=value["text"],
            remedy=value["remedy"] or "",
            sentence=sentence,
        )

    def __str__(self) -> str:
        return self.sentence


@dataclass(frozen=True)
class LayerWarning:
    """What was lost or mended on layers, or cannot be built."""

    kind: str
    """Which kind of event, such as ``thin-feature``."""
    count: int
    """How often."""
    layers: list[tuple[int, int]]
    """On which layers: ranges of indices from 0, both ends included."""
    layer: int
    """Index of the layer with the largest one."""
    place: tuple[float, float]
    """Where that is, x and y, mm."""
    size: float
    """How large, in the unit that the sentence names."""
    total: float
    """Sum of the sizes."""
    sentence: str
    """All of it for people."""
    remedy: str
    """What follows from it or helps against it; empty where there is nothing to say."""

    @classmethod
    def _of(cls, value: dict[str, Any], sentence: str) -> LayerWarning:
        largest = value["largest"]
        x, y = largest["place"]
        return cls(
            kind=value["kind"],
            count=value["count"],
            layers=[(first, last) for first, last in value["layers"]],
            layer=largest["layer"],
            place=(x, y),
            size=largest["size"],
            total=value["total"],
            sentence=sentence,
            # The library says first what happened.
            remedy=sentence.partition(". ")[2],
        )

    def __str__(self) -> str:
        return self.sentence
