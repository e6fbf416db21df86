"""The tf tree: which frames hang on which, and the way from one to another."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.types import FloatArray

WORLD_FRAMES = ("map", "odom", "world", "earth")
BASE_FRAMES = ("base_link", "base_footprint")
"""What robots call what their sensors are mounted on (REP 105)."""


class _TwoParentsError(StageError):
    """A frame hangs on two others; `edges_below` lead up to it."""

    def __init__(
        self, frame: str, parents: Iterable[str], edges_below: Sequence[FrameEdge]
    ) -> None:
        names = " and ".join(sorted(parents))
        super().__init__(
            f"tf: frame {frame} hangs on {names}, which place it differently; set"
            " input.base_from_sensor"
        )
        self.edges_below = list(edges_below)


class FrameTree:
    """The frames of /tf and /tf_static.

    Parameters
    ----------
    edges : iterable of FrameEdge
        One for each pair of frames. Edges that never move count as constant, unless they hang on a
        frame of the world: a robot that stands still is not bolted down.
    """

    def __init__(self, edges: Iterable[FrameEdge]) -> None:
        self._edges: dict[str, dict[str, FrameEdge]] = {}
        for edge in edges:
            is_bolted = (
                edge.t_ns is not None and edge.parent not in WORLD_FRAMES and edge.is_still()
            )
            parents = self._edges.setdefault(edge.child, {})
            parents[edge.parent] = edge.frozen() if is_bolted else edge

    @property
    def frames(self) -> list[str]:
        """All frame names, sorted."""
        names = set(self._edges)
        for parents in self._edges.values():
            names.update(parents)
        return sorted(names)

    def up(
        self, frame: str, follows: Callable[[FrameEdge], bool] = lambda edge: True
    ) -> Iterator[FrameEdge]:
        """Iterate over the edges from a frame to the root, nearest first.

        Parameters
        ----------
        follows : callable
            The climb goes only over edges that it accepts.

        Raises
        ------
        StageError
            If a frame hangs on itself or on two others.
        """
        visited = [frame]
        below: list[FrameEdge] = []
        while parents := self._parents(visited[-1], follows):
            edge = self._choose_agreeing(list(parents.values()))
            if edge is None:
                raise _TwoParentsError(visited[-1], parents, below)
            if edge.parent in visited:
                cycle = " -> ".join([*visited, edge.parent])
                raise StageError(f"tf: frames {cycle} are a cycle; mend the robot's tf")
            visited.append(edge.parent)
            below.append(edge)
            yield edge

    def _parents(self, frame: str, follows: Callable[[FrameEdge], bool]) -> dict[str, FrameEdge]:
        edges = self._edges.get(frame, {})
        return {parent: edge for parent, edge in edges.items() if follows(edge)}

    def _choose_agreeing(self, edges: list[FrameEdge]) -> FrameEdge | None:
        """Return the edge that begins the shortest way of several, None if they do not agree.

        A mounting that two programs broadcast, each over frames of its own, is one mounting.
        """
        if len(edges) == 1:
            return edges[0]
        climbs = [self._climb_rigid(edge) for edge in edges]
        reached = [[edge.parent for edge in climb] for climb in climbs]
        common = [frame for frame in reached[0] if all(frame in others for others in reached)]
        if not common:
            return None
        ends = [others.index(common[0]) + 1 for others in reached]
        first, *rest = (_multiply(climb[:end]) for climb, end in zip(climbs, ends, strict=True))
        for pose in rest:
            off_m = float(np.abs(first - pose)[:3, 3].max())
            if max(off_m, se3.turn_between_rad(first, pose)) > SHORTEST_M:
                return None
        return min(zip(ends, edges, strict=True), key=lambda climb: (climb[0], climb[1].parent))[1]

    def _climb_rigid(self, edge: FrameEdge) -> list[FrameEdge]:
        """Return an edge and those above it, as far as they never change and there is one way."""
        climb: list[FrameEdge] = []
        parents = [edge]
        met = {edge.child}
        while len(parents) == 1 and parents[0].t_ns is None and parents[0].parent not in met:
            climb.append(parents[0])
            met.add(parents[0].parent)
            parents = list(self._edges.get(parents[0].parent, {}).values())
        return climb

    def path(self, start: str, end: str) -> list[FrameEdge] | None:
        """Return the edges whose product is start_from_end, or None if there is no way between.

        Raises
        ------
        StageError
            If there is a cycle above one of them, only a frame that hangs on two others could
            connect them, or a constant transform on the way was recorded with several values.
        """
        rising, start_error = self._climb(start)
        falling, end_error = self._climb(end)
        above_end = [end, *(edge.parent for edge in falling)]
        for i, frame in enumerate([start, *(edge.parent for edge in rising)]):
            if frame in above_end:
                ascent = [edge.inverse() for edge in rising[:i]]
                descent = falling[: above_end.index(frame)]
                edges = ascent + descent[::-1]
                _check_constants(edges)
                return edges
        error = end_error or start_error
        if error is not None:
            raise error
        return None

    def _climb(self, frame: str) -> tuple[list[FrameEdge], StageError | None]:
        """Return the edges up from a frame, as far as each has one parent, and why no farther."""
        try:
            return list(self.up(frame)), None
        except _TwoParentsError as error:
            return error.edges_below, error

    def mount_root(self, frame: str, world: str) -> str:
        """Return the topmost frame that is rigidly connected to `frame`, below those of the world.

        A mount that nods or turns on a robot is of its base, whatever is between.

        Parameters
        ----------
        world : str
            The frame that the poses are given in; the climb stops below it too.
        """

        def is_below(edge: FrameEdge) -> bool:
            return edge.parent not in (world, *WORLD_FRAMES)

        def is_rigid(edge: FrameEdge) -> bool:
            return edge.t_ns is None and is_below(edge)

        above: list[str] = []
        with suppress(StageError):  # what moves above may be placed by two localisers
            above.extend(edge.parent for edge in self.up(frame, is_below))
        bases = [name for name in above if name.rsplit("/", 1)[-1] in BASE_FRAMES]
        frame = bases[0] if bases else frame
        return [frame, *(edge.parent for edge in self.up(frame, is_rigid))][-1]

    def world_root(self, frame: str) -> str:
        """Return the frame to give poses in: map above `frame`, else odom, else the topmost."""
        above = [frame]
        for edge in self.up(frame):
            above.append(edge.parent)
            if edge.parent == "map":
                break
        return next((name for name in ("map", "odom") if name in above), above[-1])


def _multiply(edges: Sequence[FrameEdge]) -> FloatArray:
    """Return the pose (4, 4) of the lowest frame of constant edges, nearest first, in the top."""
    pose = np.eye(4)
    for edge in edges:
        pose = se3.pose_matrix(edge.xyz_m, edge.quat_xyzw)[0] @ pose
    return pose


def _check_constants(edges: Sequence[FrameEdge]) -> None:
    for edge in edges:
        if edge.is_contradicted:
            raise StageError(
                f"tf_static: {edge.parent} -> {edge.child} was recorded with values that contradict"
                " one another; set input.base_from_sensor, or give each recording a dataset of its"
                " own"
            )
