"""What is asked of a surface to tell a wall from what stands in a room, or outside."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from scanplan.plan.model import islands
from scanplan.plan.model.surface_counts import BEYOND, DEEP, FACE, LOST, SurfaceCounts
from scanplan.plan.openings import GAP
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.ray_set import ROWS_M
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_DOOR_M = (0.5, 2.4)  # openings that leaves hang in, single and double ones
_BEFORE_M = (0.25, 1.2)  # furniture stands so far before its wall
_DEEP_M = 1.0  # furniture is no deeper
_AROUND_M = 10.0  # wings of a building, and what a map bends, have directions of their own
_WHOLE = 0.01  # those of the whole building count, where nothing else is around
_FREE_M = 1.5  # deeper is no furniture, but a part of the building that one can go around
_APART_M = 2.0  # farther off a surface stands alone
_ACROSS = 0.9  # cosine of normals: flatter than that one surface goes on as the other
_ALONG = 0.3  # of its length: what overlaps less is beside it, not behind
_SEEN = 0.5  # witnesses of a cell that returns came from, or that rays passed


@dataclass(frozen=True)
class Features:
    """What was observed of one surface; lengths are inf where there is no such thing.

    Attributes
    ----------
    length_m, thickness_m : float
        Thickness inf of what was seen from one side.
    solid : float
        Share of its length that is no door, window or pane.
    witnesses : float
        How many places saw it, in the mean of its columns and of that of all surfaces.
    top_m : float
        How high it was seen, in the mean of its columns; NaN of planar scans.
    overlooked : float
        On what share of its length rays pass over what was seen of it; NaN of planar scans.
    deep : float
        Share of the rays to what was seen of it that end a little farther than its face.
    n_inner : float
        At how many of its ends another surface comes forward, as in the corners of a room.
    n_outer : float
        At how many another goes back alone, as at the corners of a cupboard.
    joint_m : float
        From the nearest end, its own or another surface's, to the other of the two.
    hinge_m : float
        By how much it fits no opening of another wall as its leaf: from one of its ends to the
        jamb, and from its length to the opening's width.
    before_m : float
        How far behind it another surface runs that faces the same way.
    free : float
        1 of what stands in free floor, is no deeper than furniture and holds on to nothing beyond;
        0 of all else.
    back_m, free_back_m : float
        How far behind it another surface runs that faces the other way: of what holds on to
        something, and of what stands free. Either is NaN of the other.
    depth_m : float
        How deep what it meets at outer corners is, one after the other: the shorter side of the
        rectangle around that, along the longest of it.
    turned_deg : float
        From the nearest main direction of what is around it, 0 to 45.
    through_glass : float
        Share of its rays that come through windows and panes.
    roofed : float
        How much of the ground before it has a ceiling, over what is usual there; NaN: not known.
    """

    length_m: float
    thickness_m: float
    solid: float
    witnesses: float
    top_m: float
    overlooked: float
    deep: float
    n_inner: float
    n_outer: float
    joint_m: float
    hinge_m: float
    before_m: float
    free: float
    back_m: float
    free_back_m: float
    depth_m: float
    turned_deg: float
    through_glass: float
    roofed: float


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The walls of a plan, to ask what is around one of them.

    Attributes
    ----------
    walls : sequence of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free; by default none is known, and nothing stands free.
    """

    walls: Sequence[PlanWall]
    floor: BaseGeometry = field(default_factory=shapely.Polygon)

    def observe(
        self, counts: Sequence[SurfaceCounts], through_glass: FloatArray, roofed: FloatArray
    ) -> list[Features]:
        """Return the features of each wall, given what rays say of it.

        Parameters
        ----------
        counts : sequence of surface_counts.SurfaceCounts
            Of each wall.
        through_glass, roofed : (n,) float64
        """
        witnesses = [
            _Seen.of(wall, of_wall) for wall, of_wall in zip(self.walls, counts, strict=True)
        ]
        usual = np.median([shown.witnesses for shown in witnesses]) if witnesses else 1.0
        return [
            Features(
                length_m=wall.length_m,
                thickness_m=_or_inf(wall.thickness_m),
                solid=shown.solid,
                witnesses=shown.witnesses / max(float(usual), _SEEN),
                top_m=shown.top_m,
                overlooked=shown.overlooked,
                deep=shown.deep,
                n_inner=n_inner,
                n_outer=n_outer,
                joint_m=self._find_joint_m(number),
                hinge_m=self._find_hinge_m(number),
                before_m=self._find_before_m(number),
                free=float(self._is_free[number]),
                back_m=math.nan if self._is_free[number] else self._find_back_m(number),
                free_back_m=self._find_back_m(number) if self._is_free[number] else math.nan,
                depth_m=float(self._depth_m[number]),
                turned_deg=float(self._turned_deg[number]),
                through_glass=float(through_glass[number]),
                roofed=float(roofed[number]),
            )
            for number, (wall, shown, (n_inner, n_outer, _)) in enumerate(
                zip(self.walls, witnesses, self._meetings, strict=True)
            )
        ]

    @cached_property
    def _lines(self) -> list[shapely.LineString]:
        return [shapely.LineString(wall.ends) for wall in self.walls]

    @cached_property
    def _ends(self) -> list[Array]:
        return [np.asarray(shapely.points(wall.ends)) for wall in self.walls]

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree(self._lines)

    @cached_property
    def _jambs(self) -> tuple[FloatArray, FloatArray, IntArray]:
        """Places (j, 2) of jambs at both faces, how wide their openings are, whose they are."""
        places, widths, owners = [np.empty((0, 2))], [], []
        for number, wall in enumerate(self.walls):
            across_m = np.array([wall.half_m, 0.0, -wall.half_m])[:, None] * wall.line.normal
            for opening in wall.openings:
                if opening.kind != "window" and _DOOR_M[0] < opening.width_m < _DOOR_M[1]:
                    ends_m = wall.line.at(np.array([opening.low_m, opening.high_m]))
                    places.append((ends_m[:, None] + across_m).reshape(-1, 2))
                    widths += [opening.width_m] * len(places[-1])
                    owners += [number] * len(places[-1])
        return np.concatenate(places), np.array(widths), np.array(owners, np.int64)

    @cached_property
    def _turned_deg(self) -> FloatArray:
        """The angle (n,) of each wall to the directions that most of the length around it has."""
        direction = np.array([wall.ends[1] - wall.ends[0] for wall in self.walls]).reshape(-1, 2)
        # the same of both and across
        turn = np.exp(4j * np.arctan2(direction[:, 1], direction[:, 0]))
        by_length = turn * np.hypot(*direction.T)
        own, other = self._tree.query(self._lines, predicate="dwithin", distance=_AROUND_M)
        main = np.full(len(turn), by_length.sum() * _WHOLE)
        np.add.at(main, own[own != other], by_length[other[own != other]])
        return np.abs(np.degrees(np.angle(turn * np.conj(main)))) / 4

    @cached_property
    def corners(self) -> IntArray:
        """Pairs (k, 2) of surfaces that meet at an outer corner: each goes back from the other."""
        back = [behind for _, _, behind in self._meetings]
        pairs = [(i, j) for i, of in enumerate(back) for j in sorted(of) if i < j and i in back[j]]
        return np.array(pairs, np.int64).reshape(-1, 2)

    @cached_property
    def _depth_m(self) -> FloatArray:
        """How deep what each surface (n,) meets at outer corners is."""
        depth_m = np.full(len(self.walls), math.inf)
        for own in self._group(self.corners):
            if len(own) > 1:
                longest = max((self.walls[row] for row in own), key=lambda wall: wall.length_m)
                corners_m = np.concatenate([self.walls[row].ends for row in own])
                along_m = longest.line.along_m(corners_m)
                depth_m[own] = min(np.ptp(along_m), np.ptp(longest.line.offset_m(corners_m)))
        return depth_m

    @cached_property
    def _is_free(self) -> BoolArray:
        """Return which surfaces (n,) are of what stands free."""
        return islands.find_island_depths_m(self.walls, self.floor) < _FREE_M

    def _group(self, pairs: IntArray) -> list[IntArray]:
        """Return the surfaces of each group that pairs (k, 2) hold together."""
        count = len(self.walls)
        links = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
        _, group = connected_components(links, directed=False)
        return np.split(np.argsort(group, kind="stable"), np.bincount(group).cumsum()[:-1])

    def _near(self, number: int, place: shapely.Geometry, within_m: float) -> list[int]:
        near = np.sort(self._tree.query(place, predicate="dwithin", distance=within_m))
        return [other for other in near.tolist() if other != number]

    @cached_property
    def _meetings(self) -> list[tuple[float, float, set[int]]]:
        """Of each at how many ends others come forward, at how many they go back, and which do."""
        return [self._find_meetings(number) for number in range(len(self.walls))]

    def _find_meetings(self, number: int) -> tuple[float, float, set[int]]:
        wall = self.walls[number]
        reach_m = BEHIND_M + wall.half_m
        n_inner = n_outer = 0
        behind: set[int] = set()
        for end_m in wall.ends:
            near = self._near(number, shapely.Point(end_m), reach_m)
            cosine = [abs(self.walls[i].line.normal @ wall.line.normal) for i in near]
            across = [i for i, same in zip(near, cosine, strict=True) if same < _ACROSS]
            ends_m = np.array([self.walls[i].ends for i in across]).reshape(-1, 2, 2)
            off_m = wall.line.offset_m(ends_m)
            comes_forward = off_m.max(axis=1) > reach_m
            goes_back = ~comes_forward & (off_m.min(axis=1) < -reach_m)
            n_inner += bool(comes_forward.any())
            n_outer += bool(goes_back.any())
            behind.update(itertools.compress(across, goes_back.tolist()))
        return float(n_inner), float(n_outer), behind

    def _find_joint_m(self, number: int) -> float:
        line, half_m = self._lines[number], self.walls[number].half_m
        joint_m = math.inf
        for other in self._near(number, line, _APART_M):
            own_m = shapely.distance(self._lines[other], self._ends[number]).min()
            its_m = shapely.distance(line, self._ends[other]).min()
            joint_m = min(joint_m, own_m - self.walls[other].half_m, its_m - half_m)
        return max(float(joint_m), 0.0)

    def _find_hinge_m(self, number: int) -> float:
        wall = self.walls[number]
        places_m, width_m, owner = self._jambs
        of_others = owner != number
        apart_m = np.hypot(*(places_m[of_others] - wall.ends[:, None]).T).min(axis=1)
        fits_m = wall.length_m - width_m[of_others]
        return float(np.hypot(apart_m, fits_m).min(initial=math.inf))

    def _find_before_m(self, number: int) -> float:
        wall = self.walls[number]
        before_m = math.inf
        for other in self._near(number, self._lines[number], _BEFORE_M[1]):
            for face in self.walls[other].members:
                if face.line.normal @ wall.line.normal < _ACROSS:
                    continue
                off_m = -float(wall.line.offset_m(face.ends.mean(axis=0)))
                low_m, high_m = np.sort(wall.line.along_m(face.ends)).tolist()
                is_along = min(high_m, wall.high_m) > max(low_m, wall.low_m) - wall.length_m
                if _BEFORE_M[0] < off_m < _BEFORE_M[1] and is_along:
                    before_m = min(before_m, off_m)
        return before_m

    def _find_back_m(self, number: int) -> float:
        wall = self.walls[number]
        back_m = math.inf
        for row in self._near(number, self._lines[number], _DEEP_M):
            other = self.walls[row]
            off_m = -float(wall.line.offset_m(other.ends).mean())
            low_m, high_m = np.sort(wall.line.along_m(other.ends)).tolist()
            shared_m = min(high_m, wall.high_m) - max(low_m, wall.low_m)
            is_back = other.line.normal @ wall.line.normal < -_ACROSS
            if is_back and 0 < off_m < _DEEP_M and shared_m > _ALONG * wall.length_m:
                back_m = min(back_m, off_m)
        return back_m


