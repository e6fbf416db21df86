"""One survey recorded in ROS bags: its clouds, and the chains that place its sensor."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import (
    clocks,
    cloud_clock,
    clouds,
    driver_messages,
    frame_edges,
    messages,
    pose_chain,
    registered_clouds,
    small_messages,
    topics,
)
from scanplan.recordings.bags import Bag, BagMessage
from scanplan.recordings.cloud_reading import CloudReading
from scanplan.recordings.extrinsics import configured_extrinsics
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion import lidar_odometry, point_times
from scanplan.recordings.motion.pose_kind import ESTIMATED, FOUND, find_pose_kind
from scanplan.recordings.survey_protocol import NamedChain
from scanplan.stage import log
from scanplan.types import Array, FloatArray, IntArray

_READERS = {
    topics.POINT_CLOUD: messages.read_point_cloud,
    topics.LASER_SCAN: messages.read_laser_scan,
    topics.MULTI_ECHO: driver_messages.read_multi_echo,
    topics.OLD_POINT_CLOUD: driver_messages.read_old_point_cloud,
    **dict.fromkeys(topics.LIVOX, driver_messages.read_livox),
}


class _RawScan(NamedTuple):
    """A scan as recorded: all points, times in the driver's own unit."""

    scan_id: int
    t_ns: int
    xyz_m: FloatArray
    time_raw: Array | None


class _CloudMessage(NamedTuple):
    """A cloud that is not decoded yet."""

    scan_id: int
    bag: Bag
    message: BagMessage


class SurveyTopics(NamedTuple):
    """What a survey is made of: the clouds, and everything that places their sensor."""

    cloud: topics.Topic
    small: list[topics.Topic]


