"""A survey of a merged cloud: scans that places on its floor would make of its points.

All that is known of the building is where its points are. Nothing says from where one was seen, so
that what has no points may be open, or not scanned.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial

import numpy as np

from scanplan.errors import MOST_NAMED, StageError
from scanplan.recordings import frame_edges, map_origin
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.merged import storeys
from scanplan.recordings.merged.lattice import Lattice, ThinnedCloud
from scanplan.recordings.merged.views import RayCaster
from scanplan.recordings.motion.pose_kind import STATIONS
from scanplan.recordings.posed_scans import UntimedScans
from scanplan.stage import log
from scanplan.types import Array, FloatArray

Blocks = Callable[[], Iterator[FloatArray]]
"""Returns an iterator over points (n, 3) float64, some at a time, and always in the same order."""

_EDGE_M = 0.03  # of cubes that rays end at: half of a thin partition
_COARSEST_M = 0.12  # more is no wall any more
_MOST_CUBES = 12_000_000  # 0.7 GB while they are merged; 1,000 m2 of a furnished floor at 3 cm
_LEAST_FILLED = 3.0  # cubes to one of twice their size: surfaces that are closed have four
_AZIMUTHS = 360  # a cube at 1.7 m: where several rays end at one the others would count as lost
_ELEVATIONS_DEG = np.arange(-60.0, 61.0, 2.0)  # nearer floor and ceiling other places see
_REACH_M = 20.0  # beyond it rays of a degree are 35 cm apart
_EYE_M = 1.4  # over the floor, as tripods stand: above tables, below door heads
_BELOW_M = 0.5  # of the floor: steps, and what leans
_APART_NS = 3600 * 10**9  # of stamps: so long that no limit of a drive's pace is met
_LEAST_PLACES = 3  # what one place sees is a scan, and no survey
_HIGH_M = 6.5  # storeys of 2.1 to 4 m have 7 to 13 feet; halls are so high in metres, too
_EXPORT = (
    "z is to be up, in metres (else set advanced.input.cloud_unit), and floors are to be in the"
    " cloud; export it so"
)


class MergedCloud(UntimedScans):
    """Scans from places all over the clear floor of one storey of a cloud.

    Files are gone through twice: for the floors, and for the points of the storey, of which one
    in each cube of some centimetres is kept.

    Parameters
    ----------
    where : str
        The files, for errors.
    storey : int or None
        Its number, 0 the lowest; by default the one with most floor.
    reading : CloudReading
        By default the poses are exact.

    Raises
    ------
    StageError
        If a file is damaged, or shows too little floor.
    """

    def __init__(
        self,
        where: str,
        sources: Sequence[Blocks],
        reading: CloudReading,
        *,
        storey: int | None = None,
    ) -> None:
        self._sources = [partial(_read_metres, blocks, reading.units.cloud_m) for blocks in sources]
        self._outline = _thin(where, self._sources, storeys.CELL_M)
        columns = storeys.find_floor(self._outline.keys, self._outline.xyz_m[:, 2])
        self._storeys = storeys.find_storeys(columns)
        self._number = _choose_storey(where, self._storeys, storey)
        try:
            xy_m = storeys.choose_places(columns, self._storeys[self._number])
        except ValueError:
            raise StageError(
                f"{where}: its floor goes on for more than the {storeys.MOST_CELLS:,} cells of"
                f" {storeys.CELL_M} m that are read; cut the cloud"
            ) from None
        if len(xy_m) < _LEAST_PLACES:
            raise StageError(
                f"{where}: clear floor for {len(xy_m)} places to look from, {_LEAST_PLACES} are"
                f" needed: {_EXPORT}"
            )
        eye_m = self._storeys[self._number].floor_z_m + _EYE_M
        self._places_m = np.column_stack([xy_m, np.full(len(xy_m), eye_m)])
        stamps_ns = np.arange(1, len(xy_m) + 1) * _APART_NS
        level = np.tile([0.0, 0.0, 0.0, 1.0], (len(xy_m), 1))
        xyz_m = self._places_m + self._outline.lattice.origin_m
        xyz_m -= map_origin.find_origin(where, xyz_m)
        track = frame_edges.FrameEdge("map", "sensor", xyz_m, level, stamps_ns)
        super().__init__(where, track, stamps_ns, STATIONS, reading)

    def describe_rays(self) -> list[str]:
        """Return what a plan of points alone is worth, and which storeys there are."""
        said = (
            f"a merged cloud alone, no rays: the plan is what {len(self._places_m)} places on its"
            " floor would see of it; what nobody scanned looks open, and no ray tells whether it is"
        )
        told = [said]
        clear_m = self._storeys[self._number].clear_m
        if clear_m > _HIGH_M:
            told.append(
                f"the ceiling is {clear_m:.1f} m above the floor: a hall, or the file is in feet;"
                " if so set advanced.input.cloud_unit: ft"
            )
        if len(self._storeys) == 1:
            return told
        origin_z_m = self._outline.lattice.origin_m[2]
        listed = [
            f"{number} with its floor at z {floor.floor_z_m + origin_z_m:.1f} m"
            f" ({floor.area_m2:.0f} m2)"
            for number, floor in enumerate(self._storeys[:MOST_NAMED])
        ]
        return [
            *told,
            f"{len(self._storeys)} storeys by height: {', '.join(listed)}; this is storey"
            f" {self._number}, advanced.input.storey gives the number of another",
        ]

    def read_cloud(self, scan_id: int) -> tuple[FloatArray, Array | None]:
        """Return the points (n, 3) float32 at which rays from a place end, axes as the map's."""
        caster, xyz_m = self._surfaces
        from_m = self._places_m[scan_id]
        hit = np.unique(caster.cast(from_m, _list_rays(), _REACH_M))
        return (xyz_m[hit[hit >= 0]] - from_m).astype(np.float32), None

    @cached_property
    def _surfaces(self) -> tuple[RayCaster, FloatArray]:
        """The cubes of the storey, and a point of each."""
        floor_z_m = self._storeys[self._number].floor_z_m
        above = [floor.floor_z_m for floor in self._storeys[self._number + 1 :]]
        low_m = np.append(self._places_m.min(axis=0)[:2] - _REACH_M, floor_z_m - _BELOW_M)
        # no ray goes higher: strays may lie kilometres up
        high_m = self._places_m.max(axis=0) + _REACH_M
        if above:
            # the floor above, and what stands on it, is not of this storey
            high_m[2] = above[0] - 1.5 * storeys.CELL_M
        origin_m = self._outline.lattice.origin_m
        cloud = ThinnedCloud(Lattice(np.zeros(3), _EDGE_M), _MOST_CUBES)
        for read_blocks in self._sources:
            for file_m in read_blocks():
                xyz_m = file_m - origin_m
                cloud.add(xyz_m[((xyz_m > low_m) & (xyz_m < high_m)).all(axis=1)])
        _close_surfaces(self.where, cloud)
        log.log_line(
            f"{self.where}: {len(cloud.keys):,} cubes of {cloud.lattice.edge_m * 100:g} cm with"
            f" points, {len(self._places_m)} places to look from"
        )
        return RayCaster(cloud.keys, cloud.lattice.edge_m), cloud.xyz_m


