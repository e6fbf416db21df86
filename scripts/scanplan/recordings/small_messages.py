"""The small messages of a survey, read in one pass: cloud stamps, poses, transforms."""

from array import array
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import clocks, messages, topics
from scanplan.recordings.bags import Bag, Connection
from scanplan.stage import log
from scanplan.types import FloatArray, IntArray


class Samples:
    """Recorded poses or transforms in the order of recording, by columns.

    An object for each would take four times the memory: there are a dozen for each scan.

    Attributes
    ----------
    parents, children : set of str
        The frames that they are given in, and those that they are of.
    """

    def __init__(self) -> None:
        self.parents: set[str] = set()
        self.children: set[str] = set()
        self._times_ns = array("q")
        self._rows = array("d")

    def add(
        self, t_ns: int, receive_ns: int, row: Iterable[float], parent: str, child: str
    ) -> None:
        """Add one: `row` is x, y, z, qx, qy, qz, qw of `child` in `parent`."""
        self._times_ns.extend((t_ns, receive_ns))
        self._rows.extend(row)
        self.parents.add(parent)
        self.children.add(child)

    @property
    def times_ns(self) -> IntArray:
        """Stamps and times of receipt, (2, n) int64."""
        return np.array(self._times_ns, np.int64).reshape(-1, 2).T.copy()

    @property
    def rows(self) -> FloatArray:
        """What `add` was given, (n, 7) float64."""
        return np.array(self._rows, float).reshape(-1, 7)


class _CloudSample(NamedTuple):
    t_ns: int
    receive_ns: int
    frame: str


TransformKey = tuple[bool, str, str]
"""Whether a transform is static, its parent and its child."""


class SmallMessages:
    """What one pass over the recordings collects; places are recorded in some unit.

    Attributes
    ----------
    poses : dict of str to Samples
        By topic.
    transforms : dict of TransformKey to Samples
    stamps_ns, cloud_receive_ns : (n,) int64
        Of the clouds.
    sensor_frame : str
    """

    stamps_ns: IntArray
    cloud_receive_ns: IntArray
    sensor_frame: str

    def __init__(self, unit_m: float = 1.0) -> None:
        self._unit_m = unit_m
        self.poses: dict[str, Samples] = {}
        self.transforms: dict[TransformKey, Samples] = {}
        self._clouds: list[_CloudSample] = []
        self._n_odd_covariances: Counter[str] = Counter()
        self._paths: dict[str, dict[int, tuple[list[float], str]]] = {}

    def add_cloud(self, t_ns: int, frame: str, receive_ns: int) -> None:
        """Add the stamp of a cloud."""
        self._clouds.append(_CloudSample(t_ns, receive_ns, frame))

    def add_pose(self, topic: str, message: Any, receive_ns: int) -> None:
        """Add a pose: any of the messages that hold one."""
        pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
        self.poses.setdefault(topic, Samples()).add(
            messages.stamp_to_ns(message.header.stamp),
            receive_ns,
            self._read_row(pose),
            messages.clean_frame_name(message.header.frame_id),
            messages.clean_frame_name(getattr(message, "child_frame_id", "")),
        )
        if not np.isfinite(getattr(message.pose, "covariance", 0)).all():
            self._n_odd_covariances[topic] += 1

    def add_path(self, topic: str, message: Any) -> None:
        """Add the poses of a path; a later message says better where one was."""
        parent = messages.clean_frame_name(message.header.frame_id)
        known = self._paths.setdefault(topic, {})
        for item in message.poses:
            t_ns = messages.stamp_to_ns(item.header.stamp)
            known[t_ns] = self._read_row(item.pose), parent
        self.poses[topic] = Samples()
        for t_ns in sorted(known):
            if t_ns:
                # when a pose was first received is not known
                self.poses[topic].add(t_ns, t_ns, *known[t_ns], "")

    def add_transforms(self, message: Any, receive_ns: int, static: bool) -> None:
        """Add the transforms of a TFMessage."""
        for item in message.transforms:
            parent = messages.clean_frame_name(item.header.frame_id)
            child = messages.clean_frame_name(item.child_frame_id)
            t_ns = messages.stamp_to_ns(item.header.stamp)
            samples = self.transforms.setdefault((static, parent, child), Samples())
            samples.add(t_ns, receive_ns, self._read_row(item.transform), parent, child)

    def _read_row(self, pose: Any) -> list[float]:
        row = messages.pose_to_row(pose)
        return [*(self._unit_m * value for value in row[:3]), *row[3:]]

    def finish(self, where: str, cloud: topics.Topic) -> None:
        """Make arrays of the clouds' stamps, and log what is odd.

        Raises
        ------
        StageError
            If there is no cloud, or they come from several sensors.
        """
        if not self._clouds:
            raise StageError(
                f"{where}: no message of {cloud} can be found; the recording's index is wrong,"
                " reindex it"
            )
        frames = sorted({sample.frame for sample in self._clouds})
        if len(frames) > 1:
            raise StageError(
                f"{where}: clouds of {cloud} come from several sensors ({', '.join(frames)});"
                " record each on a topic of its own"
            )
        self.sensor_frame = frames[0]
        self.cloud_receive_ns = np.array([c.receive_ns for c in self._clouds], np.int64)
        self.stamps_ns = np.array([c.t_ns for c in self._clouds], np.int64)
        self._log_oddities(where, cloud)

    def _log_oddities(self, where: str, cloud: topics.Topic) -> None:
        if not self.stamps_ns.any():
            log.log_line(
                f"{where}: clouds of {cloud} have no stamps, the times of their receipt are taken"
            )
            self.stamps_ns = self.cloud_receive_ns
        counts = clocks.count_stamp_faults(self.stamps_ns, self.cloud_receive_ns)
        if faults := clocks.summarise_faults(counts):
            log.log_line(f"{cloud}: {faults}; each scan keeps the pose of its own stamp")
        for topic, count in self._n_odd_covariances.items():
            log.log_line(
                f"{topic}: {count} poses with a covariance that is no number;"
                " the poses themselves are used"
            )


