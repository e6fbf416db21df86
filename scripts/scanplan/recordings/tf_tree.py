"""The tf tree: which frames hang on which, and the way from one to another."""

from collections.abc import Callable, Iterable, Iterator, Sequence

from scanplan.errors import StageError
from scanplan.recordings.frame_edges import FrameEdge

WORLD_FRAMES = ("map", "odom", "world", "earth")


class _TwoParentsError(StageError):
    """A frame hangs on two others; `edges_below` lead up to it."""

    def __init__(
        self, frame: str, parents: Iterable[str], edges_below: Sequence[FrameEdge]
    ) -> None:
        names = " and ".join(sorted(parents))
        super().__init__(
            f"tf: frame {frame} hangs on {names}; set input.base_frame or input.base_from_sensor"
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
        frame : str
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
            if len(parents) > 1:
                raise _TwoParentsError(visited[-1], parents, below)
            edge = next(iter(parents.values()))
            if edge.parent in visited:
                cycle = " -> ".join([*visited, edge.parent])
                raise StageError(f"tf: frames {cycle} are a cycle; mend the robot's tf")
            visited.append(edge.parent)
            below.append(edge)
            yield edge

    def _parents(self, frame: str, follows: Callable[[FrameEdge], bool]) -> dict[str, FrameEdge]:
        edges = self._edges.get(frame, {})
        return {parent: edge for parent, edge in edges.items() if follows(edge)}

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
                way = ascent + descent[::-1]
                _check_constants(way)
                return way
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

        Parameters
        ----------
        frame : str
        world : str
            The frame that the poses are given in; the climb stops below it too.
        """

        def is_rigid(edge: FrameEdge) -> bool:
            return edge.t_ns is None and edge.parent not in (world, *WORLD_FRAMES)

        return [frame, *(edge.parent for edge in self.up(frame, is_rigid))][-1]

    def world_root(self, frame: str) -> str:
        """Return the frame to give poses in: map above `frame`, else odom, else the topmost."""
        above = [frame]
        for edge in self.up(frame):
            above.append(edge.parent)
            if edge.parent == "map":
                break
        return next((name for name in ("map", "odom") if name in above), above[-1])


def _check_constants(edges: Sequence[FrameEdge]) -> None:
    for edge in edges:
        if edge.is_contradicted:
            raise StageError(
                f"tf_static: {edge.parent} -> {edge.child} was recorded with values that contradict"
                " one another; set input.base_from_sensor, or give each recording a dataset of its"
                " own"
            )