@dataclass(frozen=True)
class _Seen:
    """What rays say of one surface, as the same attributes of `Features`."""

    solid: float
    witnesses: float
    top_m: float
    overlooked: float
    deep: float

    @classmethod
    def of(cls, wall: PlanWall, counts: SurfaceCounts) -> "_Seen":
        ends = counts.ends.sum(axis=2)
        n_rows = ends.shape[1]
        is_solid = _is_solid(wall, counts)
        is_face = ends[:, :, FACE] > _SEEN
        is_seen = is_solid & is_face.any(axis=1)
        solid = float(is_solid.mean())
        if not is_seen.any():
            return cls(solid, 0.0, math.nan, math.nan if n_rows == 1 else 0.0, 0.0)
        ends, is_face = ends[is_seen], is_face[is_seen]
        row = np.arange(n_rows)
        lowest = is_face.argmax(axis=1)[:, None]
        highest = (n_rows - 1 - is_face[:, ::-1].argmax(axis=1))[:, None]
        is_between = (row >= lowest) & (row <= highest)
        returned = (ends[:, :, :LOST] * is_between[:, :, None]).sum(axis=(0, 1))
        is_over = (ends[:, :, BEYOND] + ends[:, :, DEEP] > _SEEN) & (row > highest)
        return cls(
            solid=solid,
            witnesses=float(ends[:, :, FACE].sum(axis=1).mean()),
            top_m=math.nan if n_rows == 1 else float(ROWS_M[highest + 1].mean()),
            overlooked=math.nan if n_rows == 1 else float(is_over.any(axis=1).mean()),
            deep=float(returned[DEEP] / returned.sum()),
        )


def _is_solid(wall: PlanWall, counts: SurfaceCounts) -> BoolArray:
    """Return which columns of a wall are in no door, window or pane; slots are between things."""
    is_solid = np.ones(len(counts.ends), bool)
    for gap in [opening for opening in wall.openings if opening.kind != GAP]:
        is_solid &= ~((counts.middles_m > gap.low_m) & (counts.middles_m < gap.high_m))
    return is_solid


def _or_inf(value: float) -> float:
    return math.inf if math.isnan(value) else value
