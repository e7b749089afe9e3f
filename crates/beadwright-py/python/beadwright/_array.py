"""The core's arrays as NumPy's. NumPy is loaded with the first one, so that ``import beadwright`` is fast."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from beadwright import _core

    Floats: TypeAlias = npt.NDArray[np.float64]
    Indices: TypeAlias = npt.NDArray[np.uint32]


def floats(array: _core.Array) -> Floats:
    """The array's own memory, which cannot be written to; it lives as long as a view of it does."""
    import numpy as np

    return np.asarray(array, dtype=np.float64)


def indices(array: _core.Array) -> Indices:
    """The same for indices."""
    import numpy as np

    return np.asarray(array, dtype=np.uint32)
