"""A survey of a grid map, as slam_toolbox and nav2 save it: scans that its cells would give.

All that is known of the building is the map: where a robot could see free floor, and which cells
were occupied. Scans are taken in free cells, level; beams end at the first occupied cell, and
nowhere where the map is unknown.
"""

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.project import yaml_file
from scanplan.recordings import frame_edges
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.motion import point_times
from scanplan.recordings.motion.pose_kind import STATIONS
from scanplan.recordings.posed_scans import PosedScans
from scanplan.recordings.units import IN_METRES
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_BEAMS = 720  # half a degree: a cell of 5 cm at 6 m
_REACH_M = 20.0  # as lasers of robots have
_APART_M = 0.75  # of places: each part of a room is seen from several
_CLEAR_M = 0.25  # of obstacles: a robot's radius
_OPEN_M = 2.0  # of obstacles: farther from them no place sees more
_TILE = 1024  # cells: their distances take 50 MB
_MOST_CELLS = 64_000_000  # as of the map that is exported
_FINEST_M, _COARSEST_M = 0.005, 0.25  # of a cell: coarser ones show no door
_APART_NS = 3600 * 10**9  # of stamps: so long that no limit of a drive's pace is met
_LEAST_PLACES = 3
_MOST_PLACES = 3000  # 1,700 m2 of floor; of more they are farther apart, as rays reach
_FARTHEST_M = 8000.0  # as of other poses: single precision loses millimetres beyond
_MODES = ("trinary", "scale", "raw")
_UNKNOWN_GREY = 205
"""Of trinary maps as they are saved, be it less than the `free_thresh` of 0.25 that nav2 states."""
_MOST_RAW = 100  # per cent


class _Grid(NamedTuple):
    """A map's cells; row 0 is that of the least y in the frame of the grid."""

    free: BoolArray
    occupied: BoolArray
    cell_m: float
    map_from_grid: FloatArray  # (4, 4)


