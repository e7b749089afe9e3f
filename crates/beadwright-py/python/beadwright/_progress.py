"""Progress of long calls: a callable, or ``True`` for a bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from beadwright._errors import BeadwrightError

Step: TypeAlias = Callable[[str, float], object]
#: Takes the stage ("import", "slice", "plan", "deposit", "heat") and how far it has come, 0 to 1. ``True`` draws a bar
#: with tqdm.
Progress: TypeAlias = Step | bool | None


@contextmanager
def steps(progress: Progress) -> Iterator[Step | None]:
    """What the core calls with every step; a bar ends with the block."""
    if not isinstance(progress, bool):
        yield progress
        return
    if not progress:
        yield None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError as error:
        raise BeadwrightError(
            "progress=True draws its bar with tqdm, which is not installed.", "progress", "pip install tqdm"
        ) from error
    with tqdm(total=1.0, bar_format="{desc:>8} {bar} {percentage:3.0f} %") as bar:

        def step(stage: str, fraction: float) -> None:
            bar.set_description_str(stage, refresh=False)
            bar.update(fraction - bar.n)

        yield step