def _read_metres(read_blocks: Blocks, unit_m: float) -> Iterator[FloatArray]:
    return (unit_m * block for block in read_blocks())


def _thin(where: str, sources: Sequence[Blocks], edge_m: float) -> ThinnedCloud:
    """Return a cloud as cubes of one size; far strays, and what is no place, are counted."""
    cloud = None
    n_points = n_left = 0
    for read_blocks in sources:
        for xyz_m in read_blocks():
            finite_m = xyz_m[np.isfinite(xyz_m).all(axis=1)]
            n_points += len(xyz_m)
            n_left += len(xyz_m) - len(finite_m)
            if cloud is None and len(finite_m):
                # a stray may come first
                origin_m = np.floor(np.median(finite_m, axis=0))
                cloud = ThinnedCloud(Lattice(origin_m, edge_m), _MOST_CUBES)
            if cloud is not None:
                n_left += cloud.add(finite_m)
    if cloud is None:
        raise StageError(f"{where}: none of its {n_points:,} points is a place; export it again")
    if len(cloud.keys) and cloud.lattice.edge_m > edge_m:
        raise StageError(
            f"{where}: goes through more than {_MOST_CUBES:,} cubes of {edge_m} m; cut the cloud,"
            " or set advanced.input.cloud_unit if it is not in metres"
        )
    log.log_line(
        f"{where}: a merged cloud of {n_points:,} points, {n_left:,} of which are not finite or lie"
        " far from all others"
    )
    return cloud


def _choose_storey(where: str, found: Sequence[storeys.Storey], asked: int | None) -> int:
    """Return the number of the storey to plan."""
    if not found:
        raise StageError(
            f"{where}: shows no floor of 4 m2 with walls over it and a person's height of nothing:"
            f" {_EXPORT}"
        )
    if asked is None:
        return max(range(len(found)), key=lambda number: found[number].area_m2)
    if asked >= len(found):
        raise StageError(
            f"{where}: has {len(found)} storeys by height, numbered from 0, and there is no"
            f" {asked}; give another as advanced.input.storey"
        )
    return asked


def _close_surfaces(where: str, cloud: ThinnedCloud) -> None:
    """Make cubes so large that those of a surface lie side by side, and let no ray through."""
    while cloud.lattice.edge_m <= _COARSEST_M and cloud.count_in_larger() < _LEAST_FILLED:
        cloud.coarsen()
    if cloud.lattice.edge_m > _COARSEST_M:
        raise StageError(
            f"{where}: its points make no closed surfaces of cubes of {_COARSEST_M * 100:g} cm, or"
            f" more than {_MOST_CUBES:,} of these; export a point for every 5 cm at least, or cut"
            " the cloud"
        )


def _list_rays() -> FloatArray:
    azimuth = np.arange(_AZIMUTHS) * 2 * np.pi / _AZIMUTHS
    turn, rise = np.meshgrid(azimuth, np.radians(_ELEVATIONS_DEG), indexing="ij")
    level = np.cos(rise)
    direction = np.stack([level * np.cos(turn), level * np.sin(turn), np.sin(rise)], axis=-1)
    return direction.reshape(-1, 3)