def read_small_messages(
    bags: Sequence[Bag],
    cloud: topics.Topic,
    needed: Sequence[topics.Topic],
    optional: Sequence[topics.Topic],
    where: str,
    unit_m: float = 1.0,
) -> SmallMessages:
    """Collect all small messages, in one pass: compressed recordings are unpacked once for it.

    Parameters
    ----------
    needed : list of topics.Topic
        Poses and transforms.
    optional : list of topics.Topic
        Poses that are left out where a message of them is damaged.
    where : str
        The dataset, for errors.
    unit_m : float
        What poses and transforms are in.

    Returns
    -------
    SmallMessages

    Raises
    ------
    StageError
        If a message that is needed is damaged, there are no clouds, or they come from several
        sensors.
    """
    index = SmallMessages(unit_m)
    wanted = {topic.name: topic for topic in (cloud, *needed, *optional)}
    damaged: set[topics.Topic] = set()
    items = ((bag, message) for bag in bags for message in bag.messages(wanted))
    total = sum(topic.count for topic in wanted.values())
    last_paths: dict[str, tuple[Bag, Connection, bytes]] = {}
    for bag, message in log.report_progress(items, "read_recordings", total, "messages"):
        connection, receive_ns, raw = message
        topic = wanted[connection.topic]
        if topic == cloud:
            t_ns, frame = bag.header(connection, raw)
            index.add_cloud(t_ns, frame, receive_ns)
        elif topic.msgtype in topics.TRANSFORMS:
            index.add_transforms(
                bag.decode(connection, raw), receive_ns, topics.is_static_tf(topic)
            )
        elif topic.msgtype == topics.PATH:
            # where it lies may be closed once the recording is gone through
            data = raw if isinstance(raw, bytes) else raw.read()
            before = last_paths.get(topic.name)
            # a path that grew says all again
            if before is not None and len(data) <= len(before[2]):
                _add_path(index, *before)
            last_paths[topic.name] = (bag, connection, data)
        elif topic not in damaged:
            try:
                index.add_pose(topic.name, bag.decode(connection, raw), receive_ns)
            except StageError as error:
                if topic not in optional:
                    raise
                log.log_line(f"{error}; {topic} is left out")
                damaged.add(topic)
                index.poses.pop(topic.name, None)
    for before in last_paths.values():
        _add_path(index, *before)
    index.finish(where, cloud)
    return index


def _add_path(index: SmallMessages, bag: Bag, connection: Connection, data: bytes) -> None:
    index.add_path(connection.topic, bag.decode(connection, data))
