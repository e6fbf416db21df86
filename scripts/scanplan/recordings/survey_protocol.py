"""What every kind of survey offers to the stages, whatever it was read from."""

from collections.abc import Iterable, Iterator
from typing import Protocol

from scanplan.recordings.clouds import Scan
from scanplan.recordings.frame_edges import FrameEdge
from scanplan.recordings.integrity.damaged_clouds import DamagedClouds
from scanplan.recordings.motion.point_times import TimeConvention
from scanplan.types import IntArray

NamedChain = tuple[str, list[FrameEdge]]
"""A chain of transforms from some fixed frame to the sensor, and the name of its source."""


class TakenAtOnce:
    """What surveys have in common whose scans are in space, and free of any motion."""

    @property
    def planar(self) -> bool:
        """Whether they were measured in one plane: never."""
        return False

    @property
    def sweep_times(self) -> TimeConvention | None:
        """No times: there is no motion to take out."""
        return None


class Survey(Protocol):
    """Clouds with stamps, and the poses of their sensor."""

    @property
    def planar(self) -> bool:
        """Whether the sensor measures in one plane only."""
        ...

    @property
    def sweep_times(self) -> TimeConvention | None:
        """How the driver writes the time of a point, or None if it does not."""
        ...

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        ...

    def stamps(self) -> IntArray:
        """Return the stamps of all clouds, (n,) int64 nanoseconds, in scan_id order."""
        ...

    def pose_edges(self) -> list[FrameEdge]:
        """Return the chain of transforms whose product is world_from_sensor."""
        ...

    def motion_chains(self) -> list[NamedChain]:
        """Return all that states how the sensor moved, the smoothest first and the poses last."""
        ...

    def describe_damage(self) -> list[str]:
        """Return what could not be read so far, in sentences."""
        ...

    def describe_rays(self) -> list[str]:
        """Return what stands for rays where the recording has none, in sentences."""
        ...

    def describe_gaps(self) -> list[str]:
        """Return whether its recordings lie far apart in time, as a sentence."""
        ...

    def scans(self, wanted: Iterable[int], damaged: DamagedClouds | None = None) -> Iterator[Scan]:
        """Iterate over the scans of the scan_ids in `wanted`, in scan_id order.

        `damaged` counts those that cannot be decoded; by default they may be a share of `wanted`.
        """
        ...


class OfSurvey:
    """What surveys have in common that are made of another one's scans."""

    def __init__(self, survey: Survey) -> None:
        self._survey = survey

    @property
    def pose_kind(self) -> str:
        """Of which kind the poses are: see `pose_kind.find_pose_kind`."""
        return self._survey.pose_kind

    def describe_damage(self) -> list[str]:
        """Return what could not be read so far, in sentences."""
        return self._survey.describe_damage()

    def describe_rays(self) -> list[str]:
        """Return what stands for rays where the recording has none, in sentences."""
        return self._survey.describe_rays()

    def describe_gaps(self) -> list[str]:
        """Return whether its recordings lie far apart in time, as a sentence."""
        return self._survey.describe_gaps()
