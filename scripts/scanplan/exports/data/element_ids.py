"""GlobalIds that stay: an element keeps the id under which it was first seen, by its place."""

import string
import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.exports.envelope import NEAR_M
from scanplan.geometry import overlays
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, Columns, FloatArray, IntArray

KINDS = ("wall", "opening", "room")
"""Tables of the plan whose elements have ids."""
JOINED = "joined"
"""Column of a regular plan's walls: numbers of further pieces, see `joined_walls.join_walls`."""
_NAMESPACE = uuid.UUID("6f1c2c0e-6b0b-5f0e-9d55-3d2f6f0a7c11")  # ours, drawn once
# IFC's own alphabet: 22 characters of 6 bits for the 128 of a UUID
_ALPHABET = string.digits + string.ascii_uppercase + string.ascii_lowercase + "_$"

ElementIds = Mapping[str, Sequence[str]]
"""The GlobalIds of walls, openings and rooms, in the order of their tables."""


@dataclass(frozen=True)
class Elements:
    """Elements of plans.

    Attributes
    ----------
    kinds : (n,) str
        wall, room, or the type of an opening: a wall is never a room or an opening, and an opening
        of another type is the same only where none of its own type is.
    shapes : (n,) Polygons
        What they cover, metres in the map frame.
    """

    kinds: Array
    shapes: Array


def list_elements(plan: FloorPlan) -> Elements:
    """Return a plan's walls, openings and rooms, in this order and that of their tables."""
    kinds = [*["wall"] * len(plan.bodies), *plan.openings["type"], *["room"] * len(plan.areas)]
    shapes = [*plan.bodies, *plan.gaps, *plan.areas]
    return Elements(np.array(kinds, object), np.array(shapes, object))


def identify_elements(elements: Elements, known: Columns, name: str) -> list[str]:
    """Return the GlobalId of each element: that of a known one in its place, or a new one.

    Two of a table may be the same if half of the smaller lies in the other, each with 0.1 m around
    it: of a wall more or less is drawn. Of all ways to pair such elements that with the largest sum
    of intersections over unions is taken, which count half where an opening is of another type: a
    door that turns out to be a window is still what people wrote of. Elements that were known as
    they are keep their ids whatever else is known.

    Parameters
    ----------
    known : dict of str to (k,) array
        The columns of `schemas.KNOWN_ELEMENTS`.
    name : str
        The dataset's: a new id follows from it, the element's kind and its place.

    Returns
    -------
    list of str
        Unique, also among the known ones.
    """
    shapes = shapely.from_wkb(np.asarray(known["geometry"], object))
    ids = np.full(len(elements.kinds), "", object)
    of_table, known_of_table = tables_of(elements.kinds), tables_of(known["kind"])
    for table in KINDS:
        rows = np.flatnonzero(of_table == table)
        known_rows = np.flatnonzero(known_of_table == table)
        if not len(known_rows):
            continue
        shared = _shared_areas(elements.shapes[rows], shapes[known_rows])
        is_of_type = elements.kinds[rows, None] == known["kind"][known_rows]
        kept = _pair_most(np.where(is_of_type, shared, shared / 2))
        ids[rows[kept[:, 0]]] = known["global_id"][known_rows[kept[:, 1]]]
    taken = set(known["global_id"].tolist())
    for row in np.flatnonzero(ids == ""):
        ids[row] = _new_id(name, elements.kinds[row], elements.shapes[row], taken)
        taken.add(ids[row])
    return ids.tolist()


def merge_known(elements: Elements, ids: Sequence[str], known: Columns) -> dict[str, Array]:
    """Return the columns of `schemas.KNOWN_ELEMENTS` with the elements that are new."""
    is_new = ~np.isin(np.array(ids, object), known["global_id"])
    columns = {
        "kind": elements.kinds[is_new],
        "global_id": np.array(ids, object)[is_new],
        "geometry": shapely.to_wkb(elements.shapes[is_new]),
    }
    merged = {n: np.concatenate([known[n], values]) for n, values in columns.items()}
    keys = list(zip(merged["kind"].tolist(), merged["global_id"].tolist(), strict=True))
    order = sorted(range(len(keys)), key=keys.__getitem__)
    return {n: values[order] for n, values in merged.items()}


