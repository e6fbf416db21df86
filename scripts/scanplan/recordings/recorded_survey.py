"""One survey recorded in ROS bags: its clouds, and the chains of transforms that place its sensor."""

from functools import cached_property

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import clouds, messages, pose_chain, small_messages, topics
from scanplan.recordings.extrinsics import configured_extrinsics
from scanplan.recordings.motion import point_times
from scanplan.stage import log


class BagSurvey:
    """The recordings of one survey in the order of their start.

    Parameters
    ----------
    recordings : list of bags.Bag
        Open.
    cloud_topic, pose_topic, base_frame : str or None
    base_from_sensor : (6,) float or None
        x, y, z in metres, roll, pitch, yaw in degrees.
    min_range_m, max_range_m : float

    Raises
    ------
    StageError
        If no cloud topic can be chosen.
    """

    def __init__(
        self,
        recordings,
        *,
        cloud_topic,
        pose_topic,
        base_frame,
        base_from_sensor,
        min_range_m,
        max_range_m,
    ):
        self._bags = sorted(recordings, key=lambda bag: (bag.start_ns, str(bag.path)))
        self._where = ", ".join(str(bag.path) for bag in self._bags)
        self._topics = topics.merge_topics(
            (t for bag in self._bags for t in bag.topics), self._where
        )
        self._cloud = topics.choose_cloud_topic(self._topics, cloud_topic, self._where)
        self._pose_topic, self._base_frame = pose_topic, base_frame
        self._mount = None if base_from_sensor is None else configured_extrinsics(base_from_sensor)
        self._limits = {"min_range_m": min_range_m, "max_range_m": max_range_m}

    @cached_property
    def planar(self):
        """Whether the sensor measures in one plane only: a LaserScan, or clouds that are flat throughout."""
        if self._cloud.msgtype == topics.LASER_SCAN:
            return True
        return clouds.are_scans_planar(self._within_range(*raw).xyz_m for raw in self._first)

    @cached_property
    def sweep_times(self):
        """How the clouds tell when each point was measured: a point_times.TimeConvention, or None if they do not."""
        units = {"units": ("s",)} if self._cloud.msgtype == topics.LASER_SCAN else {}
        timed = [
            (
                time_raw
                if time_raw is None
                else time_raw[clouds.is_in_range(xyz_m, **self._limits)],
                t_ns,
            )
            for _, t_ns, xyz_m, time_raw in self._first
        ]
        found = point_times.find_time_convention(timed, **units)
        if found:
            log.log_line(f"{self._cloud}: times of points are {found}")
        elif any(time_raw is not None for time_raw, _ in timed):
            log.log_line(
                f"{self._cloud}: times of points are not those of a sweep: scans stay as recorded"
            )
        return found

    def stamps(self):
        """Return the header stamps of all clouds, (n,) int64, in scan_id order."""
        return self._index.stamps_ns

    def scans(self, wanted):
        """Iterate over the scans of the scan_ids in `wanted`, in recording order; only these are decoded.

        Raises
        ------
        ValueError
            If there is no scan of one of the numbers.
        StageError
            If a cloud cannot be decoded.
        """
        wanted, sweep_times = {int(scan_id) for scan_id in wanted}, self.sweep_times
        for scan_id, *message in self._messages(wanted):
            wanted.remove(scan_id)
            yield self._within_range(*self._decoded(scan_id, *message), sweep_times)
        if wanted:
            raise ValueError(f"{self._where}: there is no scan {min(wanted)}")

    def pose_edges(self):
        """Return the chain of transforms whose product is world_from_sensor.

        Returns
        -------
        list of tf_tree.FrameEdge

        Raises
        ------
        StageError
            If no pose topic can be chosen, none of its poses is usable, or the sensor is not connected to them.
        """
        return self._pose_edges

    def motion_chains(self):
        """Return (name, list of tf_tree.FrameEdge) of all that tells how the sensor moved, the smoothest first."""
        return [
            *self._chains.of_odometry(self._odometry),
            (str(self._pose_source), self.pose_edges()),
        ]

    @cached_property
    def _pose_edges(self):
        edges = self._chains.of_poses(self._pose_source)
        chain = " -> ".join(
            [edges[0].parent, *(edge.child or self._index.sensor_frame for edge in edges)]
        )
        log.log_line(f"poses from {self._pose_source}, clouds from {self._cloud}, frames {chain}")
        return edges

    @cached_property
    def _pose_source(self):
        return topics.choose_pose_topic(self._topics, self._pose_topic, self._where)

    @property
    def _odometry(self):
        """Topics of odometry besides the one that the poses are from; the most frequent first."""
        found = [
            t
            for t in self._topics
            if t.msgtype == topics.ODOMETRY and t.count and t != self._pose_source
        ]
        return sorted(found, key=lambda t: (-t.count, t.name))

    @cached_property
    def _index(self):
        needed = [self._pose_source]
        if self._mount is None or self._pose_source.msgtype in topics.TRANSFORMS:
            needed += [
                t for t in self._topics if t.msgtype in topics.TRANSFORMS and t != self._pose_source
            ]
        return small_messages.read_small_messages(
            self._bags, self._cloud, needed, self._odometry, self._where
        )

    @cached_property
    def _chains(self):
        return pose_chain.PoseChains(
            self._index, base_frame=self._base_frame, mount=self._mount, where=self._where
        )

    @cached_property
    def _first(self):
        """The first scans with points, as `_decoded` gives them; those that cannot be decoded may never be wanted."""
        found = []
        for message in self._messages():
            try:
                scan = self._decoded(*message)
            except StageError:
                continue
            if len(self._within_range(*scan).xyz_m):
                found.append(scan)
            if len(found) == clouds.SCANS_TO_JUDGE:
                break
        return found

    def _messages(self, wanted=None):
        """Iterate over scan_id, bag, connection and message of the clouds wanted, or of all."""
        last = np.inf if wanted is None else max(wanted, default=-1)
        found = ((bag, *item) for bag in self._bags for item in bag.messages({self._cloud.name}))
        for scan_id, (bag, connection, _, raw) in enumerate(found):
            if scan_id > last:
                return
            if wanted is None or scan_id in wanted:
                yield scan_id, bag, connection, raw

    def _decoded(self, scan_id, bag, connection, raw):
        """Return scan_id, t_ns, xyz_m and times as recorded."""
        t_ns = bag.header(connection, raw)[0] or self.stamps()[scan_id]
        message = bag.decode(connection, raw)
        read = (
            messages.read_laser_scan
            if connection.msgtype == topics.LASER_SCAN
            else messages.read_point_cloud
        )
        try:
            return scan_id, t_ns, *read(message)
        except StageError as error:
            raise StageError(
                f"{bag.path}: topic {connection.topic}, scan {scan_id} at {t_ns / 1e9:.3f} s: {error};"
                " mend the driver or set input.cloud_topic"
            ) from None

    def _within_range(self, scan_id, t_ns, xyz_m, time_raw, sweep_times=None):
        return clouds.keep_in_range(
            scan_id, t_ns, xyz_m, time_raw, sweep_times=sweep_times, **self._limits
        )
