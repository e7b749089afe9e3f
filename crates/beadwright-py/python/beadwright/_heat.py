"""How warm the metal is while it is welded."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from beadwright import _core
from beadwright._array import floats
from beadwright._progress import Progress, steps
from beadwright._page import Page
from beadwright._plan import Plan

if TYPE_CHECKING:
    from beadwright._array import Floats


class Heat:
    """Temperatures of a plan. Made by :func:`heat`."""

    def __init__(self, core: _core.Heat) -> None:
        self._inner = core
        #: All of it, as ``beadwright heat --json`` prints it; temperatures in °C, times in s, heat in J.
        self.values: dict[str, Any] = core.values

    @property
    def seconds(self) -> float:
        """Time of the build with all waits, s."""
        return float(self.values["seconds"])

    @property
    def starts(self) -> list[list[float]]:
        """Temperature of the metal where each pass begins, °C, by layer and pass."""
        return [[float(each["start"]) for each in layer["passes"]] for layer in self.values["layers"]]

    @property
    def waits(self) -> float:
        """How long the torch waits for metal to cool, s."""
        return sum(float(each["wait"]) for layer in self.values["layers"] for each in layer["passes"])

    def along(self, layer: int, number: int) -> Floats:
        """Temperatures just ahead of the torch along a pass, °C, ``values["spacing"]`` mm apart; layer and pass count from 0.
        Not copied.
        """
        return floats(self._inner.along(layer, number))

    def html(self) -> Page:
        """A page with pictures of the layers."""
        return Page(self._inner.html)

    def __repr__(self) -> str:
        hottest = max((start for layer in self.starts for start in layer), default=0.0)
        return f"<Heat: hottest start {hottest:.0f} °C, {self.seconds / 60:.1f} min>"


def heat(plan: Plan, limit: float | None = None, *, threads: int | None = None, progress: Progress = None) -> Heat:
    """How warm the metal is before each pass; with ``limit`` (°C), how long the torch would have to wait for it. The plan stays
    as it is. Its profile needs ``[heat]``, ``[material]`` and ``[substrate]``.

    Raises :class:`BeadwrightError` that names the section or key that is missing.
    """
    with steps(progress) as step:
        return Heat(_core.heat(plan._inner, limit, threads, step))
