"""A survey as the stages see it: clouds with stamps and the poses of their sensor, from bags or from a scan folder."""

import math
from contextlib import ExitStack, contextmanager

from scanplan.project import dataset_files
from scanplan.recordings.motion.deskew import DeskewedSurvey


@contextmanager
def open_survey(
    files,
    *,
    cloud_topic=None,
    pose_topic=None,
    base_frame=None,
    base_from_sensor=None,
    ros2_release="humble",
    min_range_m=0.0,
    max_range_m=math.inf,
    deskew=True,
    motion=None,
):
    """Open all recordings of a dataset as one survey.

    Parameters
    ----------
    files : sequence of str
        As `dataset_files.find_files` gives them.
    cloud_topic, pose_topic : str, optional
        Where there are several candidates. `pose_topic` may be /tf.
    base_frame : str, optional
        The frame that the poses are of.
    base_from_sensor : (6,) float, optional
        Where the sensor sits on it: x, y, z in metres, roll, pitch, yaw in degrees. By default tf tells.
    ros2_release : str
        Whose message definitions hold where a ROS 2 bag carries none.
    min_range_m, max_range_m : float
        Points outside are dropped.
    deskew : bool
        Whether to move points to where they would have been seen at their scan's stamp, given a `motion`.
    motion : trajectory.SensorMotion, optional
        How the sensor moved.

    Yields
    ------
    object
        `planar` (bool), `sweep_times` (point_times.TimeConvention or None), `stamps()` -> (n,) int64 nanoseconds in scan_id
        order, `pose_edges()` -> list of tf_tree.FrameEdge from the world to the sensor, `motion_chains()` -> list of (name,
        list of tf_tree.FrameEdge), the smoothest motion first and the poses last, `scans(wanted)` -> iterator of clouds.Scan
        in scan_id order.

    Raises
    ------
    StageError
        If a recording is damaged or does not tell what to use.
    """
    with ExitStack() as stack:
        survey = _opened(
            files,
            stack,
            ros2_release,
            {"cloud_topic": cloud_topic, "pose_topic": pose_topic, "base_frame": base_frame},
            {
                "base_from_sensor": base_from_sensor,
                "min_range_m": min_range_m,
                "max_range_m": max_range_m,
            },
        )
        yield DeskewedSurvey(survey, motion) if deskew and motion is not None else survey


def _opened(files, stack, ros2_release, chosen, common):
    # rosbags and Open3D cost a second each to import: only the one that is needed
    if dataset_files.is_scan_folder(files):
        from scanplan.recordings import scan_folder

        return scan_folder.ScanFolder(files, **common)
    from scanplan.recordings import bags, recorded_survey

    opened = [
        stack.enter_context(bags.open_bag(path, ros2_release=ros2_release))
        for path in dataset_files.group_recordings(files)
    ]
    return recorded_survey.BagSurvey(opened, **chosen, **common)
