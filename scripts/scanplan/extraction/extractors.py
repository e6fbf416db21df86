"""Wall segments of one scan: an extractor and the classifier of furniture, composed.

The extractors by name stand here and nowhere else. The thesis's own go without the classifier.
"""

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from typing import TYPE_CHECKING, Any, TypeVar

from scanplan.extraction import (
    cluster_ransac,
    furniture,
    iterative_ransac,
    segments,
    thesis_ransac,
)
from scanplan.extraction.segment_limits import ExtractorSettings, Row
from scanplan.rays.ray_set import RaySet
from scanplan.rays.sensor_frame import centre_in_order
from scanplan.types import FloatArray, Settings

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

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
    drops_furniture : bool
        Whether the classifier is asked which of its segments are walls.
    """

    settings: type[ExtractorSettings]
    # the class of the last argument is that of `settings`
    extract: Callable[[int, FloatArray, RaySet | None, Any], list[Row]]
    drops_furniture: bool = True


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
        drops_furniture=False,
    ),
    "thesis_iterative_ransac": Extractor(
        thesis_ransac.ThesisIterativeSettings,
        thesis_ransac.extract_repeatedly,
        drops_furniture=False,
    ),
}


def select_settings(kind: type[_Class], settings: Settings) -> _Class:
    """Make a dataclass of settings from the values it has fields for, among more of them.

    A field with a default may be missing.
    """
    wanted = [f.name for f in fields(kind) if f.default is MISSING or f.name in settings]
    return kind(**{name: settings[name] for name in wanted})


def select_limits(extractor: Extractor, settings: Settings) -> furniture.FurnitureLimits | None:
    """Return what furniture is, among more settings; None for an extractor that drops none."""
    if not extractor.drops_furniture:
        return None
    return select_settings(furniture.FurnitureLimits, settings)


def find_wall_segments(
    scan_id: int,
    xyz_m: FloatArray,
    *,
    sensor_xyz_m: FloatArray,
    planar: bool,
    extractor: Extractor,
    settings: ExtractorSettings,
    limits: furniture.FurnitureLimits | None = None,
) -> segments.WallSegments:
    """Extract the wall segments of one scan, without furniture.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 3) float
        The scan's points, map frame; their order does not matter.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.
    planar : bool
        Whether all points are in one horizontal plane.
    extractor : Extractor
    settings : ExtractorSettings
        Of the extractor's class.
    limits : furniture.FurnitureLimits, optional
        What furniture is; without them, it stays among the segments.

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    points = centre_in_order(xyz_m, sensor_xyz_m)
    scan = segments.view_scan(points, planar=planar)
    rows = extractor.extract(scan_id, points, scan, settings)
    if limits is not None:
        rows = furniture.keep_walls(rows, scan, limits)
    return segments.collect_segments(rows, sensor_xyz_m)
