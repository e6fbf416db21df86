"""From what a survey's recordings tell to the chains of transforms that place its sensor."""

from contextlib import suppress

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import tf_tree, topics
from scanplan.recordings.extrinsics import better_poses_hint, find_extrinsics, make_transform_edges
from scanplan.stage import log

_CLOCK_TOLERANCE_S = 1.0
_BASE_FRAMES = ("base_link", "base_footprint")
_ODOM = "odom"


class PoseChains:
    """The chains of transforms of one survey.

    Parameters
    ----------
    index : small_messages.SmallMessages
    base_frame : str or None
        What the poses are of, by the config.
    mount : list of tf_tree.FrameEdge or None
        The config's base_from_sensor.
    where : str
        The dataset, for errors.
    """

    def __init__(self, index, *, base_frame, mount, where):
        self._index, self._base_frame, self._mount, self._where = index, base_frame, mount, where
        self._tree = tf_tree.FrameTree(
            make_transform_edges(index.transforms, index.stamps_ns, index.cloud_receive_ns)
        )

    def of_poses(self, source):
        """Return the edges from the world to the sensor.

        Parameters
        ----------
        source : topics.Topic
            Of poses or of transforms.

        Returns
        -------
        list of tf_tree.FrameEdge

        Raises
        ------
        StageError
            If none of the poses is usable, or the sensor is not connected to them.
        """
        if source.msgtype in topics.TRANSFORMS:
            return self._of_transforms()
        edges = self._of_track(source)
        self._say_clocks(self._index.poses[source.name])
        hint = better_poses_hint(self._tree, source, edges[0].parent)
        if hint:
            log.log_line(hint)
        return edges

    def of_odometry(self, sources):
        """Return the chains from a frame that drifts but never jumps (REP 105), those that there are.

        Parameters
        ----------
        sources : list of topics.Topic
            Odometry.

        Returns
        -------
        list of (str, list of tf_tree.FrameEdge)
            Whose they are, and the edges from there to the sensor.
        """
        found = []
        with suppress(StageError):  # a tree that cannot be climbed tells nothing
            found += [(f"tf from {frame}", self._from(frame)) for frame in self._odometry_frames()]
        for source in sources:
            try:
                found.append((str(source), self._of_track(source)))
            except StageError as error:
                log.log_line(f"{error} (as odometry: not used)")
        return [
            (name, edges)
            for name, edges in found
            if edges and any(e.t_ns is not None for e in edges)
        ]

    def _odometry_frames(self):
        return [frame for frame in self._tree.frames if frame.rsplit("/", 1)[-1] == _ODOM]

    def _from(self, frame):
        """The edges from a frame of tf to the sensor, or None."""
        target, mount = self._target()
        path = self._tree.path(frame, target) if target in self._tree.frames else None
        return None if path is None else [*path, *mount]

    def _target(self):
        """The frame of tf that the sensor hangs on, and the edges from there."""
        if self._mount is None:
            return self._index.sensor_frame, []
        return self._base_frame or next(
            (f for f in _BASE_FRAMES if f in self._tree.frames), None
        ), self._mount

    def _of_track(self, source):
        track, base = self._track(source)
        mount = self._mount or find_extrinsics(
            self._tree, base, self._index.sensor_frame, track.parent, self._where
        )
        return [track, *mount]

    def _track(self, source):
        poses = self._index.poses.get(source.name)
        stamps, receive, rows, parents, children = zip(*poses, strict=True) if poses else ((),) * 5
        if len({*parents}) > 1 or len({*children}) > 1:
            raise StageError(
                f"{self._where}: the poses of {source} are given in several frames"
                f" ({', '.join(sorted({*parents, *children} - {''}))}); set input.pose_topic to another topic"
            )
        base = self._base_frame or (children[0] if children else "")
        track, found = tf_tree.make_track_edge(
            parents[0] if parents else "", base, stamps, receive, rows
        )
        told = ", ".join(f"{count} {kind}" for kind, count in found.items() if count)
        if told:
            log.log_line(f"{source}: {told}")
        if track is None:
            raise StageError(
                f"{self._where}: none of the poses of {source} is usable{f' ({told})' if told else ''}; set"
                " input.pose_topic to another topic, or take out what is recorded there twice"
            )
        return track, base

    def _of_transforms(self):
        target, mount = self._target()
        if self._mount and target not in self._tree.frames:
            raise StageError(
                f"{self._where}: tf has no frame {target}; set input.base_frame to one of its frames"
            )
        if target not in self._tree.frames or self._tree.world_root(target) == target:
            raise StageError(
                f"{self._where}: tf does not connect the clouds' frame {target} to a map; its frames are"
                f" {', '.join(self._tree.frames) or 'none'};"
                " set input.pose_topic, or input.base_frame and base_from_sensor"
            )
        return [*self._tree.path(self._tree.world_root(target), target), *mount]

    def _say_clocks(self, poses):
        """Clouds and poses stamped by different clocks give wrong poses that look right."""
        stamps, receive, *_ = zip(*poses, strict=True)
        if not any(stamps):
            return
        late_s = [
            float(np.median((np.asarray(got, np.int64) - np.asarray(stamp, np.int64)) / 1e9))
            for stamp, got in [
                (stamps, receive),
                (self._index.stamps_ns, self._index.cloud_receive_ns),
            ]
        ]
        if abs(late_s[0] - late_s[1]) > _CLOCK_TOLERANCE_S:
            log.log_line(
                f"{self._where}: poses arrive {late_s[0]:.3f} s after their stamps, clouds {late_s[1]:.3f} s:"
                " their clocks may differ"
            )
