"""What a plan or a program would build."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from beadwright import _core
from beadwright._array import floats
from beadwright._errors import BeadwrightError
from beadwright._page import Page
from beadwright._progress import Progress, steps
from beadwright._plan import Model, Plan, Process, part_of, profile_of
from beadwright._profile import Profile, strategies as all_strategies

if TYPE_CHECKING:
    from beadwright._array import Floats


class Judged:
    """What a strategy or a program would build, by the deposit model."""

    def __init__(self, core: _core.Judged) -> None:
        self._inner = core
        #: All of it, as ``beadwright simulate --json`` prints it: totals, deposit, layers, growth, built.
        self.values: dict[str, Any] = core.values

    @property
    def name(self) -> str:
        """Name of the strategy, of the part or of the file."""
        return self._inner.name

    @property
    def totals(self) -> dict[str, Any]:
        """Arc starts, lengths, times and metal; the names give the units."""
        totals: dict[str, Any] = self.values["totals"]
        return totals

    @property
    def deposit(self) -> dict[str, Any]:
        """Voids, overfill and heights of all layers."""
        deposit: dict[str, Any] = self.values["deposit"]
        return deposit

    @property
    def notes(self) -> list[str]:
        """What was not understood or had to be assumed."""
        return self._inner.notes

    @property
    def faults(self) -> list[str]:
        """Lines that would be dangerous on a controller, or that it would refuse; empty where a plan was judged."""
        return self._inner.faults

    @property
    def row(self) -> dict[str, float]:
        """Its row of a comparison; the headings give the units."""
        return dict(self._inner.columns)

    def html(self) -> Page:
        """A page with figures and height fields."""
        return Page(_core.page(self.name, "Judged by the deposit model.", [self._inner]))

    def __repr__(self) -> str:
        return f"<Judged {self.name}: void {self.row['void %']:.2f} %, overfill {self.row['overfill %']:.2f} %>"


class Comparison(Sequence[Judged]):
    """Strategies and programs side by side."""

    def __init__(self, title: str, entries: Iterable[Judged]) -> None:
        self.title = title
        self._entries = tuple(entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __getitem__(self, index: Any) -> Any:
        return self._entries[index]

    @property
    def best(self) -> Judged:
        """The one with the lowest score."""
        return min(self._entries, key=lambda entry: entry.row["score"])

    def table(self) -> dict[str, list[Any]]:
        """The columns by their headings: for ``pandas.DataFrame`` or ``pyarrow.table``."""
        rows = [{"name": entry.name, **entry.row} for entry in self._entries]
        return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}

    def html(self) -> Page:
        """A page with the table and the height fields side by side."""
        return Page(_core.page(self.title, "", [entry._inner for entry in self._entries]))

    def _repr_html_(self) -> str:
        table = self.table()
        head = "".join(f"<th>{name}</th>" for name in table)
        rows = zip(*table.values(), strict=True)
        cells = ("".join(f"<td>{_cell(value)}</td>" for value in row) for row in rows)
        return f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"


class HeightField(NamedTuple):
    """Heights of a layer's metal above its bottom."""

    heights: Floats
    """One row for each y, mm."""
    x: Floats
    """Where the columns lie, mm."""
    y: Floats
    """Where the rows lie, mm."""

    def show(self, **kwargs: Any) -> Any:
        """A picture of the heights by matplotlib, seen from above, with a scale in mm; returns its axes. ``kwargs`` are those of
        ``Axes.pcolormesh``.
        """
        import matplotlib.pyplot as plt

        _, axes = plt.subplots()
        picture = axes.pcolormesh(self.x, self.y, self.heights, **{"cmap": "viridis", "shading": "nearest", **kwargs})
        axes.figure.colorbar(picture, ax=axes, label="height, mm")
        axes.set(xlabel="x, mm", ylabel="y, mm", aspect="equal")
        return axes


