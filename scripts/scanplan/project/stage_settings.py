"""What each stage receives of a dataset's settings, as keywords.

The same height, width or gap has one key and goes to every stage that asks for it, under the name
that the stage knows it by. No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project.settings import merge_settings
from scanplan.project.settings_schema import ADVANCED

if TYPE_CHECKING:
    from scanplan.types import Settings

Keywords = dict[str, Any]

_PLAN_BELOW_DOOR_M = 0.1  # less: walls above doors close ways through; more: low openings are lost
SAME_FACE_DEG = 10.0
"""What noise turns the normals of short segments of one face by, at most."""
_CORNER_M = 0.25  # a door's reveal, and what an end may be wrong by
_REGISTRATION_SIGMA_M = 0.02  # of a scan's place, where poses are not optimised together
_MAX_SIGMA_M = 0.05  # of a wall's offset: beyond it, it is to be verified
_PLAN: dict[str, Keywords] = {
    "merge": {
        "max_angle_deg": SAME_FACE_DEG,
        "ghost_distance_m": 0.3,  # ASSUME a second image of a face lies nearer
        "ghost_share": 0.2,  # of the stronger one's points a metre
        "align_gap_m": 2.0,  # a double door, across which a wall goes on
        "registration_sigma_m": _REGISTRATION_SIGMA_M,
        "min_length_m": 0.3,  # a shorter face is a leg, a frame or a box
        "min_points_per_m": 5.0,  # one in 20 cm: fewer are strays
        "lone_length_m": 1.0,  # so long a face is none by chance, though few scans show it
        "corner_m": _CORNER_M,
    },
    "trace": {
        "band_m": 0.06,  # three times what registration may be wrong by
        "reach_m": 2.0,  # the next door of a wall, and what follows it
    },
    "ranges": {
        "sigma_m": 0.01,  # of beams' constant errors, as data sheets have it
        "max_incidence_deg": 60.0,  # beyond, a beam's spot on the wall is twice as long as wide
    },
    "furniture": {"furniture_depth_m": 1.0},  # a gap no deeper is a niche, where rays end before
    "pair": {
        "max_angle_deg": 5.0,  # more pairs what lies side by side, less parts short walls' sides
        "offset_m": 0.08,  # all faces of one side lie so near to one line
    },
    # behind furniture; of a longer pause that no ray tells nothing is known
    "openings": {"max_closed_m": 2.0},
    "rooms": {"min_walled": 0.7},  # of the outline, where no sensor was in a room
    # half of a wall inferred is to be verified
    "trust": {"max_sigma_m": _MAX_SIGMA_M, "min_observed": 0.5},
}
"""What no survey needed another value of, by part of the plan."""
_THESIS_RANSAC = ("inlier_m", "seed", "model")
_THESIS = {
    "thesis_iterative_ransac": _THESIS_RANSAC,
    "thesis_cluster_ransac": (*_THESIS_RANSAC, "reach_deg", "projection"),
}
"""What the thesis's extractors go by: no gap, furniture or height."""
_POINTS_ONLY = ("min_range_m", "max_range_m", "deskew", "max_damaged_share")
_ASSUMED = ("assumed_thickness_m", "assumed_height_m")
_OF_PRESENTATION = ("catalogue", "max_change_m")
_OF_FILES = ("formats", "cloud", *_OF_PRESENTATION)
"""What the drawings do not depend on."""
_MOST_CHUNKS = 1000
"""Jobs of one stage: a recording of 4,000 GB has as many by default, and no cluster more nodes."""
_OF_THE_WORKFLOW = ("building", "recording")


def count_chunks(name: str, recorded_gb: float, chunk_gb: float) -> int:
    """Return into how many jobs a stage of a dataset is divided.

    Raises
    ------
    StageError
        If they are more than a run can have.
    """
    n_chunks = max(1, int(recorded_gb / chunk_gb))
    if n_chunks > _MOST_CHUNKS:
        fault = f"{chunk_gb:g} GB a job make {n_chunks:,} jobs of a stage of {name}"
        limit = f"at most {_MOST_CHUNKS:,} can be run"
        raise StageError(f"advanced.jobs.chunk_gb: {fault}, {limit}; give more")
    return n_chunks


def select_section(settings: Settings, *keys: str) -> Any:
    """Return a section with what `advanced` has of it, or the value of a key.

    Raises
    ------
    KeyError
        If there is no such section.
    """
    usual, tuned = _look_up(settings, keys), _look_up(settings[ADVANCED], keys)
    if usual == tuned == {}:
        raise KeyError(".".join(keys))
    return merge_settings(usual, tuned) if isinstance(usual, dict) else usual


def select_topics(settings: Settings) -> Keywords:
    """Return what poses depend on of the input: all but what is done to the points."""
    return _without(select_section(settings, "input"), _POINTS_ONLY)


def select_crispness(settings: Settings) -> Keywords:
    """Return the keywords of `measure_crispness`."""
    return select_section(settings, "crispness") | {"seed": settings["seed"]}


def select_hulls(settings: Settings) -> Keywords:
    """Return the keywords of `build_hulls`."""
    return select_section(settings, "hulls") | {"seed": settings["seed"]}


def select_hull_sampling(settings: Settings) -> Keywords:
    """Return settings of the hulls but for the number of clusters."""
    return _without(select_hulls(settings), ("n_clusters",))


