"""A survey read from the tables of its results, as it is compared with others."""

from collections.abc import Mapping

from scanplan.changes.comparison import Scans
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import FloorPlan
from scanplan.store import registered_scans, tables
from scanplan.types import FilePath

PLAN = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")
"""Tables of a plan that are compared."""


def read_survey(
    files: Mapping[str, FilePath], name: str, **assumed_m: float
) -> tuple[FloorPlan, Scans]:
    """Read a plan and its scans.

    Parameters
    ----------
    files : dict of str to path-like
        Those of `PLAN`, `scans` and `registration`.
    name : str
        Of the dataset.
    **assumed_m
        See `floorplan_files.read_floorplan`.

    Raises
    ------
    StageError
        If one is missing or damaged.
    """
    plan = floorplan_files.read_floorplan({part: files[part] for part in PLAN}, name, **assumed_m)
    store = tables.ScanStore(files["scans"])
    return plan, (store, registered_scans.read_registered_scans(files["registration"], store))
