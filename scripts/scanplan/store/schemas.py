"""The columns of the tables between the stages.

Coordinates are metres in the map frame, z up; stamps nanoseconds; quaternions x, y, z, w. Units are
in the names.
"""

from dataclasses import dataclass

XYZ = ("x_m", "y_m", "z_m")
QUAT = ("qx", "qy", "qz", "qw")
_POSE = dict.fromkeys((*XYZ, *QUAT), "float64")
COVARIANCE = (
    *("cov_x_x_m2", "cov_x_y_m2", "cov_x_yaw_m_rad"),
    *("cov_y_y_m2", "cov_y_yaw_m_rad", "cov_yaw_yaw_rad2"),
)
"""The upper half of a covariance (3, 3) of x, y and heading, row by row."""
_SEGMENT = dict.fromkeys(("x0_m", "y0_m", "x1_m", "y1_m", "nx", "ny"), "float64")


@dataclass(frozen=True)
class Schema:
    """The form of a table.

    Attributes
    ----------
    name : str
    version : int
        Raised whenever the columns or their meaning change.
    columns : dict of str to str
        Name to Arrow type, in order.
    sorted_by : tuple of str
        The columns that the rows are strictly sorted by.
    geometry : bool
        Whether the column `geometry` holds WKB: the file is GeoParquet then.
    outlives : bool
        Whether a table is kept when a dataset is recorded anew, and so states no recordings.
    """

    name: str
    version: int
    columns: dict[str, str]
    sorted_by: tuple[str, ...]
    geometry: bool = False
    outlives: bool = False


