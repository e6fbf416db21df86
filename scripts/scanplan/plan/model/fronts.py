"""Fronts of glass: lines along which rays that come square are answered, and others pass."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry import intersections
from scanplan.geometry.lines import Line
from scanplan.plan.model import front_rows, glass_views, line_labels, priors, surface_counts
from scanplan.plan.model.front_rows import FrontRow
from scanplan.plan.model.line_labels import Stretch
from scanplan.plan.model.surface_counts import SQUARE, Side, SurfaceCounts
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M, FACE_M
from scanplan.rays.ray_set import RaySet, gather_rays
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import BoolArray, FloatArray, IntArray

_EVERY_M = 0.25  # scans nearer to one another show the same of a pane that is 1 m away
_EVERY_IN_SPACE_M = 0.5  # and of one that is 2 m away: beams above and below show more of it
_AT_ONCE = 20  # scans: few, as their points are in memory beside their rays
_THROUGH = 0.5  # of the rays to a row: what more of come through panes is outside, or mirrored


@dataclass(frozen=True, eq=False)
class Fronts:
    """What is glass, and where one goes through it.

    Attributes
    ----------
    panes : list of (lines.Line, float, float)
        From where to where along a line there is glass, posts with it.
    ways_m : list of (2, 2) float64
        Doors in it, from jamb to jamb.
    """

    panes: list[tuple[Line, float, float]]
    ways_m: list[FloatArray]


@dataclass(frozen=True, eq=False)
class DenseScans:
    """Scans from all along the way, one of each place.

    Attributes
    ----------
    read : callable
        Returns `scan_id` and points (n, 3) in the map frame of some scans.
    registered : registered_scans.RegisteredScans
        All retained scans.
    planar : bool
        Whether they lie in one plane.
    left_out : dict of int to (72,) bool, optional
        See `ray_set.gather_rays`.
    threads : int
        Cores to use.
    """

    read: Callable[[IntArray], Iterable[tuple[int, FloatArray]]]
    registered: RegisteredScans
    planar: bool
    left_out: Mapping[int, BoolArray] | None = None
    threads: int = 1

    def gather_rays(
        self, floor_z_m: float, most: int | None = None
    ) -> Iterator[tuple[RaySet, FloatArray]]:
        """Yield rays of all scans, or of so many at once: of those in one plane always of all.

        Of scans in space they are those of the beams that go nearly level: no others come square to
        what stands upright.

        Yields
        ------
        rays : ray_set.RaySet
            Above a floor `floor_z_m`.
        up : (s, 3) float64
            The axis that the beams of each of its scans are inclined to, in the map frame.
        """
        poses = self.registered.map_from_sensor
        chosen = choose_scans(poses[:, :2, 3], planar=self.planar)
        step = len(chosen) if self.planar or most is None else most
        for begin in range(0, max(len(chosen), 1), max(step, 1)):
            rows = chosen[begin : begin + step]
            scan_ids = self.registered.scan_ids[rows]
            sensors_m = dict(zip(scan_ids.tolist(), poses[rows, :3, 3], strict=True))
            scans = self.read(scan_ids)
            if not self.planar:
                scans = _choose_level(scans, sensors_m)
            rays = gather_rays(
                scans,
                sensors_m,
                planar=self.planar,
                left_out=self.left_out,
                floor_z_m=floor_z_m,
                threads=self.threads,
            )
            yield rays, poses[rows, :3, 2]


def choose_scans(sensors_m: FloatArray, *, planar: bool) -> IntArray:
    """Return the rows of scans to find fronts by: one of each place (s, 2)."""
    place = np.floor(sensors_m / (_EVERY_M if planar else _EVERY_IN_SPACE_M)).astype(np.int64)
    return np.sort(np.unique(place, axis=0, return_index=True)[1])


def _choose_level(
    scans: Iterable[tuple[int, FloatArray]], sensors_m: Mapping[int, FloatArray]
) -> Iterator[tuple[int, FloatArray]]:
    """Yield of each scan the points that lie up or down no more than where rays come square."""
    for scan_id, xyz_m in scans:
        way_m = xyz_m - sensors_m[scan_id]
        is_level = np.abs(way_m[:, 2]) <= SQUARE * np.hypot(way_m[:, 0], way_m[:, 1])
        yield scan_id, xyz_m[is_level]


def find_fronts(
    walls: Sequence[PlanWall],
    read_rays: Callable[[int | None], Iterable[RaySet]],
    track_m: FloatArray,
) -> Fronts:
    """Find the fronts of glass that run as walls do, or across.

    Of each row of answers the labels of its line are asked. It is a front if that explains what
    rays say of it better than a wall does, or things in a row, between which rays pass.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        What stands, but for fronts.
    read_rays : callable
        Returns the rays of so many scans at once, or of all: they are many, and most floors have no
        row for which those of all would be needed.
    track_m : (k, 2) float64
        Where the sensor was, one place after the other.
    """
    rows = front_rows.find_front_rows(walls, read_rays(_AT_ONCE))
    if not rows:
        return Fronts([], [])
    (rays,) = read_rays(None)
    spans = intersections.stack_spans([*walls, *rows])
    drawn = [pane for wall in walls for pane in glass_views.draw_panes(wall)]
    fronts = Fronts([], [])
    for row in rows:
        if _is_seen_through(row, drawn) or not _is_front(_count_row(row, rays, track_m)):
            continue
        counts = _count_row(front_rows.extend_row(row, spans), rays, track_m)
        stretches = line_labels.label_line(counts, line=priors.FRONT)
        panes = list(_list_panes(stretches))
        doors = [stretch for stretch in stretches if stretch.kind == "door" and panes]
        fronts.panes.extend((row.line, *pane) for pane in panes)
        fronts.ways_m.extend(row.line.at(np.array([door.low_m, door.high_m])) for door in doors)
        drawn.extend(shapely.LineString(row.line.at(np.array(pane))) for pane in panes)
    return fronts


def _is_seen_through(row: FrontRow, panes: Sequence[shapely.LineString]) -> bool:
    """Return whether most rays to a row come through panes."""
    drawn = shapely.MultiLineString(list(panes))
    shapely.prepare(drawn)
    way_m = row.answers.way_m
    # a pane at the row is its own
    before_m = way_m * (1 - END_M / np.hypot(*way_m.T))[:, None]
    start_m = row.answers.xy_m - way_m
    sights = shapely.linestrings(np.stack([start_m, start_m + before_m], axis=1))
    return bool(shapely.intersects(drawn, sights).mean() > _THROUGH)


def _count_row(row: FrontRow, rays: RaySet, track_m: FloatArray) -> SurfaceCounts:
    """Return what rays from both sides say of a row."""
    everywhere_m = np.array([[-np.inf, np.inf]])
    lines = (row.line, Line(row.line.centre, -row.line.normal))
    sides = [Side(line, FACE_M, everywhere_m) for line in lines]
    counts = surface_counts.count_ends(rays, row.line, row.low_m, row.high_m, sides)
    return surface_counts.add_passages(counts, row.line, rays, track_m)


def _is_front(counts: SurfaceCounts) -> bool:
    """Return whether a front of glass is likelier than all else that a line may be."""
    of_front, *of_others = (
        line_labels.weigh_line(counts, line=line)
        for line in (priors.FRONT, priors.INNER, priors.OUTER, priors.ROW)
    )
    odds = math.log(priors.FRONT_SHARE / (1 - priors.FRONT_SHARE))
    return of_front - max(of_others) + odds >= 0


def _list_panes(stretches: Sequence[Stretch]) -> Iterator[tuple[float, float]]:
    """Yield from where to where a front is closed, where some of it is glass."""
    run: list[Stretch] = []
    for stretch in [*stretches, None]:
        if stretch is not None and _is_of_front(stretch):
            run.append(stretch)
            continue
        if any(part.kind == "glass" for part in run):
            yield run[0].low_m, run[-1].high_m
        run = []


def _is_of_front(stretch: Stretch) -> bool:
    """Return whether a stretch is glass, a post, or a joint that nobody goes through."""
    return stretch.kind == "glass" or stretch.length_m < priors.LEAST_M[priors.DOOR]
