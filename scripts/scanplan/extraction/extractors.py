"""Wall segments of one scan by any extractor.

The extractors by name stand here and nowhere else. Of the thesis's own clutter is none.
"""

import math
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import TYPE_CHECKING, Any, TypeVar

from scanplan.extraction import (
    cluster_ransac,
    iterative_ransac,
    segments,
    thesis_ransac,
)
from scanplan.extraction.segment_limits import ExtractorSettings, SegmentRow
from scanplan.rays.ray_set import RaySet
from scanplan.rays.sensor_frame import centre_in_order
from scanplan.types import FloatArray, Settings

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_MAX_RMSE_M = 0.025  # clutter that fills the band of `inlier_m`, 0.05 m, scatters by 0.029
_Class = TypeVar("_Class", bound="DataclassInstance")


@dataclass(frozen=True)
class Extractor:
    """A way to extract the wall segments of one scan.

    Attributes
    ----------
    settings : type
        A class of settings, with those of `ExtractorSettings`.
    extract : callable
        Called with the scan's id, its points, its rays and the settings; returns rows of
        `segments.describe_run`.
    drops_clutter : bool
        Whether segments whose points scatter too much are none.
    """

    settings: type[ExtractorSettings]
    # the class of the last argument is that of `settings`
    extract: Callable[[int, FloatArray, RaySet | None, Any], list[SegmentRow]]
    drops_clutter: bool = True


EXTRACTORS: dict[str, Extractor] = {
    "cluster_ransac": Extractor(
        cluster_ransac.ClusterRansacSettings, cluster_ransac.extract_by_clusters
    ),
    "iterative_ransac": Extractor(
        iterative_ransac.IterativeRansacSettings, iterative_ransac.extract_iteratively
    ),
    "thesis_cluster_ransac": Extractor(
        thesis_ransac.ThesisClusterSettings,
        thesis_ransac.extract_of_clusters,
        drops_clutter=False,
    ),
    "thesis_iterative_ransac": Extractor(
        thesis_ransac.ThesisIterativeSettings,
        thesis_ransac.extract_repeatedly,
        drops_clutter=False,
    ),
}


def select_settings(kind: type[_Class], settings: Settings) -> _Class:
    """Make a dataclass of settings from the values it has fields for, among more of them.

    A field with a default may be missing.
    """
    wanted = [f.name for f in fields(kind) if f.default is MISSING or f.name in settings]
    return kind(**{name: settings[name] for name in wanted})


@dataclass(frozen=True)
class WallFinder:
    """How the wall segments of a survey's scans are found.

    Attributes
    ----------
    settings : ExtractorSettings
        Of the extractor's class.
    planar : bool
        Whether all points of a scan are in one horizontal plane.
    max_rmse_m : float, > 0
        Segments whose points scatter more about their line are clutter.
    """

    extractor: Extractor
    settings: ExtractorSettings
    planar: bool
    max_rmse_m: float = math.inf


def make_wall_finder(extractor: Extractor, settings: Settings, *, planar: bool) -> WallFinder:
    """Return an extractor with its own among more settings, as a plan uses it."""
    own = select_settings(extractor.settings, settings)
    max_rmse_m = _MAX_RMSE_M if extractor.drops_clutter else math.inf
    return WallFinder(extractor, own, planar, max_rmse_m)


def find_wall_segments(
    scan_id: int, xyz_m: FloatArray, *, sensor_xyz_m: FloatArray, finder: WallFinder
) -> segments.WallSegments:
    """Extract the wall segments of one scan.

    Parameters
    ----------
    xyz_m : (n, 3) float
        The scan's points, map frame; their order does not matter.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    points = centre_in_order(xyz_m, sensor_xyz_m)
    scan = segments.view_scan(points, planar=finder.planar)
    rows = finder.extractor.extract(scan_id, points, scan, finder.settings)
    return segments.collect_segments(rows, sensor_xyz_m, finder.max_rmse_m)