POSES = Schema(
    "poses",
    1,
    {"scan_id": "int32", "t_ns": "int64", **_POSE, "gap_s": "float64", "covered": "bool"},
    ("scan_id",),
)
N_RECORDED = "n_recorded"
"""Under this name a table of poses says how many scans were recorded."""
AS_RECORDED = "as_recorded"
"""Under this name it says whether each scan is one message of a bag, seen from its sensor."""
OF_POSES = "of_poses"
"""Under this name a table of motion says whether it is that of the poses, or of others in a map."""
SMEAR_MM = "smear_mm"
"""Under this name it says by how much thicker surfaces are in turns, `nan` where not known."""
MOTION = Schema(
    "motion",
    1,
    {
        "t_ns": "int64",
        "piece": "int32",
        **_POSE,
        "time_scale": "float64",
        "time_shift_s": "float64",
    },
    ("t_ns",),
)
REGISTRATION = Schema(
    "registration",
    2,
    {
        "scan_id": "int32",
        "t_ns": "int64",
        "prior_fitness": "float64",
        "refined_fitness": "float64",
        "rmse_m": "float64",
        "kept": "bool",
        "reason": "string",
        **_POSE,
        **dict.fromkeys(COVARIANCE, "float64"),
    },
    ("scan_id",),
)
EDGES = Schema(
    "edges",
    1,
    {
        "source": "int32",
        "target": "int32",
        "kind": "string",
        "fitness": "float64",
        "rmse_m": "float64",
        **_POSE,
        "unobservable": "int32",
        "residual_m": "float64",
        "residual_deg": "float64",
        "weight": "float64",
        "inlier": "bool",
    },
    ("source", "target"),
)
CRISPNESS = Schema(
    "crispness",
    1,
    {
        "poses": "string",
        "sigma_m": "float64",
        "quarter_below_m": "float64",
        "quarter_above_m": "float64",
        "n_places": "int32",
    },
    ("poses",),
)
SCANS = Schema(
    "scans",
    1,
    {"scan_id": "int32", "x_m": "float32", "y_m": "float32", "z_m": "float32"},
    ("scan_id",),
)
CHUNK_POINTS = Schema("chunk_points", 1, SCANS.columns, ("scan_id",))
"""Points of the candidates that a chunk keeps, in the sensor's frame; or what of them is aligned.

The latter, thinned, are in the frame of the cloud, which in a planar survey is levelled.
"""
CHUNK_CANDIDATES = Schema(
    "chunk_candidates",
    1,
    {
        "scan_id": "int32",
        "kept": "bool",
        "reason": "string",
        **dict.fromkeys(("prior_fitness", "refined_fitness", "rmse_m"), "float64"),
        "world_from_sensor": "binary",
    },
    ("scan_id",),
)
"""Candidates of a chunk as registered one after the other; a pose is 16 float64, row by row.

The file states how many points were dropped on reading, and what is wrong with damaged clouds.
"""
CHUNK_CONSTRAINTS = Schema(
    "chunk_constraints",
    1,
    {
        **dict.fromkeys(("constraint", "source", "target"), "int32"),
        "kind": "string",
        **dict.fromkeys(("fitness", "rmse_m"), "float64"),
        **dict.fromkeys(("target_from_source", "information"), "binary"),
        "unobservable": "int32",
        "sound": "bool",
    },
    ("constraint",),
)
"""Constraints from a chunk's scans to those before them, in the order in which they were found.

Matrices are 16 and 36 float64, row by row.
"""
HULLS = Schema(
    "hulls",
    1,
    {
        "scan_id": "int32",
        "cluster": "int32",
        "n_points": "int32",
        "area_m2": "float64",
        "geometry": "binary",
    },
    ("scan_id", "cluster"),
    geometry=True,
)
OBSERVATIONS = Schema(
    "observations",
    2,
    {
        "scan_id": "int32",
        "facing": "int32",
        "along": "int32",
        "across": "int32",
        "length_m": "float64",
        "axes_deg": "int32",
    },
    ("scan_id", "facing", "along", "across"),
)
VISIBILITY = Schema(
    "visibility",
    1,
    {"scan_id": "int32", "area_m2": "float64", "geometry": "binary"},
    ("scan_id",),
    geometry=True,
)
SELECTION = Schema(
    "selection",
    3,
    {
        "rank": "int32",
        "scan_id": "int32",
        "n_points": "int64",
        **dict.fromkeys(
            ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound"), "float64"
        ),
    },
    ("rank",),
)
WALLS = Schema(
    "walls",
    1,
    {
        "scan_id": "int32",
        "wall": "int32",
        **_SEGMENT,
        "n_points": "int32",
        "rmse_m": "float64",
        "z_min_m": "float64",
        "z_max_m": "float64",
    },
    ("scan_id", "wall"),
)
FACES = Schema(
    "faces",
    2,
    {
        "face": "int32",
        **_SEGMENT,
        "n_points": "int64",
        "n_scans": "int32",
        "rmse_m": "float64",
        "z_min_m": "float64",
        "z_max_m": "float64",
        "state": "string",
        "wall": "int32",
    },
    ("face",),
)
"""Surfaces of the plan.

`state` is observed or inferred, `wall` the wall that the face is a side of, or across which it is
a reveal (-1: of none).
"""
_CENTRELINE = dict.fromkeys(("x0_m", "y0_m", "x1_m", "y1_m"), "float64")
ARC = ("arc_x_m", "arc_y_m", "arc_radius_m", "sigma_radius_m")
"""Columns of the circle that the line of a curved wall lies on."""
PLAN_WALLS = Schema(
    "plan_walls",
    5,
    {
        "wall": "int32",
        **_CENTRELINE,
        "thickness_m": "float64",
        **dict.fromkeys(ARC, "float64"),
        "face_left": "int32",
        "face_right": "int32",
        "state": "string",
        **dict.fromkeys(
            (
                "z_min_m",
                "z_max_m",
                "top_m",
                "rmse_m",
                "sigma_offset_m",
                "sigma_end0_m",
                "sigma_end1_m",
            ),
            "float64",
        ),
        "n_points": "int64",
        "n_scans": "int32",
        **dict.fromkeys(("p_wall", "p_solid"), "float64"),
        "verify": "bool",
        "corrected": "string",
    },
    ("wall",),
)
"""Walls of the plan.

One seen from a single side is as thick as the reveals of its openings are deep; where none shows
that, it has no thickness (NaN), and its line is that of its face. `p_wall` is how likely it is a
wall by what is around it, no leaf, furniture or what is outside, `p_solid` how likely what lies
between its openings is solid, by rays (NaN: of one that a person drew).
The line of a curved wall is the shorter arc between its ends around `arc_x_m`, `arc_y_m`, of
`arc_radius_m` with its standard deviation `sigma_radius_m` (NaN: of a straight wall); its faces are
chords within 2 mm of their circle.
`corrected` says what a person said of it, here and of openings and rooms; empty where nobody did.
"""
OPENINGS = Schema(
    "openings",
    2,
    {
        "opening": "int32",
        "wall": "int32",
        "type": "string",
        **_CENTRELINE,
        **dict.fromkeys(("width_m", "thickness_m", "sill_m", "lintel_m"), "float64"),
        "room_a": "int32",
        "room_b": "int32",
        "n_rays": "int64",
        "p_kind": "float64",
        "corrected": "string",
    },
    ("opening",),
)
"""What is no wall of rooms' outlines and walls: openings, and what is not known.

`type` is door, window, passage, glass (down to the floor), gap (rays go through, or floor goes on
beyond an outline, whose rays are not counted, and it is not known what it is), or unseen (a span of
a room's outline of which nothing is known); `p_kind` the probability of the likeliest kind, NaN
where none was weighed.

Heights are above the floor, NaN where not known; -1 stands for no wall or no room. A passage in no
wall is inferred: there free floor is narrow, and parts two rooms. Missing returns count as rays,
too: as many as were expected through a window above its sill, or through a gap of planar scans.
"""
CHECKED = ("kept by hand", "checked by hand")
"""How column `corrected` begins where a person has looked, and changed nothing."""
DRAWN = ("added by hand", "drawn by hand")
"""How it begins where a person said where an element runs, or how wide or thick it is."""
ROOMS = Schema(
    "rooms",
    5,
    {
        "room": "int32",
        **dict.fromkeys(("area_m2", "perimeter_m", "x_m", "y_m"), "float64"),
        "closed": "bool",
        "n_scans": "int32",
        **dict.fromkeys(("p_whole", "p_apart"), "float64"),
        **dict.fromkeys(("number", "name", "use", "corrected"), "string"),
        "geometry": "binary",
    },
    ("room",),
    geometry=True,
)
"""Rooms: `number`, `name` and `use` are what a person calls them, empty where nobody has.

`p_whole` and `p_apart` are how likely no part of one is a room of its own, and none beside it one
with it; NaN where a person has drawn, parted or joined it.
"""
FREE = Schema("free", 3, {"part": "int32", "geometry": "binary"}, ("part",), geometry=True)
"""The floor that rays went over: polygons that do not overlap.

Of the whole plan the file states `floor_z_m` and `ceiling_z_m`: heights in the map frame, NaN where
not seen; `georeference`, where the plan lies on Earth, where reference points say so; of a
corrected plan `n_corrections`, carried out, `unmatched_corrections`, why others are not,
`opened`, rooms that are open by them, `corrected_by`, who said so and when, `lengths`, drawn, taped
and the standard deviation of both, and `scale`, what these and reference points say of all lengths,
see `survey_scale`; and `nearly`, what was nearly drawn: a list of `kind`, `ends_m` and `p`, JSON.
"""
PIECE, COLUMN, LEAF = "furniture", "column", "leaf"
"""Kinds of what stands in rooms: a column goes on to the ceiling, a leaf hangs at a door."""
SLIDING = "sliding"
"""What a person calls a leaf that slides along its wall."""
FIXTURES = ("toilet", "basin", "bath", "shower", "sink", "cooker", "stairs")
"""What a person may call a piece of furniture that has a symbol of its own in drawings."""
FURNITURE = Schema(
    "furniture",
    3,
    {
        "furniture": "int32",
        **dict.fromkeys(("kind", "named"), "string"),
        **dict.fromkeys(("area_m2", "z_min_m", "z_max_m"), "float64"),
        "n_points": "int32",
        "n_scans": "int32",
        "geometry": "binary",
    },
    ("furniture",),
    geometry=True,
)
"""What stands in rooms and is no wall: outlines, by the points of chosen scans that show it.

Of `kind` `PIECE`, `COLUMN` or `LEAF`; `named` what a person calls it, `SLIDING` or of `FIXTURES`.
Heights are in the map frame, NaN of planar scans.
"""
EVIDENCE = Schema(
    "evidence",
    1,
    {"wall": "int32", "scan_id": "int32", "t_ns": "int64", "n_points": "int32"},
    ("wall", "scan_id"),
)
"""Which scans show a wall of the plan, when they were taken and with how many points."""
PRESENTATION = Schema(
    "presentation",
    3,
    {
        "wall": "int32",
        **_CENTRELINE,
        "thickness_m": "float64",
        "thickness_from": "string",
        **dict.fromkeys(("moved_m", "turned_deg", "thickness_changed_m"), "float64"),
        "perhaps": "bool",
        "joined": "string",
    },
    ("wall",),
)
"""Walls of the regular plan, and what was changed of them.

`thickness_from` is measured, assumed, or reveals (as deep as those of its openings); lines are in
the middle of walls. A curved wall stays as it was measured: seen from one side it has no thickness
(NaN), and its line is that of its face.
`moved_m` is the greatest distance that a side was moved by at an end. `perhaps`: it may be
furniture, and is drawn as an outline. `joined`: numbers of the walls that are pieces of it.
"""
ELEMENT_IDS = Schema(
    "element_ids",
    1,
    {"kind": "string", "number": "int32", "global_id": "string"},
    ("kind", "number"),
)
"""The GlobalIds of a plan's elements: `kind` is wall, opening or room, `number` that of its table.
"""
KNOWN_ELEMENTS = Schema(
    "known_elements",
    1,
    {"kind": "string", "global_id": "string", "geometry": "binary"},
    ("kind", "global_id"),
    geometry=True,
    outlives=True,
)
"""All elements that plans of a dataset ever had, where each was when it was first seen.

`kind` is wall, room, or the type of an opening. The file states the `source` that the plans were
made of.
"""
VALIDATION = Schema(
    "validation",
    1,
    {
        "kind": "string",
        "number": "int32",
        "span": "int32",
        **_CENTRELINE,
        **dict.fromkeys(("n_rays", "n_explained", "n_stopped", "n_passed", "n_beyond"), "int64"),
        "n_places": "int32",
        **dict.fromkeys(("share", "share_low", "share_high"), "float64"),
    },
    ("kind", "number", "span"),
)
"""How well a plan predicts rays of scans that it was not made of.

A row for each element: `kind` is face, opening or outline (what is neither face nor opening of a
room's outline), `number` that of the face, opening or room, `span` counts pieces along it, between
the ends in metres. The last two rows are of the whole plan, without ends (NaN): `kind` plan_length,
the mean share of the elements by their length, and plan_rays, of all rays.

`n_rays` is how many say something of it: `n_explained` ended at a drawn surface, or went through an
opening; `n_stopped` ended before (of openings and outlines: in the way), `n_passed` went through a
drawn surface, `n_beyond` ended where nothing is drawn. `share` of them is explained, with its 95 %
interval; NaN where rays of fewer than two places (`n_places`) tell.

The file states `n_left_out` and `n_scans` (scans left out, and drawn of them), `tolerance_m`, and
`absent`: why the share of the whole is not known, if it is not.
"""
CONFIDENCE = Schema(
    "confidence",
    3,
    {
        "table": "string",
        "number": "int32",
        "p_true": "float64",
        "verify": "bool",
        "about": "string",
        "doubt": "string",
        "needs_person": "bool",
    },
    ("table", "number"),
)
"""How likely elements of a plan exist as they are drawn.

`table` is walls, faces, openings or rooms, `number` that of the element in it; `p_true` is NaN of
what a person corrected. `about` says what of an element is doubtful, empty where nothing is:
existence or kind, where `p_true` is below the level of its survey
(`validation/confidence_coefficients.py`), or it is not known what a gap is; the place of a wall
that is weakly supported; the outline of a room that is not closed, or most of whose walls are to be
verified. Those are to `verify`. What stands as it is drawn, but for its end or its width, is not.
`doubt` says in words why, `needs_person` that it would be doubted however well it was seen: for its
size, or as an opening in no wall.
"""
VALIDATION_RAYS = Schema(
    "validation_rays",
    1,
    {
        "scan_id": "int32",
        "ray": "int32",
        **dict.fromkeys(XYZ, "float32"),
        "outcome": "string",
    },
    ("scan_id", "ray"),
)
"""Where the rays ended that a plan was validated by (map frame), and what became of each.

`outcome` is explained, stopped, passed, beyond or outside: the last left through an opening, and
the plan predicts nothing of it.
"""
QUESTIONS = Schema(
    "questions",
    2,
    {
        "kind": "string",
        "number": "int32",
        "doubt": "string",
        "needs_person": "bool",
        **dict.fromkeys(("x_m", "y_m", "seeable", "seen"), "float64"),
        "standpoint": "int32",
        "geometry": "binary",
    },
    ("kind", "number"),
    geometry=True,
)
"""What a second visit is to settle: what of a plan is unseen or doubtful.

`kind` is wall, opening or room; unseen: a row of openings that was not seen; way: what an opening
leads to, that no scan was taken at. `number` is that of its table, `doubt` why it is asked,
`needs_person` that no scan is expected to settle it: a person has to look. Of its length a share is
`seeable` from places that can be reached, and `seen` from the chosen ones; `standpoint` is the one
that shows most of it, -1 where it cannot be seen.
"""
STANDPOINTS = Schema(
    "standpoints",
    1,
    {
        "standpoint": "int32",
        **dict.fromkeys(("x_m", "y_m", "heading_deg", "way_m"), "float64"),
        "n_questions": "int32",
        "geometry": "binary",
    },
    ("standpoint",),
    geometry=True,
)
"""Where a second visit is to stand, in visiting order from 1.

`heading_deg` is the direction in the map that the middle of the sensor's field is to look in, NaN
of one that sees all around; `way_m` how long the way to it is (`geometry`, empty where it is the
same place) from the one before, and to the first from where the survey began; `n_questions` how
many it shows most of.
"""
CHANGES = Schema(
    "changes",
    2,
    {
        "change": "int32",
        "element": "string",
        **dict.fromkeys(("number_a", "number_b"), "int32"),
        "verdict": "string",
        "p": "float64",
        "likely": "bool",
        **dict.fromkeys(("kind_a", "kind_b"), "string"),
        **dict.fromkeys(
            ("shift_m", "sigma_m", "x_moved_m", "y_moved_m", "length_m", "area_m2"), "float64"
        ),
        "doubt": "string",
        "whole": "int32",
        "geometry": "binary",
    },
    ("change",),
    geometry=True,
)
"""What became of the elements of an earlier survey, a, in a later one, b; all in the frame of a.

`element` is wall (a stretch of one), opening, room or furniture; `number_a` and `number_b` are its
numbers in the tables of either plan, -1 where it is in none. `verdict` is same, moved, gone, new,
altered, shut, opened or not_seen, `p` how likely that is (NaN of what was not seen), `likely`
whether it is a change of the building that counts as one; `doubt` says what else it may be. What is
gone stood where rays of b go through, what is new where rays of a did. `shift_m` is how far b lies
from a, `sigma_m` its standard deviation: of a wall across, to the left of its line in a, of an
opening the edge that differs most, along it, of furniture the way of its middle. A room is altered
where walls that bound it have changed. Rows of one `whole`, the first `change` of them, count as
one.

Of both surveys the file states the names `a` and `b`; `motion`, from the frame of b to that of a
(yaw_rad, x_m, y_m), its `covariance` of x, y and yaw about `centre_m`, `residual_m` of the faces
that agree and `share` of the smaller survey's; and `others`, motions that fit nearly as well. JSON.
"""
CONTRIBUTIONS = Schema(
    "contributions",
    1,
    {
        "contribution": "int32",
        "element": "string",
        "number": "int32",
        "survey": "string",
        "seen_share": "float64",
        "is_last": "bool",
        "age_days": "float64",
        "p_stands": "float64",
        **dict.fromkeys(("length_m", "area_m2"), "float64"),
        "geometry": "binary",
    },
    ("contribution",),
    geometry=True,
)
"""What each survey shows of the elements of a plan of several: a row for each pair.

`element` is wall, opening or room, `number` its number in the plan of all, `survey` the name of a
dataset, `seen_share` which part of it that survey saw, of what later ones did not overtake.
`is_last` marks the latest that saw at least half of what any saw of it, `age_days` the time from
then to the latest survey; `p_stands` is how likely the element is still as it was then: 1 of what
the latest survey saw. The file states the `surveys` in their order and the `scans` of each. JSON.
"""
DEVIATIONS = Schema(
    "deviations",
    1,
    {
        "deviation": "int32",
        "element": "string",
        "guid": "string",
        "name": "string",
        **dict.fromkeys(("number_design", "number_built"), "int32"),
        "verdict": "string",
        "p": "float64",
        "fault": "bool",
        **dict.fromkeys(("kind_design", "kind_built"), "string"),
        **dict.fromkeys(
            (
                *("shift_m", "sigma_m", "limit_m", "x_moved_m", "y_moved_m"),
                *("length_m", "area_m2", "built_m2"),
            ),
            "float64",
        ),
        "doubt": "string",
        "geometry": "binary",
    },
    ("deviation",),
    geometry=True,
)
"""How what was built differs from its design; all in the frame of the design, metres.

`element` is wall (a stretch of one), opening, room or column; `guid` and `name` are the design's,
empty of what it lacks; `number_design` counts its elements of a kind in the order of the file,
`number_built` is that of the plan's table, -1 where it is in none. `verdict` is within (the
tolerance `limit_m`), deviates, kind_differs, missing, additional, undecided (measured too coarsely
to tell) or not_seen, `p` how likely that is (NaN of the last two), `fault` whether it counts as one
that differs. `shift_m` is how far it was built off, `sigma_m` its standard deviation: of a wall
across, to the left of its line in the design, of an opening the edge that differs most, along it,
of a column the way of its middle. `built_m2` is the area of a room as built.

The file states what that of `CHANGES` states, with the design as a, the name of its `storey`, the
height `floor_m` of that in the design, and the `tolerances`. JSON.
"""
_WITHIN = ("005m", "010m", "015m")
_SHARES = ("false_negative", "correct_match", "false_positive")
_AGREEMENT = {
    **{f"{metric}{share}": "float64" for metric in ("", "literal_") for share in _SHARES},
    **{
        f"{truth}{measure}_{within}": "float64"
        for truth in ("", "visible_")
        for measure in ("completeness", "correctness", "f1")
        for within in _WITHIN
    },
    "n_walls": "int32",
    **dict.fromkeys(("walls_per_true_wall", "redundancy"), "float64"),
}
EVALUATION = Schema(
    "evaluation",
    4,
    {
        "method": "string",
        "extractor": "string",
        "k": "int32",
        **_AGREEMENT,
        **dict.fromkeys(
            (
                "entered_completeness_010m",
                "walls_per_true_wall_of_a_scan",
                "seen",
                "missed_not_seen",
                "missed_misregistered",
                "missed_misextracted",
                "oracle_share",
            ),
            "float64",
        ),
    },
    ("method", "extractor", "k"),
)
POSE_ERRORS = Schema(
    "pose_errors",
    1,
    {
        "scan_id": "int32",
        "t_ns": "int64",
        **dict.fromkeys(
            (
                f"{aligned}{stage}_error_{unit}"
                for aligned in ("", "aligned_")
                for stage in ("prior", "refined")
                for unit in ("m", "deg")
            ),
            "float64",
        ),
    },
    ("scan_id",),
)
PLAN_EVALUATION = Schema(
    "plan_evaluation",
    5,
    {
        "frame": "string",
        "n_scans": "int32",
        "length_m": "float64",
        **_AGREEMENT,
        **dict.fromkeys(
            (
                "seen_completeness_010m",
                "observed_correctness_010m",
                "observed_visible_completeness_010m",
                "missed_not_seen",
                "missed_misplaced",
                "missed_misextracted",
            ),
            "float64",
        ),
        "n_plan_walls": "int32",
        "plan_walls_per_true_wall": "float64",
        "n_thickness": "int32",
        **dict.fromkeys(("thickness_error_m", "worst_thickness_error_m"), "float64"),
        **dict.fromkeys(("n_doors_true", "n_doors_found", "n_doors_drawn"), "int32"),
        **dict.fromkeys(
            ("door_recall", "door_precision", "door_width_error_m", "door_width_right"), "float64"
        ),
        **dict.fromkeys(("n_windows_true", "n_windows_found", "n_windows_drawn"), "int32"),
        **dict.fromkeys(
            ("window_recall", "window_precision", "window_width_error_m", "window_width_right"),
            "float64",
        ),
        **dict.fromkeys(("n_rooms_true", "n_rooms_found", "n_rooms_false"), "int32"),
        **dict.fromkeys(("room_iou", "least_room_iou"), "float64"),
    },
    ("frame",),
)
"""How good a plan is, in the frame of the map and after alignment by the true poses.

`frame` names which: the alignment is the rigid motion that fits the scans' poses to the true ones.
The agreement and what begins with `n_walls` is of its faces; `plan_walls` are its paired and single
walls.
"""
OVERVIEW = Schema(
    "overview",
    1,
    {
        **dict.fromkeys(("name", "state", "why"), "string"),
        **dict.fromkeys(("area_m2", "rooms", "open_rooms", "walls", "verify"), "float64"),
        **dict.fromkeys(("doors", "windows", "passages"), "float64"),
        **dict.fromkeys(("chosen", "registered", "candidates"), "float64"),
        **dict.fromkeys(("predicted", "seconds"), "float64"),
    },
    ("name",),
    outlives=True,
)
"""What became of each of many datasets; NaN where unknown.

`state` is one of `report/overview.py`, `why` what its stages ended with; `verify` counts elements
to verify on site, as the report lists them; `chosen`, `registered` and `candidates` are scans,
`predicted` is the share of rays of left-out scans, and `seconds` are of all stages.
"""
