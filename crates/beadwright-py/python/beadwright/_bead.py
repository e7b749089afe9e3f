"""Libraries of measured beads."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from beadwright import _core
from beadwright._errors import BeadwrightError


@dataclass(frozen=True)
class Bead:
    """A predicted bead."""

    width: float
    """mm."""
    height: float
    """mm."""
    width_plus_minus: float
    """Half of the 95 % interval in which the next single bead is expected, mm."""
    height_plus_minus: float
    """The same for the height, mm."""
    layer_height: float
    """Height of its layers, mm."""
    parameters: dict[str, float]
    """What lays it, in the units of the measurements."""
    notes: list[str] = field(default_factory=list)
    """What to know about it."""

    @classmethod
    def _of(cls, value: dict[str, Any]) -> Bead:
        width, height = value["width_mm"], value["height_mm"]
        return cls(
            width=width["value"],
            height=height["value"],
            width_plus_minus=width["plus_minus"],
            height_plus_minus=height["plus_minus"],
            layer_height=value["layer_height_mm"],
            parameters={name: parameter["value"] for name, parameter in value["parameters"].items()},
            notes=value["notes"],
        )


class BeadLibrary:
    """Width and height of beads over the process parameters. Made by :meth:`fit` or :meth:`read`."""

    def __init__(self, core: _core.BeadLibrary) -> None:
        self._inner = core

    @classmethod
    def fit(
        cls,
        data: str | os.PathLike[str],
        *,
        inputs: Sequence[str] | None = None,
        width: str = "width",
        height: str = "height",
    ) -> BeadLibrary:
        """Fits measured single beads: a CSV file or its text, with one bead per line and a header that names columns with
        units, such as ``current_a, width_mm``. ``inputs`` are the columns of parameters, all but width and height if left out.

        Raises :class:`BeadwrightError` with line and column.
        """
        text, place = _opened(data)
        names = None if inputs is None else list(inputs)
        return cls(_core.BeadLibrary.fit(text, place, names, width, height))

    @classmethod
    def read(cls, library: str | os.PathLike[str]) -> BeadLibrary:
        """A library that was written: a file or its text."""
        return cls(_core.BeadLibrary.parse(*_opened(library)))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the library as TOML, for ``beadwright bead`` and for :meth:`read`."""
        Path(path).write_text(self._inner.toml(), encoding="utf-8", newline="\n")

    @property
    def values(self) -> dict[str, Any]:
        """All of it, as in its file."""
        return self._inner.values

    def predict(
        self, parameters: Mapping[str, float] | None = None, /, *, overlap: str | float | None = None, **named: float
    ) -> Bead:
        """The bead for parameters such as ``predict(current=120, deposition_speed=8)``.

        ``overlap`` (``"tangent"``, ``"inclined-flat-top"`` or a stepover in mm) gives the layer height of closed layers;
        without it, a layer is a single bead.

        Raises :class:`BeadwrightError` outside the measured range.
        """
        given = {**(parameters or {}), **named}
        pairs = [(name, float(value)) for name, value in given.items()]
        return Bead._of(self._inner.predict(pairs, None if overlap is None else str(overlap)))

    def solve(
        self,
        *,
        width: float,
        layer_height: float,
        overlap: str | float | None = None,
        limits: Mapping[str, tuple[float, float]] | None = None,
        tolerance: float = 0.005,
    ) -> Bead:
        """Parameters for a bead with this ``width`` and ``layer_height`` (mm) within the measured range and the ``limits``, met
        within the relative ``tolerance``.

        Raises :class:`BeadwrightError` that names the nearest bead.
        """
        bounds = [(name, float(low), float(high)) for name, (low, high) in (limits or {}).items()]
        chosen = None if overlap is None else str(overlap)
        return Bead._of(self._inner.solve(width, layer_height, chosen, bounds, tolerance))

    def _repr_svg_(self) -> str:
        return self._inner.svg()


def demonstration_csv() -> str:
    """Invented measurements, to try a library out."""
    return _core.demonstration_csv()


def _opened(source: str | os.PathLike[str]) -> tuple[str, str | None]:
    """Text and place of a file, or the text itself."""
    if isinstance(source, str) and "\n" in source:
        return source, None
    path = Path(source)
    try:
        return path.read_text(encoding="utf-8-sig"), str(path)
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text; save it as UTF-8"
        raise BeadwrightError(f"{path} cannot be read: {reason}.", str(path)) from error
