"""Wall segments of scans that are not in a table: changed, thinned, or of other settings."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scanplan.extraction import extractors, segments
from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.lab.evaluation import first_ranks
from scanplan.lab.evaluation.wall_findings import Findings
from scanplan.lab.evaluation.wall_metrics import measure_first_scans
from scanplan.types import Array, FloatArray, IntArray, Settings
from thesis.comparison.survey_findings import SurveyTruth

_EXTRACTOR = extractors.EXTRACTORS["cluster_ransac"]


@dataclass(frozen=True)
class WallSearch:
    """Cluster RANSAC, with its settings.

    Attributes
    ----------
    settings : cluster_ransac.ClusterRansacSettings
    max_rmse_m : float
    planar : bool
        Whether the sensor measures in one plane only.
    """

    settings: ClusterRansacSettings
    max_rmse_m: float
    planar: bool

    def change(self, **changed: Any) -> "WallSearch":
        """Return the search with other settings."""
        return replace(self, settings=replace(self.settings, **changed))

    def find(
        self, scan_id: int, xyz_m: FloatArray, sensor_xyz_m: FloatArray
    ) -> segments.WallSegments:
        """Return the segments of one scan, (n, 3) in the map, of a sensor at (3,)."""
        finder = extractors.WallFinder(_EXTRACTOR, self.settings, self.planar, self.max_rmse_m)
        return extractors.find_wall_segments(
            scan_id, xyz_m, sensor_xyz_m=sensor_xyz_m, finder=finder
        )

    def find_all(
        self, survey: SurveyTruth, scans: Iterable[tuple[int, FloatArray]]
    ) -> dict[str, Array]:
        """Return the columns of `schemas.WALLS` of scans of a survey, given with their ids."""
        known = survey.registered
        ids: list[int] = []
        found = []
        for scan_id, xyz_m in scans:
            row = np.searchsorted(known.scan_ids, scan_id)
            found.append(self.find(scan_id, xyz_m, known.map_from_sensor[row, :3, 3]))
            ids.append(scan_id)
        return segments.segment_columns(ids, found)


def make_wall_search(settings: Settings, *, planar: bool) -> WallSearch:
    """Return the search with the settings that `stage_settings.select_extractor` selects."""
    finder = extractors.make_wall_finder(_EXTRACTOR, settings, planar=planar)
    own = extractors.select_settings(ClusterRansacSettings, settings)
    return WallSearch(own, finder.max_rmse_m, planar)


def measure_walls(survey: SurveyTruth, findings: Findings, rows: IntArray) -> dict[str, Any]:
    """Measure the walls of some scans.

    Parameters
    ----------
    findings : wall_findings.Findings
        Of its scans.
    rows : (k,) int
        The scans'; walls of others do not count.

    Returns
    -------
    dict
        As `wall_metrics.measure_first_scans`.
    """
    rank = np.full(len(survey.registered.scan_ids), first_ranks.NEVER)
    rank[rows] = 1
    (measured,) = measure_first_scans(survey.visible, findings, rank, [1])
    return measured