class BagSurvey:
    """The recordings of one survey in the order of their start.

    Parameters
    ----------
    recordings : list of bags.Bag
        Open.
    known_t_ns : dict of int to int, optional
        Stamps by scan_id of all scans that are asked for, where they are known to be `as_recorded`:
        then nothing but clouds is read.

    Raises
    ------
    StageError
        If no cloud topic can be chosen.
    """

    def __init__(
        self,
        recordings: Iterable[Bag],
        *,
        cloud_topic: str | None,
        pose_topic: str | None,
        base_frame: str | None,
        reading: CloudReading,
        known_t_ns: Mapping[int, int] | None = None,
    ) -> None:
        self._known_t_ns = known_t_ns
        self._bags = sorted(recordings, key=lambda bag: (bag.start_ns, str(bag.path)))
        self._where = ", ".join(str(bag.path) for bag in self._bags)
        self._topics = topics.merge_topics(
            (topic for bag in self._bags for topic in bag.topics), self._where
        )
        self._cloud = topics.choose_cloud_topic(self._topics, cloud_topic, self._where)
        self._own_topics = topics.leave_other_robots(self._topics, self._cloud)
        if others := [t.name for t in self._topics if t not in self._own_topics]:
            log.log_line(f"{self._where}: of another robot, left out: {', '.join(others)}")
        self.units = reading.units
        self._pose_topic = pose_topic
        self._wanted_pose_kind = reading.pose_kind
        self._base_frame = base_frame
        mounting = reading.base_from_sensor
        self._extrinsics = None if mounting is None else configured_extrinsics(mounting)
        self._max_damaged_share = reading.max_damaged_share
        self._damaged = DamagedClouds(0, reading.max_damaged_share)
        self._limits = reading.limits

    @property
    def planar(self) -> bool:
        """Whether the sensor measures in one plane only: a LaserScan, or flat clouds throughout."""
        return self._planar

    @cached_property
    def _planar(self) -> bool:
        if self._cloud.msgtype in topics.LASERS:
            return True
        return clouds.are_scans_planar(self._keep_in_range(scan).xyz_m for scan in self._first)

    @property
    def as_recorded(self) -> bool:
        """Whether each scan is one message, its points seen from the sensor."""
        return not self._is_in_map

    @property
    def sweep_times(self) -> point_times.TimeConvention | None:
        """How the driver writes the time of a point, or None if it does not."""
        return self._sweep_times

    @cached_property
    def _sweep_times(self) -> point_times.TimeConvention | None:
        return point_times.find_sweep_times(
            ((self._times_in_range(scan), scan.t_ns) for scan in self._first),
            str(self._cloud),
            units=self._time_units,
        )

    @property
    def _time_units(self) -> Sequence[str]:
        return ("s",) if self._cloud.msgtype in topics.LASERS else point_times.UNITS

    def _times_in_range(self, scan: _RawScan) -> Array | None:
        # points in the map are free of the sensor's motion
        if scan.time_raw is None or self._is_in_map:
            return None
        return scan.time_raw[self._limits.include(scan.xyz_m)]

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        if self._wanted_pose_kind != FOUND:
            return self._wanted_pose_kind
        if self._pose_source is None:
            return ESTIMATED
        return find_pose_kind(self._pose_source.msgtype, self.map_frame)

    @property
    def bags(self) -> list[Bag]:
        """The recordings, in the order of their start."""
        return self._bags

    @property
    def map_frame(self) -> str:
        """The frame of the poses."""
        return lidar_odometry.WORLD if self._pose_source is None else self.pose_edges()[0].parent

    def base_from_sensor(self, t_ns: IntArray) -> FloatArray:
        """Return the poses (n, 4, 4) of the sensor on what poses without a child frame are of."""
        mounting = self._chains.of_mounting(self.map_frame)
        return frame_edges.chain_poses(mounting, t_ns, max_gap_s=np.inf)[0]

    def list_topics(self) -> SurveyTopics:
        """Return the topics of the clouds, and of poses, transforms and odometry."""
        transforms = [t for t in self._own_topics if t.msgtype in topics.TRANSFORMS]
        small = {t.name: t for t in (*self._pose_sources, *transforms, *self._odometry)}
        return SurveyTopics(self._cloud, list(small.values()))

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64, in scan_id order, by the poses' clock."""
        return self._aligned.stamps_ns

    @property
    def lag_ns(self) -> int:
        """How long before its receipt a cloud's stamp is, as far as its clock was told by that."""
        return self._aligned.sweep_ns

    @cached_property
    def _aligned(self) -> cloud_clock.AlignedStamps:
        if self._pose_source is None:
            return cloud_clock.AlignedStamps(self._index.stamps_ns)
        return cloud_clock.align_stamps(
            self._index,
            self._pose_source,
            self._cloud,
            [bag.start_ns for bag in self._bags],
            self._measure_sweep_ns,
        )

    def _measure_sweep_ns(self) -> int:
        """Return how long after its stamp a cloud's last point is measured; 0 if it is not."""
        timed = [(scan.time_raw, scan.t_ns) for scan in self._first if scan.time_raw is not None]
        convention = point_times.find_time_convention(timed, self._time_units)
        if convention is None:
            return 0
        last_s = [np.nanmax(convention.seconds(time_raw, t_ns)) for time_raw, t_ns in timed]
        return max(0, int(np.median(last_s) * 1e9))

    def scans(
        self, wanted: Iterable[int], damaged: DamagedClouds | None = None
    ) -> Iterator[clouds.Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in recording order.

        Only these are decoded. `damaged` is as in `survey_protocol.Survey.scans`.

        Raises
        ------
        ValueError
            If there is no scan of one of the numbers.
        StageError
            If too many clouds cannot be decoded.
        """
        missing = {int(scan_id) for scan_id in wanted}
        self._damaged = damaged or DamagedClouds(len(missing), self._max_damaged_share)
        for cloud in self._cloud_messages(missing.copy()):
            missing.remove(cloud.scan_id)
            received_ns = cloud.message[1]
            yield self._damaged.read(cloud.scan_id, received_ns, partial(self._read_scan, cloud))
        if missing:
            raise ValueError(f"{self._where}: there is no scan {min(missing)}")

    def read_cloud(self, scan_id: int, bag: Bag, message: BagMessage) -> clouds.Scan:
        """Return the scan that a message of `list_topics().cloud` holds.

        Raises
        ------
        StageError
            If it cannot be decoded.
        """
        return self._read_scan(_CloudMessage(scan_id, bag, message))

    def describe_damage(self) -> list[str]:
        """Return what could not be read so far, in sentences."""
        return [*self.describe_losses(), *self._damaged.describe()]

    def describe_losses(self) -> list[str]:
        """Return what of the recordings is lost whatever was read, in sentences."""
        return [loss for loss in (bag.describe_loss() for bag in self._bags) if loss]

    def describe_rays(self) -> list[str]:
        """Return nothing: they were recorded."""
        return []

    def describe_gaps(self) -> list[str]:
        """Return whether its recordings lie far apart in time, as a sentence."""
        recorded = (bag for bag in self._bags if any(topic.count for topic in bag.topics))
        return clocks.describe_gaps([(bag.path, bag.start_ns) for bag in recorded])

    def pose_edges(self) -> list[FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor.

        Returns
        -------
        list of frame_edges.FrameEdge
            Where no poses are recorded, estimated from all clouds, once.

        Raises
        ------
        StageError
            If no pose topic can be chosen, none of its poses is usable, the sensor is not connected
            to them, or the poses cannot be estimated.
        """
        return self._pose_edges

    def motion_chains(self) -> list[NamedChain]:
        """Return (name, edges) of all that states how the sensor moved, the smoothest first."""
        odometry = self._chains.of_odometry(self._odometry)
        if self._pose_source is not None:
            return [*odometry, (str(self._pose_source), self.pose_edges())]
        track, *mounting = self.pose_edges()
        steady = [lidar_odometry.steady_track(track), *mounting]
        return [*odometry, ("the clouds, steadily", steady), ("the clouds", [track, *mounting])]

    @cached_property
    def _pose_edges(self) -> list[FrameEdge]:
        if self._pose_source is None:
            return self._estimate_edges()
        edges = self._chains.of_poses(self._pose_source)
        frames = [edges[0].parent, *(edge.child or self._index.sensor_frame for edge in edges)]
        log.log_line(
            f"poses from {self._pose_source}, clouds from {self._cloud},"
            f" frames {' -> '.join(frames)}"
        )
        return edges

    def _estimate_edges(self) -> list[FrameEdge]:
        missing = f"{self._where}: advanced.input.pose_kind is {ESTIMATED}"
        if self._wanted_pose_kind != ESTIMATED:
            missing = topics.describe_missing_poses(self._topics, self._where)
        mounting = self._chains.of_mounting(self.map_frame)
        return [lidar_odometry.estimate_track(self, mounting, missing), *mounting]

    @cached_property
    def _pose_source(self) -> topics.Topic | None:
        """The topic of the poses; None where they are estimated from the clouds."""
        if self._wanted_pose_kind == ESTIMATED:
            return None
        known = self._topics if self._pose_topic else self._own_topics
        return topics.choose_pose_topic(known, self._pose_topic, self._where)

    @property
    def _pose_sources(self) -> list[topics.Topic]:
        return [] if self._pose_source is None else [self._pose_source]

    @property
    def _odometry(self) -> list[topics.Topic]:
        """Topics of odometry besides the one that the poses are from; the most frequent first."""
        odometry = [
            topic
            for topic in self._own_topics
            if topic.msgtype == topics.ODOMETRY and topic.count and topic != self._pose_source
        ]
        return sorted(odometry, key=lambda topic: (-topic.count, topic.name))

    @cached_property
    def _index(self) -> small_messages.SmallMessages:
        needed = self._pose_sources
        of_transforms = any(topic.msgtype in topics.TRANSFORMS for topic in needed)
        if self._extrinsics is None or of_transforms:
            needed += [
                topic
                for topic in self._own_topics
                if topic.msgtype in topics.TRANSFORMS and topic != self._pose_source
            ]
        return small_messages.read_small_messages(
            self._bags, self._cloud, needed, self._odometry, self._where, self.units.pose_m
        )

    @cached_property
    def _chains(self) -> pose_chain.PoseChains:
        return pose_chain.PoseChains(
            self._index,
            base_frame=self._base_frame,
            extrinsics=self._extrinsics,
            where=self._where,
        )

    @cached_property
    def _first(self) -> list[_RawScan]:
        """The first scans with points; those that cannot be decoded may never be wanted."""
        scans = []
        for cloud in self._cloud_messages():
            try:
                scan = self._decode(cloud)
            except StageError:
                continue
            if self._limits.include(scan.xyz_m).any():
                scans.append(scan)
            if len(scans) == clouds.SCANS_TO_JUDGE:
                break
        return scans

    def _cloud_messages(self, wanted: Collection[int] | None = None) -> Iterator[_CloudMessage]:
        """Iterate over the messages of the clouds wanted, or of all."""
        first = 0 if wanted is None else min(wanted, default=0)
        last = np.inf if wanted is None else max(wanted, default=-1)
        for cloud in self._number_clouds(first):
            if cloud.scan_id > last:
                return
            if wanted is None or cloud.scan_id in wanted:
                yield cloud

    def _number_clouds(self, n_unread: int) -> Iterator[_CloudMessage]:
        """Iterate over the messages of all clouds; the first so many may come without content."""
        n_seen = 0
        for bag in self._bags:
            for message in bag.messages({self._cloud.name}, n_unread=max(0, n_unread - n_seen)):
                yield _CloudMessage(n_seen, bag, message)
                n_seen += 1

    def _read_scan(self, cloud: _CloudMessage) -> clouds.Scan:
        scan = self._keep_in_range(self._decode(cloud), self.sweep_times)
        t_ns = self.stamps() if self._known_t_ns is None else self._known_t_ns
        return replace(scan, t_ns=int(t_ns[cloud.scan_id]))

    def _decode(self, cloud: _CloudMessage) -> _RawScan:
        bag = cloud.bag
        connection, _, raw = cloud.message
        t_ns = bag.header(connection, raw)[0] or self._index.stamps_ns[cloud.scan_id]
        message = bag.decode(connection, raw)
        try:
            xyz, time_raw = _READERS[connection.msgtype](message)
            return _RawScan(cloud.scan_id, t_ns, self.units.cloud_m * xyz, time_raw)
        except StageError as error:
            raise StageError(
                f"{bag.path}: topic {connection.topic}, scan {cloud.scan_id} at"
                f" {t_ns / 1e9:.3f} s: {error}; mend the driver or set input.cloud_topic"
            ) from None

    def _keep_in_range(
        self, scan: _RawScan, sweep_times: point_times.TimeConvention | None = None
    ) -> clouds.Scan:
        if self._is_in_map:
            pose = self._world_from_sensor[scan.scan_id]
            scan = scan._replace(xyz_m=registered_clouds.to_sensor(scan.xyz_m, pose))
        return clouds.keep_in_range(*scan, self._limits, sweep_times=sweep_times)

    @cached_property
    def _is_in_map(self) -> bool:
        """Whether the clouds' points are in the map; asked where they are given in its frame."""
        if self._known_t_ns is not None or self._cloud.msgtype in topics.LASERS:
            return False
        if self._pose_source is None:
            return False
        if self._index.sensor_frame != self.map_frame:
            return False

        def read(rows: IntArray) -> Iterator[FloatArray]:
            for cloud in self._cloud_messages(set(rows.tolist())):
                yield registered_clouds.read_finite(lambda cloud=cloud: self._decode(cloud).xyz_m)

        return registered_clouds.are_in_map(self._world_from_sensor, read, str(self._cloud))

    @cached_property
    def _world_from_sensor(self) -> FloatArray:
        """The poses (n, 4, 4) of all clouds, NaN before the first and after the last."""
        return frame_edges.chain_poses(self.pose_edges(), self.stamps(), max_gap_s=np.inf)[0]
