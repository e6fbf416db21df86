"""Stages run one after the other on a recording, in this process."""

from functools import partial

from assemble_plan import assemble_plan
from extract_chosen_walls import extract_chosen_walls
from helpers.default_settings import SETTINGS
from interpolate_poses import interpolate_poses
from observe_walls import observe_walls
from order_scans import order_scans
from register_scans import register_scans
from scanplan.plan import floorplan_files, planning
from scanplan.project import stage_settings
from scanplan.selection import methods
from scanplan.store import doubts, schemas
from scanplan.validation.verdict import judge_plan
from validate_plan import validate_plan

_TABLES = ("poses", "motion", "scans", "registration", "edges", "seen", "order", "segments")
_RATINGS = {"elements": "validation", "rays": "validation_rays", "confidence": "confidence"}


def make_plan(place, recordings, *, until="plan", part=None, **topics):
    """Run the stages up to the plan, or to the registration; return what is doubted.

    Parameters
    ----------
    place : pathlib.Path
    recordings : list of str
    until : {"plan", "registration"}
    part : int, optional
        Of the section `registration`.
    **topics
        Settings of the section `input` that are not the default.

    Returns
    -------
    doubts.Doubts
    """
    files = {name: place / f"{name}.parquet" for name in _TABLES}
    plan = {table: place / f"plan_{table}.parquet" for table in planning.TABLES}
    section = partial(stage_settings.select_section, SETTINGS)
    interpolate_poses(
        recordings,
        files["poses"],
        moved=files["motion"],
        **section("poses"),
        **(stage_settings.select_topics(SETTINGS) | topics),
    )
    register_scans(
        recordings,
        *(files[name] for name in ("poses", "scans", "registration", "edges")),
        reading=section("input") | topics,
        settings=section("registration") | {"part": part},
        moved=files["motion"],
    )
    if until == "registration":
        return doubts.read_doubts(files["registration"], schemas.REGISTRATION)
    scanned = files["scans"], files["registration"]
    cells = stage_settings.select_wall_cells(SETTINGS, methods.WALL_LIMITS)
    observe_walls(*scanned, files["seen"], settings=cells)
    ordering = stage_settings.select_order(SETTINGS, methods.METHODS["wall_length"].settings)
    others = {"observations": files["seen"]}
    order_scans(files["scans"], files["order"], method="wall_length", others=others, **ordering)
    stop = section("selection", "stop")
    extract_chosen_walls(
        *scanned,
        files["order"],
        files["segments"],
        extractor="cluster_ransac",
        settings=stage_settings.select_extractor(SETTINGS, "cluster_ransac"),
        stop=stop,
    )
    settings = stage_settings.select_plan(SETTINGS)
    assemble_plan(files["segments"], files["order"], *scanned, plan, settings=settings, **stop)
    rated = {name: place / f"{file}.parquet" for name, file in _RATINGS.items()}
    validate_plan(
        plan
        | {"selection": files["order"]}
        | {name: files[name] for name in ("scans", "registration")},
        rated,
        settings=stage_settings.select_validation(SETTINGS),
        **stop,
    )
    return _read_plan(place).doubted


def read_verdict(place):
    """Return the verdict on the plan that `make_plan` has made."""
    return judge_plan(_read_plan(place))


def _read_plan(place):
    plan = {table: place / f"plan_{table}.parquet" for table in planning.TABLES}
    return floorplan_files.read_floorplan({**plan, "confidence": place / "confidence.parquet"})
