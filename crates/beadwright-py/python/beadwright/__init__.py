"""Plans weld deposition: a part becomes a robot program, and what it would build is told beforehand.

>>> import beadwright
>>> plan = beadwright.plan(beadwright.Part.read("propeller.stl"), "cmt-al2319-kuka")  # doctest: +SKIP
>>> plan.save("out")  # doctest: +SKIP

Lengths are in mm, times in s, areas in mm², unless a name says otherwise. What goes wrong is a :class:`BeadwrightError`.
"""

from beadwright._core import VERSION as __version__
from beadwright._errors import BeadwrightError
from beadwright._progress import Progress
from beadwright.layer import Island, Layer, LayerWarning, Pass
from beadwright.part import Part
from beadwright.plan import Plan, plan
from beadwright.profile import Profile, profiles, strategies

__all__ = [
    "BeadwrightError",
    "Island",
    "Layer",
    "LayerWarning",
    "Part",
    "Pass",
    "Plan",
    "Profile",
    "Progress",
    "__version__",
    "plan",
    "profiles",
    "strategies",
]