def compare(
    part: Model,
    profile: Process = "cmt-al2319-kuka",
    strategies: Sequence[str] | None = None,
    *,
    layers: Iterable[int] | None = None,
    grid: float | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Comparison:
    """Plans a solid with each strategy (all of them if left out) and judges the chosen ``layers``, by index from 0.

    ``grid`` is the distance between the deposit model's points, mm; a twentieth of the bead width if left out.

    Raises :class:`BeadwrightError`.
    """
    solid = part_of(part)
    names = all_strategies() if strategies is None else list(strategies)
    chosen = None if layers is None else set(layers)
    with steps(progress) as step:
        core = _core.compare(solid._inner, profile_of(profile)._inner, names, chosen, grid, threads, step)
    return Comparison(solid.name, map(Judged, core))


def simulate(
    program: Plan | str | os.PathLike[str],
    *,
    part: Model | None = None,
    profile: Process | None = None,
    modules: Mapping[str, str] | None = None,
    arc_on: Sequence[str] = (),
    arc_off: Sequence[str] = (),
    bead_width: float | None = None,
    grid: float | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Judged:
    """Judges what a plan, or a program from any source, would build.

    A program is a path or its text (then ``modules`` has the texts of what it calls, by file name, as :meth:`Plan.post`
    gives them), in G-code, KRL, RAPID, FANUC TP, INFORM or URScript. With the ``part`` it was made for, voids and overfill
    are reported, too. Left out, the ``profile`` is the one that the program names, or ``cmt-al2319-kuka``; a printer's
    program that names none needs one. ``arc_on`` and
    ``arc_off`` are codes that strike and end the arc, ``bead_width`` (mm) replaces the profile's, ``grid`` is the distance
    between the deposit model's points, mm.

    Raises :class:`BeadwrightError`.
    """
    if isinstance(program, Plan):
        with steps(progress) as step:
            return Judged(_core.judge(program._inner, grid, threads, step))
    name, text, module = _source(program, modules)
    wanted = _profile_for(text, profile)
    solid = None if part is None else part_of(part)._inner
    reading = (list(arc_on), list(arc_off), bead_width, profile is not None)
    with steps(progress) as step:
        core = _core.simulate(name, text, module, wanted._inner, reading, solid, grid, threads, step)
    return Judged(core)


@dataclass(frozen=True)
class Fault:
    """A line of a program that would be dangerous on a controller, or that it would refuse."""

    kind: str
    """Name of the check."""
    module: str | None
    """The module in which it is; none in the program itself."""
    line: int | None
    """The first such line, counted from 1."""
    count: int
    """How many such lines this one stands for."""
    text: str
    """What is wrong."""
    remedy: str
    """What to do."""
    sentence: str
    """Place and words for people."""

    def __str__(self) -> str:
        return self.sentence


def check(
    program: str | os.PathLike[str],
    *,
    profile: Process | None = None,
    modules: Mapping[str, str] | None = None,
    arc_on: Sequence[str] = (),
    arc_off: Sequence[str] = (),
    bead_width: float | None = None,
) -> list[Fault]:
    """Lines of a program from any source that would be dangerous on a controller, or that it would refuse; empty where
    nothing is found. The arguments are those of :func:`simulate`. For a plan, use :meth:`Plan.findings`.

    Raises :class:`BeadwrightError`.
    """
    name, text, module = _source(program, modules)
    wanted = _profile_for(text, profile)
    reading = (list(arc_on), list(arc_off), bead_width, profile is not None)
    found = _core.faults(name, text, module, wanted._inner, reading)
    return [Fault(**value, sentence=sentence) for value, sentence in found]


def height_field(plan: Plan, layer: int, grid: float | None = None) -> HeightField:
    """The metal of a layer (by index from 0) on a grid of points ``grid`` mm apart, a twentieth of the bead width if left
    out. Every point is computed, in double precision.
    """
    import numpy as np

    array, (x, y), step = _core.height_field(plan._inner, layer, grid)
    heights = floats(array)
    rows, columns = heights.shape
    return HeightField(heights, x + step * np.arange(columns, dtype=np.float64), y + step * np.arange(rows, dtype=np.float64))


def _cell(value: object) -> str:
    return f"{value:.2f}" if isinstance(value, float) else str(value)


def _profile_for(text: str, profile: Process | None) -> Profile:
    """The profile given, or the one that a program names."""
    return profile_of(profile if profile is not None else _core.named_profile(text) or "cmt-al2319-kuka")


def _source(
    program: str | os.PathLike[str], modules: Mapping[str, str] | None
) -> tuple[str, str, Callable[[str], str | None]]:
    """Name and text of a program, and what finds its modules."""
    if isinstance(program, str) and "\n" in program:
        texts = modules or {}
        return "program", program, lambda name: _named(name, {Path(file): text for file, text in texts.items()}.items())
    path = Path(program)
    text = _text(path)
    suffix, language = path.suffix.lower(), _core.language(text)

    def module(name: str) -> str | None:
        # If the same part is next to it in several languages, the program's own comes first.
        files = sorted(path.parent.iterdir(), key=lambda file: (file.suffix.lower() != suffix, file))
        texts = ((file, _text(file)) for file in files if file.is_file() and _core.may_be_module(file.name, name))
        return _named(name, ((file, text) for file, text in texts if _core.language(text) in (None, language)))

    return path.name, text, module


def _named(name: str, texts: Iterable[tuple[Path, str]]) -> str | None:
    return next((text for file, text in texts if _core.may_be_module(file.name, name)), None)


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise BeadwrightError(f"{path} cannot be read: {error.strerror}.", str(path)) from error
