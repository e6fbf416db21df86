"""Whether recorded poses are a localiser's, in a map, or odometry, which drifts."""

from scanplan.recordings import topics

FOUND = "found"
"""What the settings say where topic and frame decide."""
LOCALISER = "localiser"
ODOMETRY = "odometry"
NOTE = "pose_kind"
"""Under this name a table of poses says which."""


def find_pose_kind(msgtype: str, frame: str) -> str:
    """Return the kind of poses by their message type and the frame they are given in.

    A frame `map` is a localiser's, `odom` is odometry's (REP 105); in another frame the type says.

    Parameters
    ----------
    msgtype : str
        As `topics.Topic` has it.
    frame : str

    Returns
    -------
    str
        `LOCALISER` or `ODOMETRY`.
    """
    name = frame.rsplit("/", 1)[-1]
    if name == "map":
        return LOCALISER
    return ODOMETRY if name == "odom" or msgtype == topics.ODOMETRY else LOCALISER