class GridMapScans(PosedScans):
    """Level scans from places all over the free floor of a grid map.

    Parameters
    ----------
    files : sequence of str
        The map's .yaml and its image.
    reading : CloudReading
        By default the poses are exact.

    Raises
    ------
    StageError
        If they are no map, or show too little free floor.
    """

    def __init__(self, files: Sequence[str], reading: CloudReading) -> None:
        path = next(Path(file) for file in files if file.endswith((".yaml", ".yml")))
        if reading.units != IN_METRES:
            raise StageError(
                f"{path}: a grid map states its resolution in metres; leave out"
                " advanced.input.cloud_unit and advanced.input.pose_unit"
            )
        self._grid = _read_grid(path)
        cells = _choose_places(self._grid)
        if len(cells) < _LEAST_PLACES:
            raise StageError(
                f"{path}: free floor for {len(cells)} places to look from, {_LEAST_PLACES} are"
                " needed; check free_thresh, negate and resolution"
            )
        xy_m = (cells[:, ::-1] + 0.5) * self._grid.cell_m
        stamps_ns = np.arange(1, len(xy_m) + 1) * _APART_NS
        poses = np.tile(np.eye(4), (len(xy_m), 1, 1))
        poses[:, :2, 3] = xy_m
        track = frame_edges.FrameEdge(
            "map", "sensor", *se3.split_pose(self._grid.map_from_grid @ poses), stamps_ns
        )
        super().__init__(str(path), track, stamps_ns, STATIONS, reading)
        self._xy_m = xy_m

    def describe_rays(self) -> list[str]:
        """Return what a plan of a map alone is worth, in a sentence."""
        return [
            f"a grid map alone, no scans: the plan is what {len(self._xy_m)} places in its free"
            f" floor would see, to half a cell of {self._grid.cell_m:g} m; what furniture, people"
            " and shut doors hid is as the map has it"
        ]

    @property
    def planar(self) -> bool:
        """Whether they lie in one plane: always."""
        return True

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """No times: nothing moves."""
        return None

    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return where beams from a place end, (n, 3) float32: in the first occupied cell."""
        angle = np.arange(_BEAMS) * 2 * np.pi / _BEAMS
        direction = np.column_stack([np.cos(angle), np.sin(angle)])
        xy_m = _cast_beams(self._grid, self._xy_m[scan_id], direction)
        return np.column_stack([xy_m, np.zeros(_BEAMS)]).astype(np.float32), None


def _cast_beams(grid: _Grid, from_m: FloatArray, direction: FloatArray) -> FloatArray:
    """Return the middles (n, 2), from there, of the first cells that beams (n, 2) meet occupied.

    NaN without one. Where a beam enters a cell is nearer than what was measured in it.
    """
    step_m = grid.cell_m / 4  # a beam cuts no corner of a cell by more
    along_m = np.arange(1, int(_REACH_M / step_m)) * step_m
    ends_m = np.full((len(direction), 2), np.nan)
    is_going = np.ones(len(direction), bool)
    for part_m in np.array_split(along_m, max(1, len(along_m) // 64)):
        rows = np.flatnonzero(is_going)
        if len(rows) == 0:
            break
        places = from_m + direction[rows, None] * part_m[:, None]
        column, row = np.moveaxis(np.floor(places / grid.cell_m).astype(int), -1, 0)
        is_inside = (row >= 0) & (row < grid.free.shape[0])
        is_inside &= (column >= 0) & (column < grid.free.shape[1])
        row, column = np.where(is_inside, row, 0), np.where(is_inside, column, 0)
        is_free = is_inside & grid.free[row, column]
        first = np.argmin(is_free, axis=1)
        beams = np.arange(len(rows))
        ends = ~is_free[beams, first]
        hits = ends & is_inside[beams, first]
        hits &= grid.occupied[row[beams, first], column[beams, first]]
        cell = np.column_stack([column[beams, first], row[beams, first]])
        middle_m = (cell + 0.5) * grid.cell_m
        ends_m[rows[hits]] = (middle_m - from_m)[hits]
        is_going[rows[ends]] = False
    return ends_m


def _choose_places(grid: _Grid) -> IntArray:
    """Return cells (n, 2), row and column: of each square of the floor the one most in the open."""
    clear_m = _measure_clearance(grid)
    clear_m2 = np.count_nonzero(clear_m >= _CLEAR_M) * grid.cell_m**2
    apart_m = max(_APART_M, (clear_m2 / _MOST_PLACES) ** 0.5)
    row = np.arange(len(clear_m)) * grid.cell_m // apart_m
    bands = np.split(np.arange(len(row)), np.flatnonzero(np.diff(row)) + 1)
    # a band of squares after the other: cells that are clear may be millions
    chosen = [_choose_in_band(clear_m[band], grid.cell_m, apart_m) for band in bands]
    for cells, band in zip(chosen, bands, strict=True):
        cells[:, 0] += band[0]
    return np.concatenate(chosen)


def _measure_clearance(grid: _Grid) -> FloatArray:
    """Return how far each cell (rows, columns) float32 is from what is not free, at most `_OPEN_M`.

    What is beyond the map is not free.
    """
    from scipy import ndimage  # 0.1 s, and other recordings do without

    margin = math.ceil(_OPEN_M / grid.cell_m)
    padded = np.pad(grid.free, margin)
    clear_m = np.zeros(grid.free.shape, np.float32)
    for first_row, first_column in itertools.product(*(range(0, n, _TILE) for n in clear_m.shape)):
        tile = clear_m[first_row : first_row + _TILE, first_column : first_column + _TILE]
        rows, columns = (n + 2 * margin for n in tile.shape)
        around = padded[first_row : first_row + rows, first_column : first_column + columns]
        if around.all():
            tile[:] = _OPEN_M
        elif around.any():
            far = np.asarray(ndimage.distance_transform_edt(around))[margin:-margin, margin:-margin]
            np.minimum(far * grid.cell_m, _OPEN_M, out=tile, casting="same_kind")
    return clear_m


def _choose_in_band(clear_m: FloatArray, cell_m: float, apart_m: float) -> IntArray:
    """Return the cells (n, 2) of `_choose_places` in one band of squares."""
    cells = np.argwhere(clear_m >= _CLEAR_M)
    square = (cells[:, 1] * cell_m // apart_m).astype(np.int64)
    most = clear_m[tuple(cells.T)]
    order = np.lexsort((cells[:, 1], cells[:, 0], -most, square))
    is_first = np.diff(square[order], prepend=-1) != 0
    return cells[order[is_first]]


def _read_grid(path: Path) -> _Grid:
    values = yaml_file.read_yaml(path)
    try:
        image_path = path.parent / values["image"]
        cell_m = float(values["resolution"])
        x_m, y_m, yaw_rad = map(float, values["origin"])
        free_below = float(values.get("free_thresh", 0.25))
        occupied_above = float(values.get("occupied_thresh", 0.65))
        is_negated = bool(int(values.get("negate", 0)))
        mode = _MODES.index(values.get("mode", _MODES[0]))
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise StageError(
            f"{path}: is no map of map_server ({error}): it has image, resolution, origin (x, y,"
            f" yaw), negate, occupied_thresh, free_thresh and mode ({', '.join(_MODES)}); mend it"
        ) from None
    if not _FINEST_M <= cell_m <= _COARSEST_M:
        raise StageError(
            f"{path}: resolution {cell_m:g} m: cells of {_FINEST_M} to {_COARSEST_M} m are read;"
            " save the map so"
        )
    if not (max(abs(x_m), abs(y_m)) < _FARTHEST_M and math.isfinite(yaw_rad)):
        raise StageError(
            f"{path}: origin {x_m:g}, {y_m:g}, {yaw_rad:g}: is to lie within {_FARTHEST_M:g} m and"
            " have a yaw; save the map so"
        )
    map_from_grid = se3.pose_matrix(
        [x_m, y_m, 0.0], [0.0, 0.0, math.sin(yaw_rad / 2), math.cos(yaw_rad / 2)]
    )
    grey, is_opaque = _read_image(image_path)
    if _MODES[mode] == "raw":
        occupied = grey / np.float32(_MOST_RAW)
        is_known = grey <= _MOST_RAW
    else:
        grey = grey if not is_negated else 255 - grey
        occupied = 1.0 - grey / np.float32(255)
        is_known = is_opaque & ((grey != _UNKNOWN_GREY) | (_MODES[mode] != "trinary"))
    free = is_known & (occupied < free_below)
    occupied = is_known & (occupied > occupied_above)
    return _Grid(free[::-1], occupied[::-1], cell_m, map_from_grid)


def _read_image(path: Path) -> tuple[Array, BoolArray | np.bool]:
    """Return the grey values (rows, columns) of an image, 0 to 255, and where it is opaque."""
    try:
        with Image.open(path) as image:
            if image.width * image.height > _MOST_CELLS:
                raise StageError(
                    f"{path}: {image.width} x {image.height} cells, more than {_MOST_CELLS}; cut"
                    " the map"
                )
            is_opaque = np.True_
            if image.has_transparency_data:
                is_opaque = np.asarray(image.convert("LA").getchannel("A")) == 255
            return np.asarray(image.convert("L")), is_opaque
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        reason = " ".join(str(error).split())[:100]
        raise StageError(f"{path}: damaged ({reason}); save the map again") from error
