"""What the plans of the guard's drives are worth, a line each and the means of each kind."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from scanplan.store import registered_scans

_FRAME = "registered"  # the map's own, as a user has it
_MEASURES = {
    "correctness_010m": "right",
    "visible_completeness_010m": "of visible",
    "thickness_error_m": "thick m",
    "worst_thickness_error_m": "worst m",
    "door_recall": "doors",
    "door_precision": "right",
    "room_iou": "IoU",
    "least_room_iou": "least",
    "n_rooms_true": "rooms",
    "n_rooms_found": "found",
    "n_rooms_false": "false",
}


def print_table(folder: Path, names: Sequence[str] = ()) -> None:
    """Print measures of drives, then means by kind.

    Parameters
    ----------
    folder : Path
        As `guard.record` made it.
    names : sequence of str
        Only these drives; all that were measured if empty.
    """
    results = folder / "code/results"
    measured = sorted(path.parent.parent for path in results.glob("*/evaluation/plan.parquet"))
    rows = [_read_drive(place) for place in measured if not names or place.name in names]
    if not rows:
        print(f"no drives measured in {results}")
        return
    table = pd.DataFrame(rows).set_index("drive")
    print(table.to_string(float_format="{:.3f}".format))
    kinds = table.groupby(lambda name: name.rpartition("_")[0]).mean()
    print()
    print(kinds.to_string(float_format="{:.3f}".format))


def _read_drive(place: Path) -> dict[str, str | float]:
    plan = pq.read_table(place / "evaluation/plan.parquet").to_pandas().set_index("frame")
    row = plan.loc[_FRAME]
    registered = registered_scans.read_registered_scans(place / "registration.parquet")
    # two columns are called right: of faces and of doors
    measures = {
        f"{i}. {label}": float(row.get(name, np.nan))
        for i, (name, label) in enumerate(_MEASURES.items(), 1)
    }
    return {"drive": place.name, "scans": row["n_scans"] / len(registered.t_ns), **measures}
