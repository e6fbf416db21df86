"""The chosen scans as a recording of their own: their messages as recorded, poses, transforms."""

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from scanplan.exports import bag_writer
from scanplan.exports.bag_writer import ROS1_STORE, BagWriter
from scanplan.geometry import se3
from scanplan.recordings import messages, topics
from scanplan.recordings.bags import Bag, BagMessage
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.recordings.rosbag1_messages import StoredMessage
from scanplan.store import atomic
from scanplan.types import FilePath, FloatArray, IntArray, Settings

POSE_TOPIC = "/registered_pose"
"""Where the recording has the registered poses: of the rover, like those of a localiser."""
_POSE_TYPE = "geometry_msgs/msg/PoseStamped"

StampedStream = tuple[tuple[str, ...], int]
"""What a small message tells, as (topic,) or (topic, parent, child), and its stamp."""

_OF_DAMAGED = ("salvage", "max_damaged_share")
_TUNED = ("pose_kind", "storey", "cloud_unit", "pose_unit")
"""Of how a recording is read what stands under `advanced` in settings."""


def copy_selected_scans(
    path: FilePath, survey: BagSurvey, scan_ids: IntArray, map_from_sensor: FloatArray
) -> int:
    """Write a recording of chosen scans, whole or not at all.

    It has their clouds as recorded, on `POSE_TOPIC` their registered poses, and of the poses,
    transforms and odometry what tells how the sensor moved during their sweeps.

    Parameters
    ----------
    path : path-like
        See `bag_writer.open_bag_writer`.
    scan_ids : (n,) int, increasing
    map_from_sensor : (n, 4, 4) float64

    Returns
    -------
    int
        The number of messages.
    """
    stamps_ns = survey.stamps()
    base_from_sensor = survey.base_from_sensor(stamps_ns[scan_ids])
    map_from_base = map_from_sensor @ se3.invert_pose(base_from_sensor)
    poses = dict(zip(np.asarray(scan_ids).tolist(), map_from_base, strict=True))
    needed = find_needed_messages(survey, stamps_ns[scan_ids], _longest_sweep_ns(stamps_ns))
    n_messages = 0
    with (
        atomic.replace_file(path) as temporary,
        bag_writer.open_bag_writer(Path(temporary)) as writer,
    ):
        for bag, message, scan_id in _iterate_messages(survey, poses, needed):
            if scan_id is not None:
                stamp_ns = int(stamps_ns[scan_id])
                pose = _make_pose(stamp_ns, survey.map_frame, poses[scan_id], survey.units.pose_m)
                # where receipt tells the clouds' clock it is to tell it again
                received_ns = message[1] - survey.lag_ns
                writer.write_message(received_ns, POSE_TOPIC, _POSE_TYPE, pose)
                n_messages += 1
            copy_message(writer, bag, message)
            n_messages += 1
    return n_messages


def reading_settings(survey: BagSurvey, reading: Settings) -> dict[str, Any]:
    """Return settings with which a plan is made of the recording as it was of the survey.

    Parameters
    ----------
    reading : dict
        What poses depend on of the survey's own settings, see `stage_settings.select_topics`.

    Returns
    -------
    dict
        Of the sections input, poses, registration and selection.
    """
    own_topics = {"cloud_topic": survey.list_topics().cloud.name, "pose_topic": POSE_TOPIC}
    # found anew: the poses that are written are registered ones
    own = {key: value for key, value in reading.items() if key != "pose_kind"}
    return {
        **sections_of(own | own_topics),
        "poses": {"keep_every": 1},
        "registration": {"icp_method": "none"},
        "selection": {"stop": {"n_scans": None, "area_share": None}},
    }


def find_needed_messages(survey: BagSurvey, stamps_ns: IntArray, sweep_ns: int) -> set[int]:
    """Find the small messages that tell where the sensor was during some sweeps.

    Of each topic, and of each transform, those are needed within a sweep's time of a scan's stamp,
    the last one before and the first one after; and all of /tf_static.

    Parameters
    ----------
    stamps_ns : (n,) int64
        Of the scans.
    sweep_ns : int
        A sweep ends or begins at its stamp; it takes no longer.

    Returns
    -------
    set of int
        Their numbers among the small messages, in the order of `BagSurvey.bags`.
    """
    streams: dict[tuple[str, ...], tuple[list[int], list[int]]] = {}
    needed: set[int] = set()
    known = {topic.name: topic for topic in survey.list_topics().small}
    items = ((bag, item) for bag in survey.bags for item in bag.messages(known))
    for number, (bag, message) in enumerate(items):
        topic = known[message[0].topic]
        if topics.is_static_tf(topic):
            needed.add(number)
            continue
        for stream, t_ns in _stamped_streams(bag, message):
            numbers, times_ns = streams.setdefault(stream, ([], []))
            numbers.append(number)
            times_ns.append(t_ns)
    for numbers, times_ns in streams.values():
        needed |= _around_sweeps(np.array(numbers), np.array(times_ns), stamps_ns, sweep_ns)
    return needed


