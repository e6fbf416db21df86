"""One survey recorded in ROS bags: its clouds, and the chain of transforms that places its sensor."""

from functools import cached_property

import numpy as np

from scanplan import clouds, frames, messages, stagelog, topics
from scanplan.errors import StageError
from scanplan.mounts import configured_mount, mount_edges, pose_hint, transform_edges

_CLOCK_TOLERANCE_S = 1.0


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

    def __init__(self, recordings, *, cloud_topic, pose_topic, base_frame, base_from_sensor, min_range_m, max_range_m):
        self._bags = sorted(recordings, key=lambda bag: (bag.start_ns, str(bag.path)))
        self._where = ", ".join(str(bag.path) for bag in self._bags)
        self._topics = topics.merge((t for bag in self._bags for t in bag.topics), self._where)
        self._cloud = topics.choose_cloud(self._topics, cloud_topic, self._where)
        self._pose_topic, self._base_frame = pose_topic, base_frame
        self._mount = None if base_from_sensor is None else configured_mount(base_from_sensor)
        self._limits = {"min_range_m": min_range_m, "max_range_m": max_range_m}

    @cached_property
    def planar(self):
        """Whether the sensor measures in one plane only: a LaserScan, or clouds that are flat throughout."""
        if self._cloud.msgtype == topics.LASER_SCAN:
            return True
        return clouds.are_planar(scan.xyz_m for scan in self._scans())

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
        wanted = {int(scan_id) for scan_id in wanted}
        for scan in self._scans(wanted):
            wanted.remove(scan.scan_id)
            yield scan
        if wanted:
            raise ValueError(f"{self._where}: there is no scan {min(wanted)}")

    def pose_edges(self):
        """Return the chain of transforms whose product is world_from_sensor.

        Returns
        -------
        list of frames.Edge

        Raises
        ------
        StageError
            If no pose topic can be chosen, none of its poses is usable, or the sensor is not connected to them.
        """
        index, source = self._index, self._pose_source
        tree = frames.FrameTree(transform_edges(index.transforms))
        sensor = index.sensor_frame
        if source.msgtype in topics.TRANSFORMS:
            edges = self._transform_chain(tree, sensor)
        else:
            track, base = self._pose_track()
            hint = pose_hint(tree, source, track.parent)
            mount = self._mount or mount_edges(tree, base, sensor, track.parent, self._where)
            edges = [track, *mount]
            if hint:
                stagelog.say(hint)
        chain = " -> ".join([edges[0].parent, *(edge.child or sensor for edge in edges)])
        stagelog.say(f"poses from {source}, clouds from {self._cloud}, frames {chain}")
        return edges

    @cached_property
    def _pose_source(self):
        return topics.choose_poses(self._topics, self._pose_topic, self._where)

    @cached_property
    def _index(self):
        """Everything small, in one pass over the recordings: compressed ones are unpacked once for it."""
        index, pose = _Index(), self._pose_source
        needed = {t.name: t for t in (self._cloud, pose)}
        if self._mount is None or pose.msgtype in topics.TRANSFORMS:
            needed |= {t.name: t for t in self._topics if t.msgtype in topics.TRANSFORMS}
        for bag, connection, receive_ns, raw in stagelog.progress(
            self._messages(needed), "read_recordings", sum(t.count for t in needed.values()), "messages"
        ):
            if connection.topic == self._cloud.name:
                index.add_cloud(*bag.header(connection, raw), receive_ns)
            elif needed[connection.topic].msgtype in topics.TRANSFORMS:
                index.add_transforms(
                    bag.decode(connection, raw), receive_ns, topics.is_static(needed[connection.topic])
                )
            else:
                index.add_pose(bag.decode(connection, raw), receive_ns)
        index.finish(self._where, self._cloud)
        return index

    def _pose_track(self):
        poses = self._index.poses
        stamps, receive, rows, parents, children = zip(*poses, strict=True) if poses else ((),) * 5
        if len({*parents}) > 1 or len({*children}) > 1:
            raise StageError(
                f"{self._where}: the poses of {self._pose_source} are given in several frames"
                f" ({', '.join(sorted({*parents, *children} - {''}))}); set input.pose_topic to another topic"
            )
        base = self._base_frame or (children[0] if children else "")
        track, found = frames.track(parents[0] if parents else "", base, stamps, receive, rows)
        _say_found(f"{self._pose_source}", found)
        if track is None:
            raise StageError(
                f"{self._where}: none of the poses of {self._pose_source} is usable;"
                " set input.pose_topic to another topic"
            )
        self._say_clocks(stamps, receive)
        return track, base

    def _transform_chain(self, tree, sensor):
        if self._mount:
            base = self._base_frame or next((f for f in ("base_link", "base_footprint") if f in tree.frames), None)
            if base not in tree.frames:
                raise StageError(f"{self._where}: tf has no frame {base}; set input.base_frame to one of its frames")
            target, mount = base, self._mount
        else:
            target, mount = sensor, []
        if target not in tree.frames or tree.world_root(target) == target:
            raise StageError(
                f"{self._where}: tf does not connect the clouds' frame {target} to a map; its frames are"
                f" {', '.join(tree.frames) or 'none'}; set input.pose_topic, or input.base_frame and base_from_sensor"
            )
        return [*tree.path(tree.world_root(target), target), *mount]

    def _say_clocks(self, stamps, receive):
        """Clouds and poses stamped by different clocks give wrong poses that look right."""
        if not any(stamps):
            return
        late_s = [
            float(np.median((np.asarray(got, np.int64) - np.asarray(stamp, np.int64)) / 1e9))
            for stamp, got in [(stamps, receive), (self._index.stamps_ns, self._index.cloud_receive_ns)]
        ]
        if abs(late_s[0] - late_s[1]) > _CLOCK_TOLERANCE_S:
            stagelog.say(
                f"{self._where}: poses arrive {late_s[0]:.3f} s after their stamps, clouds {late_s[1]:.3f} s:"
                " their clocks may differ"
            )

    def _messages(self, names):
        for bag in self._bags:
            for connection, receive_ns, raw in bag.messages(names):
                yield bag, connection, receive_ns, raw

    def _scans(self, wanted=None):
        last = np.inf if wanted is None else max(wanted, default=-1)
        for scan_id, (bag, connection, _, raw) in enumerate(self._messages({self._cloud.name})):
            if scan_id > last:
                return
            if wanted is None or scan_id in wanted:
                t_ns = bag.header(connection, raw)[0] or self.stamps()[scan_id]
                yield self._scan(scan_id, t_ns, bag, connection, raw)

    def _scan(self, scan_id, t_ns, bag, connection, raw):
        message = bag.decode(connection, raw)
        read = messages.laser_scan if connection.msgtype == topics.LASER_SCAN else messages.point_cloud
        try:
            xyz_m, time_raw = read(message)
        except StageError as error:
            raise StageError(
                f"{bag.path}: topic {connection.topic}, scan {scan_id} at {t_ns / 1e9:.3f} s: {error};"
                " mend the driver or set input.cloud_topic"
            ) from None
        return clouds.within_range(scan_id, t_ns, xyz_m, time_raw, **self._limits)


