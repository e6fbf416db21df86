"""What the report states: facts of the survey behind a plan, and of the run that made it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from scanplan.report.point_image import PointImage
from scanplan.stage.run_times import JobCost
from scanplan.types import Columns, FloatArray, Settings


@dataclass(frozen=True)
class PredictionFacts:
    """How well the plan predicts rays of scans that it was not made of.

    Attributes
    ----------
    n_scans, n_rays : int
    share : float
        Of these rays, that ended where the plan says; NaN where it is not known.
    bounds : (float, float)
        Of its 95 % interval.
    length_share : float
        Mean share that agrees with the plan's elements, by their length; NaN likewise.
    n_stopped, n_passed, n_beyond : int
        What became of the others, see `schemas.VALIDATION`.
    absent : str
        Why the share is not known; empty if it is.
    """

    n_scans: int
    n_rays: int
    share: float
    bounds: tuple[float, float]
    length_share: float
    n_stopped: int
    n_passed: int
    n_beyond: int
    absent: str = ""


@dataclass(frozen=True)
class VisitFacts:
    """What a second visit is for.

    Attributes
    ----------
    questions, standpoints : dict of str to (n,) array
        The columns of `schemas.QUESTIONS` and `STANDPOINTS`; there may be no row.
    summary : str
        In words.
    """

    questions: Columns
    standpoints: Columns
    summary: str


@dataclass(frozen=True)
class SurveyFacts:
    """What a plan was made of.

    Attributes
    ----------
    selection, registration, poses, segments, evidence : dict of str to (n,) array
        The columns of `schemas.SELECTION` (the plan's method), `REGISTRATION`, `POSES`, `WALLS`
        (the plan's extractor) and `EVIDENCE`.
    chosen : int
        How many scans of the selection make the plan.
    n_recorded : int
        How many scans were recorded, candidates and others.
    prediction : PredictionFacts
    visit : VisitFacts
    plan_measures, wall_measures : dict of str to (n,) array or None
        The columns of `schemas.PLAN_EVALUATION` and of `schemas.EVALUATION`, where the truth is
        known and they were measured.
    is_drifting : bool
        Whether the poses were odometry, so that the plan lies in its first scan's frame.
    """

    selection: Columns
    registration: Columns
    poses: Columns
    segments: Columns
    evidence: Columns
    chosen: int
    n_recorded: int
    prediction: PredictionFacts
    visit: VisitFacts
    plan_measures: Columns | None = None
    wall_measures: Columns | None = None
    is_drifting: bool = False


@dataclass(frozen=True)
class Pictures:
    """What the page draws of the scans.

    Attributes
    ----------
    points : point_image.PointImage
        What the chosen scans saw, from above.
    in_space : dict
        The same and the plan in space, see `solid_view.pack_view`.
    sights : dict
        From where doubtful elements were seen best, see `sights.find_sights`.
    way_m : (n, 2) float
        The sensor's way, map frame.
    """

    points: PointImage
    in_space: Mapping[str, Any]
    sights: Mapping[str, Any]
    way_m: FloatArray


@dataclass(frozen=True)
class Storey:
    """A storey of the building: its name, where its report lies, and whether it is this one."""

    name: str
    href: str
    is_shown: bool


@dataclass(frozen=True)
class RunFacts:
    """How it was made.

    Attributes
    ----------
    settings : dict
        All settings of the dataset.
    figures : dict of str to str
        Name to the text of an SVG file.
    costs : dict of str to JobCost
        Of each stage, in the workflow's order; what is not known is left out.
    sizes : list of (str, str, int)
        What, file name, bytes.
    results : list of str
        What was made beside the page, as paths from its folder.
    storeys : list of Storey
        Of the building, from the lowest up; none where it is of none.
    corrections : list of dict
        Entries of the dataset's file of corrections, as they stand in it.
    survey : str
        Name of the dataset, and a digest of the recordings where it is known.
    version : str
    """

    settings: Settings
    figures: Mapping[str, str]
    costs: Mapping[str, JobCost]
    sizes: Sequence[tuple[str, str, int]]
    results: Sequence[str]
    storeys: Sequence[Storey]
    corrections: Sequence[Mapping[str, object]]
    survey: str
    version: str
