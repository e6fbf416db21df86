"""What two commits make of the same floors, element by element."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import shapely

from scanplan.lab.evaluation.scores import score
from scanplan.types import Array, BoolArray

_NEAR_M = 0.15  # wider than faces of one wall err, narrower than a wall: one element in two plans
_LEAST = 5e-4  # of a mean that is printed as changed: the noise of the third digit
_COSTS = ("_s", "_mb")
_LEAST_COST = 0.1  # of seconds and memory, which differ from run to run
_MOST_SHOWN = 12  # floors of a list; the tables have all


@dataclass(frozen=True)
class Change:
    """An error that one of two plans of a floor has, or the measures of both."""

    floor: str
    table: str
    verdict: str
    healed: bool
    size: float


def compare(before: Path, after: Path) -> None:
    """Print which measures and which errors of floors changed between two folders of scores."""
    _compare_measures(before, after)
    changes = list(_find_changes(before, after))
    for healed, words in ((True, "healed"), (False, "new")):
        count = Counter((c.table, c.verdict) for c in changes if c.healed is healed)
        size: dict[tuple[str, str], float] = {}
        for change in (c for c in changes if c.healed is healed):
            key = (change.table, change.verdict)
            size[key] = size.get(key, 0.0) + change.size
        for key, number in count.most_common():
            print(f"  {words}: {key[0]} {key[1]}: {number} elements, {size[key]:.1f} m or m2")
    for healed, words in ((False, "worse"), (True, "better")):
        floors = Counter(c.floor for c in changes if c.healed is healed)
        listed = ", ".join(f"{floor} {n}" for floor, n in floors.most_common(_MOST_SHOWN))
        print(f"{words} on {len(floors)} floors: {listed or 'none'}")


def _compare_measures(before: Path, after: Path) -> None:
    old, new = (
        pq.read_table(folder / "measures.parquet").to_pandas().set_index("floor")
        for folder in (before, after)
    )
    both = old.index.intersection(new.index)
    for words, one, other in (("lost", old, new), ("new", new, old)):
        planned = both[(one.loc[both, "failed"] == "") & (other.loc[both, "failed"] != "")]
        if len(planned):
            print(f"plans {words}: {', '.join(planned)}")
    names = [c for c in new.select_dtypes("number").columns if c in old.columns]
    for half in dict.fromkeys(new.loc[both, "half"]):
        rows = new.index[(new["half"] == half) & new.index.isin(both)]
        print(f"{half}: {len(rows)} floors")
        for name in names:
            # means of other floors tell nothing of a change
            known = rows[old.loc[rows, name].notna() & new.loc[rows, name].notna()]
            a, b = old.loc[known, name].mean(), new.loc[known, name].mean()
            least = _LEAST_COST * a if name.endswith(_COSTS) else _LEAST
            if abs(a - b) > least:
                print(f"  {name}: {a:.4f} -> {b:.4f} ({len(known)} floors)")


def _find_changes(before: Path, after: Path) -> Iterator[Change]:
    """Yield the errors of one plan that the other has not: healed ones, and new ones."""
    old, new = (_read_errors(folder) for folder in (before, after))
    for floor in sorted(set(old) & set(new)):
        for mine, other, healed in ((old, new, True), (new, old, False)):
            rows = mine[floor]
            gone = ~_has_like(rows, other[floor])
            for i in np.flatnonzero(gone).tolist():
                yield Change(
                    floor,
                    str(rows["table"][i]),
                    str(rows["verdict"][i]),
                    healed,
                    float(rows["size"][i]),
                )


def _read_errors(folder: Path) -> dict[str, Mapping[str, Array]]:
    """Return the columns of the elements that are wrong or missing, by floor."""
    elements = pq.read_table(folder / "elements.parquet").to_pandas()
    wrong = elements[~elements["verdict"].isin(("right", *score.UNCOUNTED))]
    floors = {str(name): rows for name, rows in wrong.groupby("floor")}
    none = wrong.iloc[:0]
    return {
        str(name): {c: floors.get(str(name), none)[c].to_numpy() for c in none.columns}
        for name in elements["floor"].unique()
    }


def _has_like(rows: Mapping[str, Array], others: Mapping[str, Array]) -> BoolArray:
    """Return which errors have one of the same table and verdict at their place, for most of it."""
    shapes, other = (shapely.from_wkb(np.asarray(r["geometry"], object)) for r in (rows, others))
    found = np.zeros(len(shapes), bool)
    for i, shape in enumerate(shapes):
        alike = (others["table"] == rows["table"][i]) & (others["verdict"] == rows["verdict"][i])
        if not alike.any():
            continue
        ground = shapely.union_all(shapely.buffer(other[alike], _NEAR_M))
        whole = shape.area or shape.length
        part = shapely.intersection(shape, ground)
        shared = part.area if shape.area else part.length
        found[i] = shared > whole / 2 if whole else shapely.intersects(shape, ground)
    return found
