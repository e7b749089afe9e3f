"""A part and a profile become a plan."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cached_property
from html import escape
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeAlias

from beadwright import _core
from beadwright._progress import Progress, steps
from beadwright._layer import Finding, Layer, LayerWarning, Pass
from beadwright._metrics import Metrics
from beadwright._page import Page
from beadwright._part import Part
from beadwright._profile import Profile

Model: TypeAlias = Part | str | os.PathLike[str]
Process: TypeAlias = Profile | str | os.PathLike[str]


def part_of(model: Model) -> Part:
    """A part, or that of a file."""
    return model if isinstance(model, Part) else Part.read(model)


def profile_of(process: Process) -> Profile:
    """A profile, or that of a name or file."""
    return process if isinstance(process, Profile) else Profile(process)


def plan(
    part: Model,
    profile: Process = "cmt-al2319-kuka",
    *,
    strategy: str | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Plan:
    """Plans a part with a profile.

    ``strategy`` replaces the profile's. The result does not depend on the number of ``threads`` (all of the
    machine's if left out). Other Python threads continue meanwhile, and Ctrl-C ends the call. ``progress`` is called with the
    stage and a fraction from 0 to 1; ``True`` draws a bar.

    Raises :class:`BeadwrightError`.
    """
    wanted = profile_of(profile)
    if strategy is not None:
        wanted = wanted.set({"fill.strategy": strategy})
    with steps(progress) as step:
        return Plan(_core.plan(part_of(part)._inner, wanted._inner, strategy is not None, threads, step))


class Plan:
    """The layers of a part, ready to be written as a program. Made by :func:`plan`."""

    def __init__(self, core: _core.Plan) -> None:
        self._inner = core

    @property
    def part(self) -> str:
        """Name of the part."""
        return self._inner.part

    @property
    def profile(self) -> str:
        """Name of the profile."""
        return self._inner.profile

    @property
    def strategy(self) -> str:
        """Name of the strategy."""
        return self._inner.strategy

    @cached_property
    def layers(self) -> list[Layer]:
        """The layers, lowest first."""
        return [Layer(core) for core in self._inner.layers]

    @property
    def passes(self) -> list[Pass]:
        """All passes in the order in which they are welded."""
        return [each for layer in self.layers for each in layer.passes]

    @cached_property
    def metrics(self) -> Metrics:
        """The totals: lengths, times, wire, areas and volumes."""
        return Metrics(self._inner.metrics)

    @cached_property
    def warnings(self) -> list[LayerWarning]:
        """What was lost or mended, or cannot be built."""
        return [LayerWarning._of(value, sentence) for value, sentence in self._inner.warnings]

    @property
    def notes(self) -> list[str]:
        """What does not fit together in the profile, as sentences."""
        return self._inner.notes

    def findings(self, *, threads: int | None = None, progress: Progress = None) -> list[Finding]:
        """Everything to report about the plan, the worst first: what the checks find, what was lost or mended, and what
        does not fit together in the profile. The same list as in ``metrics.json`` and in the report; the deposit model takes a
        while.
        """
        with steps(progress) as step:
            return [Finding._of(value, sentence) for value, sentence in self._inner.findings(threads, step)]

    @property
    def forbidden(self) -> list[str]:
        """Why its programs should not be written; empty for a plan that can be welded."""
        return self._inner.forbidden

    def post(self, *dialects: str) -> dict[str, str]:
        """The programs: the text of each file by its name. Without dialects (such as ``"krl"``, or the path of a folder with
        one of your own), those of the profile.

        Raises :class:`BeadwrightError`, for instance where the profile has no section for a dialect.
        """
        return self._inner.post(list(dialects))

    def save(
        self,
        folder: str | os.PathLike[str] = "beadwright-out",
        *,
        post: str | Sequence[str] = (),
        deposit: bool = True,
        allow_findings: bool = False,
        threads: int | None = None,
        progress: Progress = None,
    ) -> list[Path]:
        """Writes the programs, plan.json, metrics.json and report.html, all of them or none, with the bytes that
        ``beadwright plan`` would write. Returns their paths.

        Without ``deposit`` the deposit model is left out, as with ``--no-deposit``. A plan with :attr:`forbidden` reasons
        is only written with ``allow_findings``.

        Raises :class:`BeadwrightError`.
        """
        dialects = [post] if isinstance(post, str) else list(post)
        with steps(progress) as step:
            names = self._inner.save(os.fspath(folder), dialects, deposit, allow_findings, threads, step)
        return [Path(folder) / name for name in names]

    def show(self, *, deposit: bool = True, threads: int | None = None, progress: Progress = None) -> Page:
        """The report, with its layers in 3-D: a notebook shows it in a frame. Without ``deposit`` the deposit model is left out.

        Raises :class:`BeadwrightError`.
        """
        with TemporaryDirectory() as folder, steps(progress) as step:
            # Pictures only: no program leaves the folder, so findings do not matter.
            self._inner.save(folder, [], deposit, True, threads, step)
            return Page((Path(folder) / "report.html").read_text("utf-8"))

    def export(self, path: str | os.PathLike[str]) -> None:
        """Writes the beads for other programs; the extension gives the format: .csv, .parquet, .vtp, .3mf, .stl or .glb."""
        path = Path(path)
        path.write_bytes(self._inner.export(path.suffix.removeprefix(".")))

    def table(self) -> Any:
        """All straight pieces of the beads as they are welded, as a ``pyarrow.Table``: the columns of ``export(".parquet")``,
        whose names give the units.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        return pq.read_table(pa.BufferReader(self._inner.export("parquet")))

    def to_trimesh(self) -> Any:
        """The shape as built, as ``trimesh.Trimesh``, mm."""
        import trimesh

        return trimesh.load(BytesIO(self._inner.export("stl")), file_type="stl")

    def to_pyvista(self) -> Any:
        """The beads as ``pyvista.PolyData`` with width, speed, time and the other columns of :meth:`table`."""
        import pyvista
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

        reader = vtkXMLPolyDataReader()
        reader.ReadFromInputStringOn()
        reader.SetInputString(self._inner.export("vtp").decode())
        reader.Update()
        return pyvista.wrap(reader.GetOutput())

    def _repr_html_(self) -> str:
        """Totals, warnings, and the layer in the middle."""
        rows = "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in self._rows())
        remarks = "".join(f"<li>{escape(text)}</li>" for text in [*map(str, self.warnings), *self.notes])
        middle = self.layers[len(self.layers) // 2]
        return (
            f"<h4>{escape(self.part)}: {escape(self.strategy)}, {escape(self.profile)}</h4><table>{rows}</table>"
            f'<ul>{remarks}</ul><div style="max-width:32em">{middle.svg()}</div>'
        )

    def _rows(self) -> list[tuple[str, str]]:
        totals = self.metrics
        return [
            ("layers", str(totals.layers)),
            ("arc starts", str(totals.arc_starts)),
            ("deposited length", f"{totals.deposited_length_mm / 1e3:.2f} m"),
            ("travel length", f"{totals.travel_length_mm / 1e3:.2f} m"),
            ("time", f"{totals.total_time_s / 60:.1f} min"),
            ("wire", f"{totals.wire_mass_kg:.3f} kg"),
        ]

    def __repr__(self) -> str:
        return f"<Plan {self.part}: {self.strategy}, {self.profile}, {len(self.layers)} layers>"
