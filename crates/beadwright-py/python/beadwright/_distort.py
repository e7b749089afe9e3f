"""How plate and part bend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

from beadwright import _core
from beadwright._array import floats
from beadwright._errors import BeadwrightError
from beadwright._page import Page
from beadwright._plan import Plan
from beadwright._progress import Progress, steps

if TYPE_CHECKING:
    from beadwright._array import Floats

Clamps: TypeAlias = Literal["corners", "edge", "none"]


class BentShape(NamedTuple):
    """Plate and part, bent."""

    places: Floats
    """Where the nodes are, n × 3, mm."""
    moved: Floats
    """How far each of them moves, n × 3, mm."""


class Distortion:
    """How plate and part bend. Made by :func:`distort`."""

    def __init__(self, core: _core.Distortion) -> None:
        self._inner = core
        #: All figures, as ``beadwright distort --json`` prints them, without the nodes; lengths in mm, times in s, forces in N.
        self.values: dict[str, Any] = core.values

    @property
    def lift(self) -> float:
        """Largest distance of the plate's lower face from the plane that fits it best, once the clamps are opened, mm."""
        return float(self.values["released"]["lift"]["largest"])

    @property
    def deviation(self) -> float:
        """Largest displacement of the part once the clamps are opened, without its motion as a rigid body, mm."""
        return float(self.values["released"]["deviation"]["largest"])

    @property
    def eccentricity(self) -> float:
        """Mean distance between the middles of heat and metal while it is welded, seen from above, mm."""
        return float(self.values["eccentricity"]["score"]["mean"])

    def shape(self, *, released: bool = True) -> BentShape:
        """The bent shape once the clamps are opened, or on the clamps."""
        places, moved = self._inner.moved(released)
        return BentShape(floats(places), floats(moved))

    def html(self) -> Page:
        """A page with the bent shape in 3-D, exaggerated by a slider."""
        return Page(self._inner.html)

    def __repr__(self) -> str:
        return f"<Distortion: plate lifts by {self.lift:.2f} mm, part off by {self.deviation:.2f} mm>"


def distort(
    plan: Plan,
    *,
    clamps: Clamps = "corners",
    material: Literal["steel", "aluminium"] | None = None,
    calibration: float = 1.0,
    voxel: float | None = None,
    voxel_height: float | None = None,
    steps_at_most: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Distortion:
    """How plate and part of a plan in level layers bend, on the clamps and released: elastic metal that shrinks bead by bead. Not
    compared with measured plates so far.

    ``clamps`` hold the plate until the build is done. ``material`` replaces that which the density of the wire suggests,
    ``calibration`` is a factor of all shrinkage from a measured plate. Voxels are half a bead wide and a layer high, mm,
    unless ``voxel`` and ``voxel_height`` say otherwise; beads are laid in at most ``steps_at_most`` groups. The profile needs
    ``[heat]``, ``[material]`` and ``[substrate]``.

    Raises :class:`BeadwrightError`.
    """
    if steps_at_most is not None and steps_at_most < 1:
        raise BeadwrightError(f"steps_at_most = {steps_at_most} is impossible; at least one step is needed.", "steps_at_most")
    with steps(progress) as step:
        core = _core.distort(
            plan._inner, clamps, material, calibration, voxel, voxel_height, steps_at_most, threads, step
        )
    return Distortion(core)
