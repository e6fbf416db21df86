"""The settings of the registration: section `registration` of the configuration, typed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import twists
from scanplan.types import FloatArray, Settings

FRAMES = "frames"
"""Scans are compared with the candidates before them, retained or not (thesis, algorithm 3)."""

_SURVEYED_SIGMA_M = 0.003  # what surveyors' programs state of registered stations
_SURVEYED_SIGMA_DEG = 0.02  # 2 mm at 5 m


@dataclass(frozen=True, kw_only=True)
class SequentialSettings:
    """Limits of the sequential registration (thesis, algorithm 3) and of single alignments.

    Attributes
    ----------
    voxel_m, voxel_planar_m : float
        Metres. Edge of the voxels that a scan is thinned to for fitting, in space and in the plane.
    voxels : int
        A scan in space that occupies fewer voxels is thinned to smaller ones.
    compare_with : str
        `retained`, or `FRAMES`, which goes by none of the limits on corrections and knows neither
        anchors nor links to more than one scan.
    n_previous : int
        Fitness is the mean over at most this many of the last retained scans, or candidates.
    previous_apart_m : float
        Metres. Retained scans farther away show other rooms and do not count.
    previous_turn_deg : float
        Degrees. Nor do retained scans that are turned away by more.
    fitness_distance_m : float
        Metres. A point has a neighbour if one is nearer than this.
    fitness_points : int
        Fitness is measured on about this many points of a thinned scan.
    min_prior_fitness, min_refined_fitness : float
        Share, 0 to 1. Thresholds on the fitness at the localiser's pose and after alignment.
    min_facing_fitness : float
        Share, 0 to 1. Threshold on the overlap of surfaces that face the same way, in space; in the
        plane an alignment with less counts for as much less.
    icp_method : str
        A method of `icp.align_clouds`, or `sequential.GIVEN_POSES`.
    icp_targets, icp_targets_planar : int
        A scan is aligned to this many retained scans: in space evenly chosen among the last
        `n_previous`, in the plane the last ones.
    icp_distances_m : sequence of float
        Metres. Largest distance of corresponding points: in the rough, then in the fine alignment.
    icp_max_iterations : int
        Of each of these.
    max_correction_m, max_correction_deg : float
        Metres and degrees. An alignment that moves a scan farther has failed.
    localiser_sigma_m, localiser_sigma_deg, localiser_sigma_tilt_deg : float
        Metres and degrees. Standard deviations of the localiser's position, of its heading, and of
        its roll and pitch.
    anchor_after : int
        The n-th rejected scan in a row is kept at the localiser's pose: an anchor.
    anchor_apart_m : float
        Metres. So is a rejected scan at once that is farther from all those before it.
    min_points : int
        Scans with fewer points are dropped.
    """

    voxel_m: float
    voxel_planar_m: float
    voxels: int
    compare_with: str
    n_previous: int
    previous_apart_m: float = 2.0  # what is farther off shows other rooms
    previous_turn_deg: float = (
        60.0  # a laser's half circle shows a third less, a camera something else
    )
    fitness_distance_m: float
    fitness_points: int
    min_prior_fitness: float
    min_refined_fitness: float
    min_facing_fitness: float = (
        0.3  # floors lie on floors anywhere: so much of a scan must face the same way
    )
    icp_method: str
    icp_targets: int
    icp_targets_planar: int
    icp_distances_m: Sequence[float]
    icp_max_iterations: int = 30  # steps: a bound on time
    max_correction_m: float
    max_correction_deg: float
    localiser_sigma_m: float
    localiser_sigma_deg: float
    localiser_sigma_tilt_deg: float = 0.3  # floor or gravity give roll and pitch
    anchor_after: int = 5  # ASSUME who blocks the view is gone after 2.5 m of way
    anchor_apart_m: float = 5.0  # a room: no scan before shows what this one does
    min_points: int

    def localiser_information(self, priors: FloatArray) -> FloatArray:
        """Return the inverse covariances (..., 6, 6) of the localiser's poses (..., 4, 4).

        They are those of the poses' errors as twists in their own frames.
        """
        heading, tilt = np.radians([self.localiser_sigma_deg, self.localiser_sigma_tilt_deg])
        sigma = np.array([self.localiser_sigma_m] * 3 + [tilt, tilt, heading])
        return twists.pose_information(sigma, priors)


@dataclass(frozen=True, kw_only=True)
class PoseGraphSettings:
    """How all retained scans are optimised together.

    Attributes
    ----------
    optimise : bool
        Whether they are; otherwise they stay as registered one after the other.
    loop_radius_m : float
        Metres. Scans farther apart get no constraint, but loops in the plane if they show the same.
    loop_apart : int
        Nor do scans with fewer retained scans than this between them (loops).
    loop_step_m, loop_step_planar_m : float
        Metres. Scans this far apart along the way get loop constraints, in space and in the plane.
    loops_per_scan, loops_per_scan_planar : int
        Such a scan is linked to this many earlier visits of its surroundings, in space, and in the
        plane to this many earlier scans that show the same.
    loop_min_fitness : float
        Share, 0 to 1. Pairs whose surfaces that face the same way overlap less get no constraint.
    edge_sigma_m, edge_sigma_deg : float
        Metres and degrees. Least standard deviation of a constraint's shift and turn.
    kernel_sigmas : float
        A measurement this many standard deviations off counts a quarter.
    """

    optimise: bool
    loop_radius_m: float = 5.0  # a room: what is farther apart shares little
    loop_apart: int = 6  # nearer ones are linked in sequence
    loop_step_m: float = 0.5  # what lies between two that are linked hangs on both
    loop_step_planar_m: float = (
        0.05  # a line of points shows less: more links are needed, and cost little
    )
    loops_per_scan: int = 1  # of ten visits of one building 4, 2 and 1 err alike within 0.1 mm
    loops_per_scan_planar: int = 4  # less of a planar scan's surroundings is seen in each
    loop_min_fitness: float = 0.25  # half circles that pass each other share little more
    edge_sigma_m: float = 0.002  # systematic errors of the sensor, which pairs do not show
    edge_sigma_deg: float = 0.01  # the same of a link's turn
    kernel_sigmas: float = 3.0  # beyond it a measurement is rather wrong than noisy


@dataclass(frozen=True, kw_only=True)
class DriftSettings:
    """How far poses that drift are expected to be off.

    Attributes
    ----------
    drift_share : float
        Share, above 0. Of the way that was driven, and of the angle that was turned.
    drift_deg_per_m : float
        Degrees. Of the heading, a metre of way.
    submap_m : float
        Metres. The scans of so much way are recognised together.
    """

    drift_share: float = 0.02  # ASSUME twice what the scale of simulated wheels is off by
    drift_deg_per_m: float = 0.1  # ASSUME 10 degrees after 100 m
    submap_m: float = 4.0  # a room, or a corridor with its doors, is unlike others


@dataclass(frozen=True)
class RegistrationSettings:
    """Section `registration` of the configuration.

    Attributes
    ----------
    limits : SequentialSettings
    graph : PoseGraphSettings
    part : int, optional
        Of a drive in parts that nothing ties the number of the one to take, 1 the first; by default
        the largest.
    drift : DriftSettings
    batch_size : int
        So many candidates are registered one after the other on one core.
    """

    limits: SequentialSettings
    graph: PoseGraphSettings
    part: int | None = None
    drift: DriftSettings = DriftSettings()
    batch_size: int = 100  # at most 50 m of way, so that two cores share a short drive

    def of_stations(self) -> "RegistrationSettings":
        """Return them for surveyed poses: exact to millimetres, and kept though others show none.

        Stations of two rooms share what is seen through a door.
        """
        surveyed = replace(
            self.limits,
            localiser_sigma_m=_SURVEYED_SIGMA_M,
            localiser_sigma_deg=_SURVEYED_SIGMA_DEG,
            localiser_sigma_tilt_deg=_SURVEYED_SIGMA_DEG,
            anchor_apart_m=0.0,
        )
        return replace(self, limits=surveyed)


def registration_settings(section: Settings) -> RegistrationSettings:
    """Return the `RegistrationSettings` of a section `registration`."""
    apart = ("graph", "part", "batch_size")
    limits = {key: value for key, value in section.items() if key not in apart}
    return RegistrationSettings(
        limits=SequentialSettings(**limits),
        graph=PoseGraphSettings(**section["graph"]),
        part=section["part"],
        batch_size=section.get("batch_size", RegistrationSettings.batch_size),
    )
