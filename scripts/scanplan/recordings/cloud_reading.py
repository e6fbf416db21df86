"""How clouds are read, whatever files they lie in."""

from collections.abc import Sequence
from dataclasses import dataclass

from scanplan.recordings.clouds import RangeLimits
from scanplan.recordings.motion.pose_kind import FOUND
from scanplan.recordings.units import IN_METRES, Units


@dataclass(frozen=True)
class CloudReading:
    """What a user may say of a survey's clouds.

    Attributes
    ----------
    limits : clouds.RangeLimits
        Points outside are dropped.
    base_from_sensor : (6,) float, optional
        x, y, z in metres, roll, pitch, yaw in degrees; by default what the recordings say, or else
        that the poses are the sensor's own.
    units : units.Units
        What points and poses are recorded in.
    max_damaged_share : float
        Of the clouds that are read.
    pose_kind : str
        Of which kind the poses are, see `pose_kind.find_pose_kind`; found by default.
    """

    limits: RangeLimits
    base_from_sensor: Sequence[float] | None = None
    units: Units = IN_METRES
    max_damaged_share: float = 0.0
    pose_kind: str = FOUND