def select_visibility(settings: Settings) -> Keywords:
    """Return the keywords of `visibility_polygon`: views end below the wall above a door."""
    own = select_section(settings, "selection", "visibility")
    return own | {"max_height_m": settings["building"]["door_height_m"]}


def select_wall_cells(settings: Settings, limits: Iterable[str]) -> Keywords:
    """Return what makes returns a wall: limits of the thesis's extractor, and the cells' size."""
    known = select_extractor(settings, "cluster_ransac")
    known |= {"wall_height_m": settings["building"]["wall_height_m"]}
    own = select_section(settings, "selection", "wall_length")
    return {name: known[name] for name in limits} | own


def select_order(settings: Settings, names: Iterable[str]) -> Keywords:
    """Return the settings that an ordering depends on, see `selection.methods.SETTINGS`."""
    selection = select_section(settings, "selection")
    budget = {name: selection["stop"][name] for name in ("max_points", "max_bytes")}
    known = selection | {"budget": budget, "seed": settings["seed"]}
    return {name: known[name] for name in names}


def select_extractor(settings: Settings, extractor: str) -> Keywords:
    """Return the keywords of an extractor's settings: shared ones, the building's, its own."""
    walls, building = select_section(settings, "walls"), settings["building"]
    shared = {key: value for key, value in walls.items() if not isinstance(value, dict)}
    known = shared | {"door_height_m": building["door_height_m"], "seed": settings["seed"]}
    known |= {"corner_m": _CORNER_M}
    if extractor not in _THESIS:
        return known | walls.get(extractor, {})
    known |= walls["cluster_ransac"] | walls["thesis_ransac"]
    return {name: known[name] for name in _THESIS[extractor]}


def select_extractors(settings: Settings, extractors: Iterable[str]) -> dict[str, Keywords]:
    """Return the keywords of each extractor's settings, by its name."""
    return {extractor: select_extractor(settings, extractor) for extractor in extractors}


def select_plan(settings: Settings) -> Keywords:
    """Return what `planning.make_plan_settings` takes: keywords by part."""
    plan, building = select_section(settings, "plan"), settings["building"]
    gap = {"max_gap_m": settings["walls"]["max_gap_m"]}
    low = {"door_height_m": round(building["door_height_m"] - _PLAN_BELOW_DOOR_M, 6)}
    thickness = {key: building[key] for key in ("min_thickness_m", "max_thickness_m")}
    own = {
        "merge": plan["merge"] | gap,
        "trace": gap | low,
        "ranges": {},
        "furniture": {"furniture_height_m": building["furniture_height_m"]},
        "pair": thickness,
        "openings": plan["openings"] | {"max_door_m": building["max_door_m"]},
        "rooms": plan["rooms"],
        "trust": {"min_scans": plan["merge"]["min_scans"]},
    }
    return {part: keywords | own[part] for part, keywords in _PLAN.items()}


def select_drawing(settings: Settings) -> Keywords:
    """Return the settings of `export_plan`."""
    return _without(select_section(settings, "plan", "export"), _OF_FILES)


def select_presentation(settings: Settings) -> Keywords:
    """Return the settings of `export_presentation`, with the name of its catalogue."""
    export = select_section(settings, "plan", "export")
    own = {key: export[key] for key in _OF_PRESENTATION}
    return _without(select_drawing(settings), ("map_cell_m",)) | own


def select_assumed(settings: Settings) -> Keywords:
    """Return what drawings assume where it was not seen."""
    export = select_section(settings, "plan", "export")
    return {key: export[key] for key in _ASSUMED}


def select_design(settings: Settings) -> Keywords:
    """Return the settings of `compare_design`: four of drawings, and the design's storey."""
    export = select_section(settings, "plan", "export")
    own = {key: export[key] for key in (*_ASSUMED, "project", "units")}
    return own | {"design_storey": settings["plan"]["design"]["storey"]}


def select_files(settings: Settings) -> Keywords:
    """Return the settings of `export_files`, with the name of the catalogue of sizes."""
    export = select_section(settings, "plan", "export")
    own = ("author", "organisation", "project", "storey", "site", "map_cell_m")
    return {key: export[key] for key in (*_ASSUMED, *own, "units", "language", *_OF_PRESENTATION)}


def select_cloud(settings: Settings) -> Keywords:
    """Return the settings of `export_cloud`."""
    export = select_section(settings, "plan", "export")
    return {**export["cloud"], "site": export["site"]}


def select_merging(settings: Settings) -> Keywords:
    """Return the keywords of `merging.MergeSettings`."""
    return select_plan(settings)["merge"]


def select_validation(settings: Settings) -> Keywords:
    """Return the keywords of `prediction.ValidationSettings`."""
    plan = select_section(settings, "plan")
    sigma = {"registration_sigma_m": _REGISTRATION_SIGMA_M, "max_sigma_m": _MAX_SIGMA_M}
    return plan["validation"] | sigma | {"seed": settings["seed"]}


def select_visit(settings: Settings) -> Keywords:
    """Return the keywords of `next_visit.VisitSettings`."""
    return select_section(settings, "plan", "next_visit")


def select_simulation(settings: Settings) -> Keywords:
    """Return the keywords of `simulate_survey`."""
    return _without(settings["simulate"], _OF_THE_WORKFLOW)


def _without(section: Settings, names: Iterable[str]) -> Keywords:
    return {key: value for key, value in section.items() if key not in names}


def _look_up(settings: Settings, keys: Iterable[str]) -> Any:
    for key in keys:
        settings = settings.get(key, {})
    return settings
