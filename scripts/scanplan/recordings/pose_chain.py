"""From the poses and transforms of a recording to the chains that place its sensor."""

from collections.abc import Sequence
from contextlib import suppress

from scanplan.errors import StageError
from scanplan.recordings import clocks, frame_edges, tf_tree, topics
from scanplan.recordings.extrinsics import better_poses_hint, find_extrinsics, make_transform_edges
from scanplan.recordings.small_messages import Samples, SmallMessages
from scanplan.recordings.survey_protocol import NamedChain
from scanplan.stage import log
from scanplan.types import IntArray

_ODOM = "odom"


class PoseChains:
    """The chains of transforms of one survey.

    Parameters
    ----------
    base_frame : str or None
        What the poses are of, by the config.
    extrinsics : list of frame_edges.FrameEdge or None
        The config's base_from_sensor.
    where : str
        The dataset, for errors.
    """

    def __init__(
        self,
        index: SmallMessages,
        *,
        base_frame: str | None,
        extrinsics: list[frame_edges.FrameEdge] | None,
        where: str,
    ) -> None:
        self._index = index
        self._base_frame = base_frame
        self._extrinsics = extrinsics
        self._where = where
        self._tree = tf_tree.FrameTree(
            make_transform_edges(index.transforms, index.stamps_ns, index.cloud_receive_ns)
        )

    def of_poses(self, source: topics.Topic) -> list[frame_edges.FrameEdge]:
        """Return the edges from the world to the sensor.

        Parameters
        ----------
        source : topics.Topic
            Of poses or of transforms.

        Returns
        -------
        list of frame_edges.FrameEdge

        Raises
        ------
        StageError
            If none of the poses is usable, or the sensor is not connected to them.
        """
        if source.msgtype in topics.TRANSFORMS:
            return self._chain_of_transforms()
        edges = self._chain_of_track(source)
        hint = better_poses_hint(self._tree, source, edges[0].parent)
        if hint:
            log.log_line(hint)
        return edges

    def of_mounting(self, world: str) -> list[frame_edges.FrameEdge]:
        """Return the edges to the sensor from what poses in `world` are of that do not state it.

        Raises
        ------
        StageError
            If tf does not connect the two.
        """
        if self._extrinsics:
            return self._extrinsics
        sensor = self._index.sensor_frame
        return find_extrinsics(self._tree, self._base_frame or "", sensor, world, self._where)

    def of_odometry(self, sources: Sequence[topics.Topic]) -> list[NamedChain]:
        """Return the chains from a frame that drifts but never jumps (REP 105), as far as recorded.

        Parameters
        ----------
        sources : list of topics.Topic
            Odometry.

        Returns
        -------
        list of (str, list of frame_edges.FrameEdge)
            The name of the source, and the edges from there to the sensor.
        """
        chains = []
        with suppress(StageError):  # a tree that cannot be climbed holds no odometry
            chains = self._chains_from_odometry_frames()
        for source in sources:
            try:
                chains.append((str(source), self._chain_of_track(source)))
            except StageError as error:
                log.log_line(f"{error} (as odometry: not used)")
        return [(name, edges) for name, edges in chains if _is_moving(edges)]

    def _chains_from_odometry_frames(self) -> list[NamedChain]:
        frames = [frame for frame in self._tree.frames if frame.rsplit("/", 1)[-1] == _ODOM]
        return [(f"tf from {frame}", self._chain_from(frame)) for frame in frames]

    def _chain_from(self, frame: str) -> list[frame_edges.FrameEdge]:
        """Return the edges from a frame of tf to the sensor; none if they are not connected."""
        target, extrinsics = self._target()
        if target is None or target not in self._tree.frames:
            return []
        path = self._tree.path(frame, target)
        return [] if path is None else [*path, *extrinsics]

    def _target(self) -> tuple[str | None, list[frame_edges.FrameEdge]]:
        """Return the frame of tf that the sensor hangs on, and the edges from there."""
        if self._extrinsics is None:
            return self._index.sensor_frame, []
        bases = [frame for frame in tf_tree.BASE_FRAMES if frame in self._tree.frames]
        return self._base_frame or (bases[0] if bases else None), self._extrinsics

    def _chain_of_track(self, source: topics.Topic) -> list[frame_edges.FrameEdge]:
        track = self._track(source)
        if self._extrinsics:
            return [track, *self._extrinsics]
        sensor = self._index.sensor_frame
        if sensor == track.parent:
            # what tf says of the two is the pose once more
            return [track]
        return [
            track,
            *find_extrinsics(self._tree, track.child, sensor, track.parent, self._where),
        ]

    def _track(self, source: topics.Topic) -> frame_edges.FrameEdge:
        """Return the poses of a topic as an edge from their frame to what they are of."""
        samples = self._index.poses.get(source.name, Samples())
        parents, children = sorted(samples.parents), sorted(samples.children)
        if len(parents) > 1 or len(children) > 1:
            frames = ", ".join(sorted({*parents, *children} - {""}))
            raise StageError(
                f"{self._where}: the poses of {source} are given in several frames ({frames});"
                " set input.pose_topic to another topic"
            )
        track, counts = frame_edges.make_track_edge(
            parents[0] if parents else "",
            self._base_frame or (children[0] if children else ""),
            *self._possible_stamps(source, samples),
            samples.rows,
        )
        faults = clocks.summarise_faults(counts)
        if faults:
            log.log_line(f"{source}: {faults}")
        if track is None:
            reason = f" ({faults})" if faults else ""
            raise StageError(
                f"{self._where}: none of the poses of {source} is usable{reason}; set"
                " input.pose_topic to another topic, or take out what is recorded there twice"
            )
        return track

    def _possible_stamps(self, source: topics.Topic, samples: Samples) -> tuple[IntArray, IntArray]:
        """Return stamps and times of receipt, (n,) int64; no pose is received before it was."""
        t_ns, receive_ns = samples.times_ns
        if len(t_ns) == 0:
            return t_ns, receive_ns
        ahead_ns = clocks.estimate_ahead_ns(
            t_ns, receive_ns, self._index.stamps_ns, self._index.cloud_receive_ns
        )
        if ahead_ns:
            lead = clocks.describe_lead(str(source), ahead_ns)
            log.log_line(f"{self._where}: {lead}")
        return t_ns - ahead_ns, receive_ns

    def _chain_of_transforms(self) -> list[frame_edges.FrameEdge]:
        target, extrinsics = self._target()
        frames = self._tree.frames
        if self._extrinsics and target not in frames:
            raise StageError(
                f"{self._where}: tf has no frame {target};"
                " set input.base_frame to one of its frames"
            )
        root = self._tree.world_root(target) if target is not None and target in frames else target
        path = None if target is None or root is None else self._tree.path(root, target)
        if root == target or path is None:
            raise StageError(
                f"{self._where}: tf does not connect the clouds' frame {target} to a map;"
                f" its frames are {', '.join(frames) or 'none'};"
                " set input.pose_topic, or input.base_frame and base_from_sensor"
            )
        return [*path, *extrinsics]


def _is_moving(edges: Sequence[frame_edges.FrameEdge]) -> bool:
    return any(edge.t_ns is not None for edge in edges)
