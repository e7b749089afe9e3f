"""Which of many plans no other beats, and a picture of them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any


def front(rows: Sequence[dict[str, Any]], measures: Sequence[str], greater: Collection[str] = ()) -> list[dict[str, Any]]:
    """The rows that no other beats: as good in every measure and better in one. Less is better, except in ``greater``."""
    complete = [row for row in rows if all(row.get(name) is not None for name in measures)]
    values = [tuple(-row[name] if name in greater else row[name] for name in measures) for row in complete]

    def beaten(own: tuple[float, ...]) -> bool:
        return any(other != own and all(a <= b for a, b in zip(other, own, strict=True)) for other in values)

    return [row for row, own in zip(complete, values, strict=True) if not beaten(own)]


def figure(rows: Sequence[dict[str, Any]], x: str, y: str, best: Sequence[dict[str, Any]]) -> Any:
    """All rows as points, and a line through the best, as a ``matplotlib`` figure."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(7, 4.5), layout="constrained")
    axes = drawing.subplots()
    for name in dict.fromkeys(row["part"] for row in rows):
        own = [row for row in rows if row["part"] == name and row[x] is not None and row[y] is not None]
        axes.scatter([row[x] for row in own], [row[y] for row in own], s=14, label=name)
    line = sorted(best, key=lambda row: (row[x], row[y]))
    axes.plot([row[x] for row in line], [row[y] for row in line], color="#ff338f", linewidth=1, label="best")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.legend(frameon=False)
    return drawing
