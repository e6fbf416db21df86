"""The wall extractors by name: one place to look one up, or to add one."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from scanplan.extraction import cluster_ransac, iterative_ransac


@dataclass(frozen=True)
class Extractor:
    """A way to find the wall segments of one scan.

    Attributes
    ----------
    settings : type
        Made from the keywords of the configuration.
    extract : callable
        Called with `scan_id`, `xyz_m` and the keywords `sensor_xyz_m`, `planar` and `settings`.
    """

    settings: Callable[..., Any]
    extract: Callable[..., Any]


EXTRACTORS = {
    "cluster_ransac": Extractor(
        cluster_ransac.ClusterRansacSettings, cluster_ransac.extract_by_clusters
    ),
    "iterative_ransac": Extractor(
        iterative_ransac.IterativeRansacSettings, iterative_ransac.extract_iteratively
    ),
}
