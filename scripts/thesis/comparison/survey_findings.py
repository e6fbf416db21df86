"""What a survey truly saw, and what wall segments of its scans find of it, read from its files."""

from dataclasses import dataclass

from scanplan.lab.evaluation import bitmap_shares, truth_file, wall_findings
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.lab.evaluation.wall_findings import Findings, VisibleTruth
from scanplan.store import registered_scans
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import Columns, FilePath, FloatArray


@dataclass(frozen=True)
class SurveyTruth:
    """The registered scans of a survey, and what they could see.

    Attributes
    ----------
    registered : registered_scans.RegisteredScans
    placed : (n, 4, 4) float64
        The true poses of the sensor at these scans.
    faces : truth_file.TrueFaces
    visible : wall_findings.VisibleTruth
        By these scans.
    """

    registered: RegisteredScans
    placed: FloatArray
    faces: TrueFaces
    visible: VisibleTruth


def read_survey_truth(
    registration: FilePath, truth: FilePath, true_poses: FilePath, *, max_range_m: float
) -> SurveyTruth:
    """Read what the registered scans of a survey could see.

    Parameters
    ----------
    registration, truth, true_poses : path-like
        registration.parquet, truth.geojson and truth_poses.tum.
    max_range_m : float
        How far a scan can see.

    Raises
    ------
    StageError
        If a file cannot be used, or a scan has no true pose.
    """
    registered = registered_scans.read_registered_scans(registration)
    poses = truth_file.read_true_poses(true_poses)
    placed = truth_file.interpolate_true_poses(poses, registered.t_ns, true_poses)
    faces = truth_file.read_true_faces(truth)
    sight = truth_file.read_sensor_view(truth, max_range_m=max_range_m)
    visible = wall_findings.observe_truth(faces, placed, placed, sight=sight)
    return SurveyTruth(registered, placed, faces, visible)


def match_walls(survey: SurveyTruth, walls: Columns, bitmap_cell_m: float) -> Findings:
    """Work out what the wall segments of scans find.

    Parameters
    ----------
    walls : dict of str to (s,) array
        Columns of `schemas.WALLS`, of registered scans alone.
    bitmap_cell_m : float
        Edge of a bitmap's cell.

    Returns
    -------
    wall_findings.Findings
    """
    known = survey.registered
    drawn = wall_findings.place_segments(
        walls, known.scan_ids, known.map_from_sensor, survey.placed
    )
    bitmaps = bitmap_shares.trace_truth(survey.faces.inner_m, drawn.lines_m, bitmap_cell_m)
    return wall_findings.match_segments(drawn, survey.visible, bitmaps)