def _longest_sweep_ns(stamps_ns: IntArray) -> int:
    """Return the usual time between two scans: no sweep takes longer."""
    return int(np.median(np.diff(stamps_ns))) if len(stamps_ns) > 1 else 0


def _around_sweeps(
    numbers: IntArray, times_ns: IntArray, stamps_ns: IntArray, sweep_ns: int
) -> set[int]:
    order = np.argsort(times_ns, kind="stable")
    first = np.searchsorted(times_ns[order], stamps_ns - sweep_ns, side="right") - 1
    last = np.searchsorted(times_ns[order], stamps_ns + sweep_ns)
    needed: set[int] = set()
    for begin, end in zip(np.maximum(first, 0), last, strict=True):
        needed.update(numbers[order[begin : end + 1]].tolist())
    return needed


def _stamped_streams(bag: Bag, message: BagMessage) -> Iterator[StampedStream]:
    """Yield what a small message tells, each with its stamp; the time of receipt where it is 0."""
    connection, receive_ns, raw = message
    if connection.msgtype not in topics.TRANSFORMS:
        yield (connection.topic,), bag.header(connection, raw)[0] or receive_ns
        return
    for item in bag.decode(connection, raw).transforms:
        frames = (item.header.frame_id, item.child_frame_id)
        yield (connection.topic, *frames), messages.stamp_to_ns(item.header.stamp) or receive_ns


def _iterate_messages(
    survey: BagSurvey, scan_ids: Collection[int], needed: Collection[int]
) -> Iterator[tuple[Bag, BagMessage, int | None]]:
    """Yield the messages to copy, the clouds with their scan_ids."""
    names = survey.list_topics()
    wanted = {names.cloud.name, *(topic.name for topic in names.small)}
    n_clouds = n_small = 0
    for bag in survey.bags:
        for message in bag.messages(wanted):
            if message[0].topic == names.cloud.name:
                if n_clouds in scan_ids:
                    yield bag, message, n_clouds
                n_clouds += 1
                continue
            if n_small in needed:
                yield bag, message, None
            n_small += 1


def copy_message(writer: BagWriter, bag: Bag, message: BagMessage) -> None:
    """Write a message as it was recorded, in the form of this kind of recording."""
    connection, receive_ns, raw = message
    data = raw.read() if isinstance(raw, StoredMessage) else raw
    data = writer.convert(data, connection.msgtype, is_ros2=bag.ros2)
    topic = topics.Topic(connection.topic, connection.msgtype, 1)
    is_latched = topics.is_static_tf(topic)
    writer.write_raw(receive_ns, topic.name, topic.msgtype, data, is_latched=is_latched)


def _make_pose(stamp_ns: int, frame: str, map_from_base: FloatArray, unit_m: float) -> Any:
    """Return a `geometry_msgs/PoseStamped` in some unit."""
    kinds = ROS1_STORE.types
    xyz_m, quat_xyzw = se3.split_pose(map_from_base[None])
    stamp = kinds["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    return kinds[_POSE_TYPE](
        header=kinds["std_msgs/msg/Header"](seq=0, stamp=stamp, frame_id=frame),
        pose=kinds["geometry_msgs/msg/Pose"](
            position=kinds["geometry_msgs/msg/Point"](*(xyz_m[0] / unit_m).tolist()),
            orientation=kinds["geometry_msgs/msg/Quaternion"](*quat_xyzw[0].tolist()),
        ),
    )


def sections_of(reading: Settings) -> dict[str, Any]:
    """Return sections of settings that say how to read a recording that is written anew, whole."""
    sound = {key: value for key, value in reading.items() if key not in _OF_DAMAGED}
    tuned = {key: sound.pop(key) for key in _TUNED if key in sound}
    return {"input": sound, "advanced": {"input": tuned}}
