"""A recording reduced while it is read: every scan is taken or left as it comes."""

from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

from scanplan.exports import bag_writer
from scanplan.exports.selected_bag import copy_message, sections_of
from scanplan.recordings.clouds import Scan
from scanplan.recordings.recorded_survey import BagSurvey
from scanplan.store import atomic
from scanplan.types import FilePath, Settings


def copy_taken_scans(
    path: FilePath,
    survey: BagSurvey,
    candidates: Collection[int],
    is_taken: Callable[[Scan], bool],
) -> int:
    """Write a recording of the scans that are taken, whole or not at all.

    One pass over the clouds, of which one is held at a time. Poses, transforms and odometry are
    copied as they come, all of them.

    Parameters
    ----------
    path : path-like
        See `bag_writer.open_bag_writer`.
    candidates : collection of int
        The scan_ids that are decided on; no other cloud is decoded.
    is_taken : callable
        Called with each candidate in the order of recording.

    Returns
    -------
    int
        How many were taken.
    """
    names = survey.list_topics()
    wanted = {names.cloud.name, *(topic.name for topic in names.small)}
    messages = ((bag, message) for bag in survey.bags for message in bag.messages(wanted))
    n_clouds = n_taken = 0
    with (
        atomic.replace_file(path) as temporary,
        bag_writer.open_bag_writer(Path(temporary)) as writer,
    ):
        for recording, message in messages:
            if message[0].topic == names.cloud.name:
                scan_id = n_clouds
                n_clouds += 1
                if scan_id not in candidates or not is_taken(
                    survey.read_cloud(scan_id, recording, message)
                ):
                    continue
                n_taken += 1
            copy_message(writer, recording, message)
    return n_taken


def reduced_settings(reading: Settings, poses: Settings) -> dict[str, Any]:
    """Return settings with which a plan is made of all scans of the reduced recording.

    Parameters
    ----------
    reading, poses : dict
        Sections `input` and `poses` of the survey's own settings.
    """
    return {
        **sections_of(reading),
        "poses": {**poses, "keep_every": 1},
        "selection": {"stop": {"n_scans": None, "area_share": None}},
    }
