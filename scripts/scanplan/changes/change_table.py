"""What became of the elements of two surveys as a table, with how their frames were tied."""

import json
import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.comparison import Comparison
from scanplan.changes.frames import FrameTie
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.scan_plane import ScanPlane, are_one_plane
from scanplan.changes.verdicts import CHANGES, NOT_SEEN, SAME, STATES, Change
from scanplan.changes.wholes import list_wholes, number_wholes
from scanplan.plan.floorplan import say_count
from scanplan.types import Array

_TABLES = ("wall", "opening", "room", "column", "furniture")
_DIGITS = 6  # of what notes state: a thousandth of a millimetre


def tabulate_changes(changes: Sequence[Change]) -> dict[str, Array]:
    """Return the columns of `schemas.CHANGES`."""
    return {
        "change": np.arange(len(changes), dtype=np.int32),
        "element": np.array([c.table for c in changes], object),
        "number_a": np.array([c.number_a for c in changes], np.int32),
        "number_b": np.array([c.number_b for c in changes], np.int32),
        "verdict": np.array([c.verdict for c in changes], object),
        "p": np.array([c.p for c in changes], float),
        "likely": np.array([c.is_change for c in changes], bool),
        "kind_a": np.array([c.kind_a for c in changes], object),
        "kind_b": np.array([c.kind_b for c in changes], object),
        **tabulate_shapes(changes),
        "doubt": np.array([c.doubt for c in changes], object),
        "whole": number_wholes(changes).astype(np.int32),
    }


def tabulate_shapes(changes: Sequence[Change]) -> dict[str, Array]:
    """Return the columns of what was measured of elements, and where they are."""
    moved_m = np.array([of.moved_m for of in changes], float).reshape(-1, 2)
    return {
        "shift_m": np.array([of.shift_m for of in changes], float),
        "sigma_m": np.array([of.sigma_m for of in changes], float),
        "x_moved_m": moved_m[:, 0].copy(),
        "y_moved_m": moved_m[:, 1].copy(),
        **measure_shapes([of.shape for of in changes]),
    }


def measure_shapes(listed: Sequence[BaseGeometry]) -> dict[str, Array]:
    """Return the columns of how large shapes are: lengths of lines, areas of others, and all."""
    shapes = np.array(listed, object)
    is_line = shapely.get_dimensions(shapes) == 1 if len(shapes) else np.empty(0, bool)
    length_m, area_m2 = (measure(shapes) for measure in (shapely.length, shapely.area))
    return {
        "length_m": np.where(is_line, length_m, np.nan),
        "area_m2": np.where(is_line, np.nan, area_m2),
        "geometry": shapely.to_wkb(shapes, byte_order=1).astype(object),
    }


def state_tie(compared: Comparison) -> dict[str, str]:
    """Return the notes of `schemas.CHANGES`."""
    fit = compared.tie.fit
    stated = {
        "a": compared.a.plan.name,
        "b": compared.b.plan.name,
        "motion": _list_motion(fit.motion),
        "centre_m": _round(fit.centre_m),
        "covariance": fit.covariance.tolist(),
        "residual_m": round(fit.residual_m, _DIGITS),
        "share": round(compared.tie.share, _DIGITS),
        "others": [[*_list_motion(of), round(share, 3)] for of, share in compared.tie.others],
    }
    return {name: json.dumps(value) for name, value in stated.items()}


def _list_motion(motion: PlaneMotion) -> list[float]:
    return _round(np.array([motion.yaw_rad, motion.x_m, motion.y_m]))


def _round(values: Array) -> list[float]:
    return (np.round(values, _DIGITS) + 0.0).tolist()


def summarise_changes(changes: Sequence[Change]) -> list[str]:
    """Return in a line for each kind of element what became of it.

    Of walls by the length, too.
    """
    wholes = list_wholes(changes)
    return [line for table in _TABLES if (line := _summarise(table, wholes))]


def _summarise(table: str, wholes: Sequence[Sequence[Change]]) -> str:
    of_table = [parts for parts in wholes if parts[0].table == table]
    said = []
    for verdict in (*CHANGES, *STATES, SAME, NOT_SEEN):
        found = [parts for parts in of_table if parts[0].verdict == verdict]
        sure = [parts for parts in found if parts[0].is_told or not parts[0].is_other]
        if sure:
            length_m = sum(part.shape.length for parts in sure for part in parts)
            length = f" ({length_m:.1f} m)" if table == "wall" else ""
            said.append(f"{len(sure)} {verdict.replace('_', ' ')}{length}")
        if doubtful := sum(parts[0].is_doubtful for parts in found):
            said.append(f"{doubtful} maybe {verdict}")
        if others := len(found) - len(sure) - doubtful:
            said.append(f"{others} {verdict}, likely furniture")
    return f"{table}: {', '.join(said)}" if said else ""


def summarise_tie(tie: FrameTie) -> str:
    """Return in words how the frames of two surveys were tied."""
    fit = tie.fit
    sigma_m = math.sqrt(float(np.diag(fit.covariance)[:2].max()))
    sigma_deg = math.degrees(math.sqrt(float(fit.covariance[2, 2])))
    return (
        f"turned by {math.degrees(fit.motion.yaw_rad):+z.2f} ± {sigma_deg:.2f}°, shifted by"
        f" {fit.motion.x_m:+z.3f}, {fit.motion.y_m:+z.3f} ± {sigma_m:.3f} m; {tie.share:.0%} of the"
        f" walls agree within {fit.residual_m:.3f} m"
    )


def warn_of_others(tie: FrameTie) -> str:
    """Return in words which other motions fit nearly as well; nothing where none does."""
    if not tie.others:
        return ""
    turns = [
        f"{math.degrees(motion.yaw_rad - tie.fit.motion.yaw_rad) % 360:.0f}° ({share:.0%} agree)"
        for motion, share in tie.others
    ]
    others = say_count(len(turns), "other way")
    remedy = "hold the drawing against the floor, or survey what tells its sides apart"
    return f"the floor looks alike in {others}, turned by {', '.join(turns)}; {remedy}"


def warn_of_planes(compared: Comparison) -> str:
    """Return in words that two planar scanners looked at other heights; nothing if they did not."""
    planes = compared.a.sight.plane, compared.b.sight.plane
    if are_one_plane(*planes):
        return ""
    heights = " and ".join(_say_height(plane) for plane in planes if plane is not None)
    return f"planes of the scanners at {heights}: what one alone shows counts as not seen"


def _say_height(plane: ScanPlane) -> str:
    return f"{plane.height_m:.2f} m" if plane.row >= 0 else "an unknown height"
