"""A rover's recording, written as a ROS 1 bag or a ROS 2 one."""

import heapq
from collections.abc import Iterable

import numpy as np

from scanplan.exports import bag_writer
from scanplan.lab.simulation.survey_messages import POSE_TOPIC, STATIC_TOPIC, RosMessage
from scanplan.store import atomic
from scanplan.types import FilePath

# a recording starts then, so that the same seed gives the same bytes
EPOCH_NS = int(np.datetime64("2024-01-01", "ns").astype(np.int64))
_LATCHED = (POSE_TOPIC, STATIC_TOPIC)


def write_survey_bag(path: FilePath, *streams: Iterable[RosMessage]) -> None:
    """Write a recording, whole or not at all.

    ASSUME every message is recorded when it is sent; a real recorder is some milliseconds later.

    Parameters
    ----------
    path : path-like
        See `bag_writer.open_bag_writer`.
    *streams : iterable of survey_messages.RosMessage
        Each in the order of its times; merged by them as they come, so that no stream is held in
        memory.

    Raises
    ------
    ValueError
        If the suffix is another.
    """
    with (
        atomic.replace_file(path) as temporary,
        bag_writer.open_bag_writer(temporary) as writer,
    ):
        for message in heapq.merge(*streams, key=lambda message: message.t_ns):
            writer.write_message(
                message.t_ns,
                message.topic,
                message.msgtype,
                message.content,
                is_latched=message.topic in _LATCHED,
            )
