"""What is true of a survey: the walls that its scans could see, and the sensor's poses."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.lab.buildings.tolerances import CRACK_M
from scanplan.lab.buildings.truth import Feature
from scanplan.lab.evaluation import face_cells, visible_faces
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.types import Array, BoolArray, FloatArray

_PARALLEL_SINE = 0.1  # of the angle of a face to its wall, 6 degrees: its jambs stand across


def mark_visible(
    features: Sequence[Feature], poses: FloatArray, sensor: visible_faces.SensorView
) -> list[Feature]:
    """Return features with the length of inner faces and walls that a scan could see: `visible_m`.

    Parameters
    ----------
    features : sequence of (geometry, dict)
        `truth.truth_features` of a floor.
    poses : (m, 4, 4) float
        The sensor's at all scans, world_from_sensor.

    Returns
    -------
    list of (geometry, dict)
        As given, nothing is changed; of a wall both its faces count.
    """
    inner = [i for i, (_, values) in enumerate(features) if values.get("side") == "inside"]
    faces = select_faces(features)
    cells = face_cells.cut_faces(faces.inner_m)
    is_pane = np.array([features[i][1].get("material") == "glass" for i in inner], bool)
    is_seen = np.zeros(len(cells.face), bool)
    # panes hide other panes, and nothing else
    for chosen, others_m in ((~is_pane, faces.outer_m), (is_pane, _all_but(faces, is_pane))):
        is_seen[chosen[cells.face]] = visible_faces.cells_seen_by_any(
            face_cells.cut_faces(faces.inner_m[chosen]), others_m, poses, sensor
        )
    middles = np.asarray(shapely.points(cells.middle_m), object)
    length_m = np.where(is_seen, cells.length_m, 0.0)
    by_face_m = np.bincount(cells.face, length_m, len(inner))
    visible_m = dict(zip(inner, by_face_m.tolist(), strict=True))
    for i, (geometry, values) in enumerate(features):
        if values["kind"] == "wall":
            widest_m = max(values["thickness_m"], values.get("end_thickness_m", 0.0))
            on_wall = _on_wall(geometry, widest_m, cells, middles)
            visible_m[i] = float(length_m[on_wall].sum())
    return [
        (g, {**values, "visible_m": round(visible_m[i], 3)} if i in visible_m else values)
        for i, (g, values) in enumerate(features)
    ]


def _all_but(faces: TrueFaces, chosen: BoolArray) -> FloatArray:
    """Return all faces but those inner ones."""
    return np.concatenate([faces.inner_m[~chosen], faces.outer_m])


def select_faces(features: Sequence[Feature]) -> TrueFaces:
    """Return the faces of a floor's features, as `truth_file.read_true_faces` of their file."""
    inner = [line for line, values in features if values.get("side") == "inside"]
    outer = [line for line, values in features if _only_occludes(values)]
    return TrueFaces(_ends_m(inner), _ends_m(outer))


def _only_occludes(values: dict) -> bool:
    return values["kind"] == "screen" or values.get("side") == "outside"


def _ends_m(lines: Sequence[BaseGeometry]) -> FloatArray:
    """Return the ends (n, 2, 2) of straight lines."""
    return np.array([line.coords for line in lines]).reshape(-1, 2, 2)


def _on_wall(
    line: BaseGeometry, thickness_m: float, cells: face_cells.FaceCells, middles: Array
) -> BoolArray:
    """Return which cells (c,), with their middles as Points, are of a straight wall's faces."""
    is_beside = shapely.dwithin(middles, line, thickness_m / 2 + CRACK_M)
    face = np.diff(cells.faces_m, axis=1)[:, 0]
    wall = np.diff(line.coords, axis=0)[0]
    sine = (
        np.abs(face[:, 0] * wall[1] - face[:, 1] * wall[0])
        / np.linalg.norm(face, axis=1)
        / np.linalg.norm(wall)
    )
    return is_beside & (sine < _PARALLEL_SINE)[cells.face]
