"""Scans of a build: compared with the part, and followed by corrected layers."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from beadwright import _core
from beadwright._array import floats
from beadwright._errors import BeadwrightError
from beadwright._layer import Layer
from beadwright._part import Unit
from beadwright._plan import Model, Plan, part_of
from beadwright._progress import Progress, steps

if TYPE_CHECKING:
    import numpy.typing as npt

    from beadwright._array import Floats

Align: TypeAlias = Literal["as-is", "plate", "fit"]


class Deviation:
    """How far points lie from the surface of a part. Made by :func:`deviation`."""

    def __init__(self, core: _core.Deviation) -> None:
        self._inner = core
        #: All of it, as ``beadwright deviation --json`` prints it; lengths in mm, shares from 0 to 1.
        self.values: dict[str, Any] = core.values

    @property
    def figures(self) -> dict[str, Any]:
        """Mean, standard deviation, extremes (mm) and shares of the points, without those of the plate."""
        figures: dict[str, Any] = self.values["figures"]
        return figures

    @property
    def doubts(self) -> list[str]:
        """Reasons to mistrust the comparison."""
        doubts: list[str] = self.values["doubts"]
        return doubts

    @property
    def distances(self) -> Floats:
        """Distance of each point from the surface, mm: positive outside the part."""
        return floats(self._inner.distances)

    @property
    def agreement(self) -> float | None:
        """What the beads of a plan and the part have in common, as a fraction of the volume of both together; ``None`` for a
        scan.
        """
        built: dict[str, Any] | None = self.values.get("built")
        return None if built is None else float(built["agreement"])

    def __repr__(self) -> str:
        figures = self.figures
        return f"<Deviation: {figures['mean']:+.3f} ± {figures['standard_deviation']:.3f} mm, {figures['points']} points>"


class Adapted:
    """The layers that follow a scan. Made by :func:`adapt`."""

    def __init__(self, core: _core.Adapted) -> None:
        self._inner = core
        #: All of it, as ``beadwright adapt --json`` prints it; lengths in mm, the turn in °, metal as multiples of the planned.
        self.values: dict[str, Any] = core.values

    @property
    def notes(self) -> list[str]:
        """What the scan shows and what follows from it, as sentences."""
        return self._inner.sentences

    @cached_property
    def layers(self) -> list[Layer]:
        """The layers that follow, the lowest first."""
        return [Layer(core) for core in self._inner.layers]

    def save(
        self, folder: str | os.PathLike[str] = "beadwright-adapted", *, post: str | Sequence[str] = ()
    ) -> list[Path]:
        """Writes the programs of the layers that follow, the whole plan with them, and a page, all of them or none. Returns
        their paths. Where no layer follows, there is only the page.

        Raises :class:`BeadwrightError`.
        """
        dialects = [post] if isinstance(post, str) else list(post)
        return [Path(folder) / name for name in self._inner.save(os.fspath(folder), dialects)]

    def __repr__(self) -> str:
        return f"<Adapted: {len(self.layers)} layers follow layer {self.values['after_layer']}>"


def deviation(
    part: Model,
    scan: Plan | str | os.PathLike[str] | npt.ArrayLike,
    *,
    units: Unit = "mm",
    allowance: float = 0.0,
    threads: int | None = None,
    progress: Progress = None,
) -> Deviation:
    """How far a ``scan`` of the built part lies from the part: a file (PLY, STL, OBJ, 3MF, AMF, lines of x, y, z, a height
    map; ``units`` are those of its lengths), points (n × 3, mm), or a plan, whose beads are then compared.

    Both have the coordinates of the part as it is planned. ``allowance`` is what is still to be milled off, mm.

    Raises :class:`BeadwrightError`.
    """
    solid = part_of(part)
    if not 0.0 <= allowance <= 1e3:
        raise BeadwrightError(f"allowance = {allowance} is impossible; 0 to 1000 mm is possible.", "allowance")
    with steps(progress) as step:
        if isinstance(scan, Plan):
            core = _core.built_deviation(solid._inner, scan._inner, threads, step)
        else:
            core = _core.deviation(solid._inner, _scan(scan, units), allowance, threads, step)
    return Deviation(core)


def adapt(
    plan: Plan,
    scan: str | os.PathLike[str] | npt.ArrayLike,
    after_layer: int,
    *,
    align: Align = "as-is",
    units: Unit = "mm",
    window: tuple[float, float] = (0.7, 1.3),
    spacing: float | None = None,
) -> Adapted:
    """Corrects the layers of a plan that are still to be welded by a ``scan`` (a file or points, n × 3, mm) of the build
    after layer ``after_layer``, counted from 1: their number, heights, and the metal at each place.

    ``align`` moves the scan: not at all, by the plate (``"plate"``), or by the plate and the outline of the part (``"fit"``).
    ``window`` is the least and greatest metal per length as multiples of what was planned; metal and height change at points
    ``spacing`` apart (mm, a bead width if left out).

    Raises :class:`BeadwrightError`, for instance for a scan that cannot be of this build.
    """
    _check_rules(window, spacing)
    if after_layer < 1:
        raise BeadwrightError(f"after_layer = {after_layer} is impossible; layers count from 1.", "after_layer")
    return Adapted(_core.adapt(plan._inner, _scan(scan, units), after_layer, align, window, spacing))


def _check_rules(window: tuple[float, float], spacing: float | None) -> None:
    least, most = window
    if not (0.1 <= least <= 1.0 <= most <= 5.0):
        raise BeadwrightError(f"window = {window} is impossible: 0.1 to 1 and 1 to 5 are expected.", "window")
    if spacing is not None and not 0.1 <= spacing <= 1e3:
        raise BeadwrightError(f"spacing = {spacing} is impossible; 0.1 to 1000 mm is possible.", "spacing")


def _scan(scan: str | os.PathLike[str] | npt.ArrayLike, units: Unit) -> _core.Scan:
    """A scan from a file or from points."""
    if isinstance(scan, str | os.PathLike):
        path = Path(scan)
        try:
            content = path.read_bytes()
        except OSError as error:
            raise BeadwrightError(f"{path} cannot be read: {error.strerror}.", str(path)) from error
        return _core.Scan.read(str(path), content, units)
    import numpy as np

    points = np.asarray(scan, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise BeadwrightError(f"the scan has the shape {points.shape}; rows of three are expected.", "scan")
    return _core.Scan.of(np.ascontiguousarray(points).reshape(-1).data)
