"""From raw rover recordings to a floor plan: the helpers that every stage shares.

One topic a file. What programs that hold arrays want is here by name; it is imported when it is
asked for, so that a stage pays only for what it uses.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from scanplan.arrays.array_plan import (
        ArrayPlan,
        make_plan,
        points_from_ranges,
        register_scans,
    )
    from scanplan.arrays.plan_files import write_plan

__version__ = "0.1.0"
"""The release; CITATION.cff and CHANGELOG.md say the same."""

__all__ = ["ArrayPlan", "make_plan", "points_from_ranges", "register_scans", "write_plan"]


def __getattr__(name: str) -> Any:
    """Return one of `__all__`."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from scanplan.arrays import array_plan, plan_files

    return getattr(plan_files if name == "write_plan" else array_plan, name)
