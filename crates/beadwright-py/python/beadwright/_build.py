"""Plans welded in the height model, with errors and with feedback by scans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from beadwright import _core
from beadwright._errors import BeadwrightError
from beadwright._page import Page
from beadwright._plan import Plan
from beadwright._progress import Progress, steps
from beadwright._scan import _check_rules

Feedback: TypeAlias = Literal["none", "mean", "place"]


@dataclass(frozen=True)
class Noise:
    """What goes wrong while a plan is welded; fractions of the metal unless a unit is given."""

    passes: float = 0.1
    """Standard deviation from pass to pass."""
    along: float = 0.1
    """Standard deviation along a pass."""
    correlation: float = 20.0
    """Distance along a pass over which the correlation of its error falls to 1/e, mm."""
    drift: float = 0.03
    """Growth from the first to the last layer."""
    lost_pass: int | None = None
    """Number of the pass whose arc fails to burn, counted from 1 through the whole build."""
    scan: float = 0.0
    """Standard deviation of a point of a scan, mm."""


class Builds:
    """A plan welded in the model, once for each kind of feedback. Made by :func:`build`."""

    def __init__(self, core: _core.Builds) -> None:
        self._inner = core
        #: For each kind: ``feedback``, ``layers`` (``z`` and ``error``, mm), ``end`` (the top against the end of the plan, mm),
        #: ``rms_layers`` (its RMS in layer heights), ``layer_height`` (mm), ``pieces`` and how many were ``clipped``.
        self.values: list[dict[str, Any]] = core.values

    def rms(self, feedback: Feedback) -> float:
        """RMS of the top against the end of the plan, in layer heights."""
        return next(float(each["rms_layers"]) for each in self.values if each["feedback"] == feedback)

    def html(self) -> Page:
        """A page with the builds layer by layer."""
        return Page(self._inner.html)

    def __repr__(self) -> str:
        rows = ", ".join(f"{each['feedback']} {each['rms_layers']:.2f}" for each in self.values)
        return f"<Builds: RMS in layer heights: {rows}>"


def build(
    plan: Plan,
    feedback: Sequence[Feedback] = ("none", "mean", "place"),
    *,
    noise: Noise = Noise(),
    seed: int = 1,
    window: tuple[float, float] = (0.7, 1.3),
    spacing: float | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Builds:
    """Welds a plan in the height model, with errors, and with a scan after each layer that is used in each way of
    ``feedback``: ``"none"`` leaves the plan as it is, with ``"mean"`` the layers follow the mean height, with ``"place"`` each
    place gets the metal that it lacks. The same ``seed`` gives the same errors.

    ``window`` and ``spacing`` are those of :func:`adapt`.

    Raises :class:`BeadwrightError`, for instance for layers that do not lie over one another.
    """
    _check_rules(window, spacing)
    shares = {"passes": noise.passes, "along": noise.along, "drift": noise.drift}
    for name, value in shares.items():
        if not -0.5 <= value <= 0.5:
            raise BeadwrightError(f"{name} = {value} is impossible; -0.5 to 0.5 is possible (0.1 is 10 %).", name)
    lengths = {"correlation": (noise.correlation, 1.0, 1e4), "scan": (noise.scan, 0.0, 10.0)}
    for name, (value, least, most) in lengths.items():
        if not least <= value <= most:
            raise BeadwrightError(f"{name} = {value} is impossible; {least:g} to {most:g} mm is possible.", name)
    if noise.lost_pass is not None and noise.lost_pass < 1:
        raise BeadwrightError(f"lost_pass = {noise.lost_pass} is impossible; passes count from 1.", "lost_pass")
    wrong = (noise.passes, noise.along, noise.correlation, noise.drift, noise.lost_pass, noise.scan)
    with steps(progress) as step:
        core = _core.build(plan._inner, list(feedback), wrong, seed, window, spacing, threads, step)
    return Builds(core)
