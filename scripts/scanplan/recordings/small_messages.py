"""All that is small in a survey's recordings, collected in one pass: stamps of the clouds, poses, transforms."""

from collections import Counter

import numpy as np

from scanplan.errors import StageError
from scanplan.recordings import clocks, messages, topics
from scanplan.stage import log


class SmallMessages:
    """What one pass over the recordings collects.

    Attributes
    ----------
    poses : dict of str to list of (t_ns, receive_ns, row, parent, child)
        By topic, in the order of recording; `row` is x, y, z, qx, qy, qz, qw.
    transforms : dict of (static, parent, child) to list of (t_ns, receive_ns, row)
    stamps_ns, cloud_receive_ns : (n,) int64
        Of the clouds.
    sensor_frame : str
    """

    def __init__(self):
        self.poses = {}
        self.transforms = {}
        self._clouds = []
        self._no_covariance = Counter()

    def add_cloud(self, t_ns, frame, receive_ns):
        """Note a cloud."""
        self._clouds.append((t_ns, receive_ns, frame))

    def add_pose(self, topic, message, receive_ns):
        """Note a pose: any of the messages that hold one."""
        pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
        child = messages.clean_frame_name(getattr(message, "child_frame_id", ""))
        parent = messages.clean_frame_name(message.header.frame_id)
        sample = (
            messages.stamp_to_ns(message.header.stamp),
            receive_ns,
            messages.pose_to_row(pose),
            parent,
            child,
        )
        if not np.isfinite(getattr(message.pose, "covariance", 0)).all():
            self._no_covariance[topic] += 1
        self.poses.setdefault(topic, []).append(sample)

    def add_transforms(self, message, receive_ns, static):
        """Note the transforms of a TFMessage."""
        for item in message.transforms:
            key = (
                static,
                messages.clean_frame_name(item.header.frame_id),
                messages.clean_frame_name(item.child_frame_id),
            )
            sample = (
                messages.stamp_to_ns(item.header.stamp),
                receive_ns,
                messages.pose_to_row(item.transform),
            )
            self.transforms.setdefault(key, []).append(sample)

    def finish(self, where, cloud):
        """Make arrays of what was noted of the clouds.

        Raises
        ------
        StageError
            If there is none, or they come from several sensors.
        """
        if not self._clouds:
            raise StageError(
                f"{where}: no message of {cloud} can be found; the recording's index is wrong, reindex it"
            )
        stamps, receive, names = zip(*self._clouds, strict=True)
        if len(set(names)) > 1:
            raise StageError(
                f"{where}: clouds of {cloud} come from several sensors ({', '.join(sorted(set(names)))});"
                " record each on a topic of its own"
            )
        self.sensor_frame = names[0]
        self.cloud_receive_ns = np.array(receive, np.int64)
        self.stamps_ns = np.array(stamps, np.int64)
        if not self.stamps_ns.any():
            log.log_line(
                f"{where}: clouds of {cloud} have no stamps, the times of their receipt are taken"
            )
            self.stamps_ns = self.cloud_receive_ns
        odd = clocks.count_stamp_faults(self.stamps_ns, self.cloud_receive_ns)
        if told := ", ".join(f"{count} {kind}" for kind, count in odd.items() if count):
            log.log_line(f"{cloud}: {told}; each scan keeps the pose of its own stamp")
        for topic, count in self._no_covariance.items():
            log.log_line(
                f"{topic}: {count} poses with a covariance that is no number; the poses themselves are used"
            )


def read_small_messages(bags, cloud, needed, optional, where):
    """Collect everything small, in one pass over the recordings: compressed ones are unpacked once for it.

    Parameters
    ----------
    bags : list of bags.Bag
    cloud : topics.Topic
    needed : list of topics.Topic
        Poses and transforms.
    optional : list of topics.Topic
        Poses that are left out where a message of them is damaged.
    where : str
        The dataset, for errors.

    Returns
    -------
    Index

    Raises
    ------
    StageError
        If a message that is needed is damaged, there are no clouds, or they come from several sensors.
    """
    index, wanted, spoiled = (
        SmallMessages(),
        {t.name: t for t in (cloud, *needed, *optional)},
        set(),
    )
    items = ((bag, *item) for bag in bags for item in bag.messages(wanted))
    total = sum(t.count for t in wanted.values())
    for bag, connection, receive_ns, raw in log.report_progress(
        items, "read_recordings", total, "messages"
    ):
        topic = wanted[connection.topic]
        if topic == cloud:
            index.add_cloud(*bag.header(connection, raw), receive_ns)
        elif topic.msgtype in topics.TRANSFORMS:
            index.add_transforms(
                bag.decode(connection, raw), receive_ns, topics.is_static_tf(topic)
            )
        elif topic not in spoiled:
            try:
                index.add_pose(topic.name, bag.decode(connection, raw), receive_ns)
            except StageError as error:
                if topic not in optional:
                    raise
                log.log_line(f"{error}; {topic} is left out")
                spoiled.add(topic)
                index.poses.pop(topic.name, None)
    index.finish(where, cloud)
    return index
