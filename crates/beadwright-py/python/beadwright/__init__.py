"""Plans weld deposition: a part becomes a robot program, and what it would build is predicted.

>>> import beadwright
>>> plan = beadwright.plan(beadwright.Part.read("propeller.stl"), "cmt-al2319-kuka")  # doctest: +SKIP
>>> plan.save("out")  # doctest: +SKIP

Lengths are in mm, times in s, areas in mm², unless a name says otherwise. What goes wrong raises a :class:`BeadwrightError`.
"""

from beadwright._core import VERSION as __version__
from beadwright._errors import BeadwrightError
from beadwright._progress import Progress
from beadwright._bead import Bead, BeadLibrary, demonstration_csv
from beadwright._build import Builds, Noise, build
from beadwright._distort import BentShape, Distortion, distort
from beadwright._executors import LocalExecutor, RayExecutor
from beadwright._heat import Heat, heat
from beadwright._judging import Comparison, Fault, HeightField, Judged, check, compare, height_field, simulate
from beadwright._layer import Finding, Island, Layer, LayerWarning, Pass
from beadwright._metrics import Metrics
from beadwright._page import Page
from beadwright._part import Part, examples
from beadwright._plan import Plan, plan
from beadwright._profile import Profile, profiles, strategies
from beadwright._robot import Reach, ReachFinding, Trajectory, cells, reach
from beadwright._scan import Adapted, Deviation, adapt, deviation
from beadwright._study import Study, study

__all__ = [
    "Adapted",
    "Bead",
    "BeadLibrary",
    "BeadwrightError",
    "BentShape",
    "Builds",
    "Comparison",
    "Deviation",
    "Distortion",
    "Fault",
    "Finding",
    "Heat",
    "HeightField",
    "Island",
    "Judged",
    "Layer",
    "LayerWarning",
    "LocalExecutor",
    "Metrics",
    "Noise",
    "Page",
    "Part",
    "Pass",
    "Plan",
    "Profile",
    "Progress",
    "RayExecutor",
    "Reach",
    "ReachFinding",
    "Study",
    "Trajectory",
    "__version__",
    "adapt",
    "build",
    "cells",
    "check",
    "compare",
    "demonstration_csv",
    "deviation",
    "distort",
    "examples",
    "heat",
    "height_field",
    "plan",
    "profiles",
    "reach",
    "simulate",
    "strategies",
    "study",
]
