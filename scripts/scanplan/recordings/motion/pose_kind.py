"""Whether poses are a localiser's, in a map, or odometry, which drifts: of wheels or of scans."""

from scanplan.recordings import topics

FOUND = "found"
"""What the settings say where topic and frame decide."""
LOCALISER = "localiser"
ODOMETRY = "odometry"
ESTIMATED = "estimated"
"""Odometry that is estimated from the clouds, whatever was recorded."""
STATIONS = "stations"
"""Poses that a surveyor's program has registered, of a scanner that stood still at each."""
NOTE = "pose_kind"
"""Under this name a table of poses says which."""


def find_pose_kind(msgtype: str, frame: str) -> str:
    """Return the kind of poses by their message type and the frame they are given in.

    A frame `map` is a localiser's, `odom` is odometry's (REP 105); in another frame the type says.

    Parameters
    ----------
    msgtype : str
        As `topics.Topic` has it.

    Returns
    -------
    str
        `LOCALISER` or `ODOMETRY`.
    """
    name = frame.rsplit("/", 1)[-1]
    if name == "map":
        return LOCALISER
    is_odometry = name == "odom" or msgtype in (topics.ODOMETRY, topics.PATH)
    return ODOMETRY if is_odometry else LOCALISER


def is_drifting(kind: str) -> bool:
    """Return whether poses of a kind say only how the sensor moved, and drift."""
    return kind in (ODOMETRY, ESTIMATED)