def tabulate_ids(plan: FloorPlan, ids: Sequence[str]) -> dict[str, Array]:
    """Return the columns of `schemas.ELEMENT_IDS` of the ids of `list_elements`."""
    numbers = [(kind, number) for kind in KINDS for number in _table(plan, kind)[kind].tolist()]
    rows = sorted((*key, global_id) for key, global_id in zip(numbers, ids, strict=True))
    kinds, of_kind, global_ids = zip(*rows, strict=True) if rows else ((), (), ())
    return {
        "kind": np.array(kinds, object),
        "number": np.array(of_kind, np.int32),
        "global_id": np.array(global_ids, object),
    }


def ids_of_table(columns: Columns) -> ElementIds:
    """Return the ids of a table with the columns of `schemas.ELEMENT_IDS`."""
    return {kind: columns["global_id"][columns["kind"] == kind].tolist() for kind in KINDS}


def take_ids(ids: ElementIds, plan: FloorPlan, part: FloorPlan) -> ElementIds:
    """Return the ids of those elements of a plan that a part of it has, by their numbers.

    Of a regular plan also `joined`: of each wall the numbers and ids of its further pieces.
    """
    taken: dict[str, list[str]] = {}
    for kind in KINDS:
        of_number = dict(zip(_table(plan, kind)[kind].tolist(), ids[kind], strict=True))
        taken[kind] = [of_number[number] for number in _table(part, kind)[kind].tolist()]
    if JOINED in part.walls:
        of_wall = dict(zip(map(str, plan.walls["wall"].tolist()), ids["wall"], strict=True))
        pieces = [str(numbers).split() for numbers in part.walls[JOINED]]
        taken[JOINED] = [", ".join(f"{n} {of_wall[n]}" for n in numbers) for numbers in pieces]
    return taken


def ids_from_places(plan: FloorPlan) -> ElementIds:
    """Return the ids that a plan's elements have where none was known before."""
    elements = list_elements(plan)
    ids = identify_elements(elements, no_known(), plan.name)
    return ids_of_table(tabulate_ids(plan, ids))


def no_known() -> dict[str, Array]:
    """Return the columns of `schemas.KNOWN_ELEMENTS` without rows."""
    return {name: np.array([], object) for name in ("kind", "global_id", "geometry")}


def derive_id(*words: object) -> str:
    """Return the GlobalId that follows from words and numbers, 22 characters of IFC's alphabet."""
    number = uuid.uuid5(_NAMESPACE, "/".join(map(str, words))).int
    digits = [number >> 6 * place & 63 for place in reversed(range(22))]
    return "".join(_ALPHABET[digit] for digit in digits)


def grow_shapes(shapes: Array) -> Array:
    """Return shapes with as much around them as what lies near is away, by which they compare."""
    return overlays.buffer_shapes(shapes, NEAR_M, join_style="mitre")


def _table(plan: FloorPlan, kind: str) -> Columns:
    return {"wall": plan.walls, "opening": plan.openings, "room": plan.rooms}[kind]


def tables_of(kinds: Array) -> Array:
    """Return in which of `KINDS` elements of some kinds are: types of openings are all of one."""
    kinds = np.asarray(kinds, str)
    return np.where(np.isin(kinds, KINDS), kinds, "opening")


def _pair_most(shared: FloatArray) -> IntArray:
    """Return the pairs (k, 2) of rows and columns that share most, of those that share any."""
    from scipy.optimize import linear_sum_assignment  # 0.3 s, and no first plan needs it

    pairs = np.column_stack(linear_sum_assignment(shared, maximize=True))
    return pairs[shared[*pairs.T] > 0]


def _shared_areas(shapes: Array, known: Array) -> FloatArray:
    """Return the intersection over union (n, k) of shapes and known ones; 0 where too little."""
    grown, grown_known = grow_shapes(shapes), grow_shapes(known)
    shared = np.zeros((len(shapes), len(known)))
    tree = shapely.STRtree(grown_known)
    rows, others = tree.query(grown, predicate="intersects")
    common = shapely.area(overlays.intersect_areas(grown[rows], grown_known[others]))
    areas, known_areas = shapely.area(grown)[rows], shapely.area(grown_known)[others]
    is_enough = common >= np.minimum(areas, known_areas) / 2
    shared[rows, others] = np.where(is_enough, common / (areas + known_areas - common), 0.0)
    return shared


def _new_id(name: str, kind: str, shape: shapely.Polygon, taken: set[str]) -> str:
    # to a millimetre, below any plan's precision; + 0.0 turns a negative zero into zero
    corners = np.round(shapely.get_coordinates(shape).ravel(), 3) + 0.0
    words = [name, kind, *corners.tolist()]
    while (global_id := derive_id(*words)) in taken:
        words.append("again")
    return global_id
