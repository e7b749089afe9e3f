"""The totals of a plan."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any


class Metrics(dict[str, Any]):
    """The totals of a plan, as in metrics.json: ``metrics.total_time_s``, or ``metrics["total_time_s"]``. Names give the units."""

    layers: int
    """Layers with at least one pass."""
    passes: int
    """Passes."""
    arc_starts: int
    """Arc starts, one for each pass."""
    deposited_length_mm: float
    """Length of all passes with their overlaps, mm."""
    travel_length_mm: float
    """Length of all moves without the arc, mm."""
    arc_time_s: float
    """Time with the arc on, s; with acceleration where the profile gives it."""
    dwell_time_s: float
    """Waits between layers and passes, s."""
    total_time_s: float
    """Total time with travels, delays, gas and waits, s; with acceleration where the profile gives it."""
    wire_length_m: float
    """Wire, including that of overlaps, hot starts and craters, m."""
    wire_mass_kg: float
    """Wire, kg."""
    gas_m3: float
    """Shielding gas, m³."""
    cost: float | None
    """Cost by the prices of ``[cost]``, in :attr:`currency`; ``None`` where the profile has no prices."""
    co2_kg: float | None
    """Emissions by the factors of ``[cost]``, kg CO₂e; ``None`` where the profile has no factors."""
    energy_kwh: float | None
    """Energy from the mains, kWh; ``None`` where the profile gives no current and voltage."""
    currency: str
    """Currency of the cost."""
    shortest_arc_s: float | None
    """The shortest time for which the arc is on and moving in a pass, s; ``None`` without passes."""
    start_stop_time_s: float
    """Time for gas, for starting and ending the arc and for craters, s."""
    corner_time_s: float
    """Time lost to slowing down before corners and ends, s; 0 where the profile gives no acceleration."""
    heat_input_j_per_mm: float | None
    """Heat per length of bead, J/mm; ``None`` where the profile gives no current and voltage."""
    slice_area_mm2: float
    """Sum of the slice areas, mm²."""
    planned_area_mm2: float
    """Sum of the areas within reach of a bead, mm²."""
    part_volume_mm3: float
    """Volume of the layers, mm³."""
    mesh_volume_mm3: float | None
    """Volume of the part's mesh, mm³; ``None`` where the mesh is not closed, and for curves."""
    milled_part_volume_mm3: float | None
    """Volume of the part that is milled from a preform, mm³; ``None`` where the plan is not that of a preform."""
    deposited_volume_mm3: float
    """Volume of the beads, mm³."""
    coverage: float
    """Planned area over slice area, 0 to 1."""

    if not TYPE_CHECKING:  # Type checkers know the attributes above, and no others.

        def __getattr__(self, name: str) -> Any:
            try:
                return self[name]
            except KeyError:
                raise AttributeError(f'there is no total "{name}"; use {", ".join(sorted(self))}.') from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]
