"""Parts whose truths are known, and the command to compare with."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import beadwright
from beadwright import Part, Plan

ROOT = Path(__file__).resolve().parents[3]
Array = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]


def prism(outline: npt.ArrayLike, height: float) -> tuple[Array, Faces]:
    """A convex outline (counter-clockwise) grown upwards: corners and triangles."""
    corners = np.asarray(outline, dtype=np.float64)
    n = len(corners)
    low = np.column_stack([corners, np.zeros(n)])
    high = np.column_stack([corners, np.full(n, height)])
    fan = np.array([[0, k, k + 1] for k in range(1, n - 1)])
    sides = [[[k, (k + 1) % n, n + (k + 1) % n], [k, n + (k + 1) % n, n + k]] for k in range(n)]
    return np.vstack([low, high]), np.vstack([fan[:, ::-1], fan + n, *map(np.array, sides)])


def stl(corners: Array, faces: Faces) -> bytes:
    """Binary STL."""
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *corners[face].ravel(), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + body


def write_stl(part: Part, path: Path) -> None:
    """Writes a part as binary STL."""
    path.write_bytes(stl(part.vertices, part.faces.astype(np.int64)))


def box(x: float, y: float, z: float, **placing: object) -> Part:
    """A box with a corner at the origin."""
    return Part.from_triangles(*prism([(0, 0), (x, 0), (x, y), (0, y)], z), name="box", **placing)  # type: ignore[arg-type]


def polygon(sides: int, radius: float) -> Array:
    """A regular polygon around the origin."""
    angles = 2 * np.pi * np.arange(sides) / sides
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def shoelace(ring: npt.NDArray[np.float64]) -> float:
    """Signed area of a ring."""
    x, y = ring[:, 0], ring[:, 1]
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2)


def path_length(points: Array, closed: bool) -> float:
    """Length of a path through points."""
    if closed:
        points = np.vstack([points, points[:1]])
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


class Command:
    """The command of this checkout."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __call__(self, *arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        words = [str(self.path), *map(str, arguments)]
        return subprocess.run(words, capture_output=True, text=True, check=False, cwd=cwd)


@pytest.fixture(scope="session")
def command() -> Command:
    """The command beadwright: BEADWRIGHT_COMMAND, or built from this checkout."""
    if command := os.environ.get("BEADWRIGHT_COMMAND"):
        return Command(Path(command))
    if shutil.which("cargo") is None:
        pytest.skip("neither BEADWRIGHT_COMMAND nor cargo is there to compare with")
    subprocess.run(["cargo", "build", "--quiet", "-p", "beadwright-cli"], cwd=ROOT, check=True)
    return Command(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "beadwright")


@pytest.fixture(scope="session")
def cross() -> Plan:
    """The example part "cross", as its profile says."""
    return beadwright.plan(Part.example("cross"))


@pytest.fixture(scope="session")
def contours() -> Plan:
    """The same as contours, which have passes enough to be looked at."""
    return beadwright.plan(Part.example("cross"), strategy="contour")