class _Index:
    """What one pass over the recordings collects."""

    def __init__(self):
        self.poses = []
        self.transforms = {}
        self._clouds = []

    def add_cloud(self, t_ns, frame, receive_ns):
        self._clouds.append((t_ns, receive_ns, frame))

    def add_pose(self, message, receive_ns):
        pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
        child = messages.frame_name(getattr(message, "child_frame_id", ""))
        parent = messages.frame_name(message.header.frame_id)
        self.poses.append((messages.stamp_ns(message.header.stamp), receive_ns, messages.pose_row(pose), parent, child))

    def add_transforms(self, message, receive_ns, static):
        for item in message.transforms:
            key = (static, messages.frame_name(item.header.frame_id), messages.frame_name(item.child_frame_id))
            sample = messages.stamp_ns(item.header.stamp), receive_ns, messages.pose_row(item.transform)
            self.transforms.setdefault(key, []).append(sample)

    def finish(self, where, cloud):
        if not self._clouds:
            raise StageError(f"{where}: no message of {cloud} can be found; the recording's index is wrong, reindex it")
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
            stagelog.say(f"{where}: clouds of {cloud} have no stamps, the times of their receipt are taken")
            self.stamps_ns = self.cloud_receive_ns


def _say_found(what, found):
    told = ", ".join(f"{count} {kind}" for kind, count in found.items() if count)
    if told:
        stagelog.say(f"{what}: {told}")
