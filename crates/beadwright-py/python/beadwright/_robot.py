"""Whether a robot can weld a plan."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from beadwright import _core
from beadwright._array import floats
from beadwright._errors import BeadwrightError
from beadwright._page import Page
from beadwright._plan import Plan

if TYPE_CHECKING:
    from beadwright._array import Floats


class ReachFinding(NamedTuple):
    """What stops the robot, or nearly does."""

    fatal: bool
    sentence: str
    values: dict[str, Any]

    def __str__(self) -> str:
        return self.sentence


class Trajectory(NamedTuple):
    """The path of the joints."""

    seconds: Floats
    """Time of each point, s; without waits and acceleration."""
    joints: Floats
    """Angles of the joints, n × 6, °."""


class Reach:
    """The path of a robot along a plan. Made by :func:`reach`."""

    def __init__(self, core: _core.Reach) -> None:
        self._inner = core
        #: All of it, as ``beadwright reach --json`` prints it; lengths in mm, angles in °.
        self.values: dict[str, Any] = core.values

    @property
    def reachable(self) -> bool:
        """Whether the robot can weld the whole plan."""
        return bool(self.values["reachable"])

    @property
    def least_margin(self) -> float | None:
        """Least margin to limits and singularities, °; ``None`` if nothing is reached."""
        margin: float | None = self.values["least_margin"]
        return margin

    @property
    def findings(self) -> list[ReachFinding]:
        """What is wrong, the fatal ones first."""
        return [ReachFinding(each["fatal"], each["sentence"], each["finding"]) for each in self.values["findings"]]

    @property
    def trajectory(self) -> Trajectory | None:
        """The path of the joints; ``None`` where a point is out of reach."""
        arrays = self._inner.trajectory
        return None if arrays is None else Trajectory(floats(arrays[0]), floats(arrays[1]))

    def html(self) -> Page:
        """A page with joint angles and margins over the program."""
        return Page(self._inner.html)

    def __repr__(self) -> str:
        margin = "nothing reached" if self.least_margin is None else f"least margin {self.least_margin:.1f}°"
        return f"<Reach {self.values['cell']}: {'reachable' if self.reachable else 'out of reach'}, {margin}>"


def cells() -> list[str]:
    """Names of the built-in cells."""
    return _core.cell_names()


def reach(
    plan: Plan,
    cell: str | os.PathLike[str],
    *,
    at: tuple[float, float, float] | tuple[float, float, float, float] | None = None,
    suggest: bool = False,
) -> Reach:
    """Follows a plan with the robot of a ``cell``: a built-in name, or a TOML file.

    ``at`` is the place of the part's origin instead of the cell's: x, y, z (mm) and the turn about the vertical (°).
    ``suggest`` searches for a better one.

    Raises :class:`BeadwrightError` with the line or key of a broken cell.
    """
    text, place, urdf = _cell(os.fspath(cell))
    where = None if at is None else [*map(float, at), 0.0][:4]
    if where is not None and (len(where) != 4 or not all(abs(value) <= 1e5 for value in where)):
        raise BeadwrightError(f"at = {at} is impossible: x, y, z within 100 m, and a turn in °.", "at")
    return Reach(_core.reach(plan._inner, text, place, urdf, where, suggest))


def _cell(source: str) -> tuple[str, str, str | None]:
    """Text of a cell, its place, and the text of the arm's URDF file if it names one."""
    path = Path(source)
    if path.suffix != ".toml" and len(path.parts) < 2 and not path.is_file():
        return _core.cell_text(source), source, None
    text = _text(path)
    named = re.search(r'^\s*urdf\s*=\s*"([^"]+)"', text, re.MULTILINE)
    return text, source, _text(path.with_name(named[1])) if named else None


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise BeadwrightError(f"{path} cannot be read: {reason}.", str(path)) from error
