"""The tables of a survey of the hand-made plan: five candidates, four kept, three chosen."""

from pathlib import Path

import numpy as np
import shapely

from helpers import floorplan_making
from helpers.wall_making import walls as wall_table
from scanplan.plan import floorplan
from scanplan.report.facts import PredictionFacts, VisitFacts
from scanplan.store import schemas, tables
from write_report import write_report

PAGE = Path(__file__).resolve().parents[2] / "workflow/report/page"
PAGE_FILES = (
    *("page.html.j2", "tables.html.j2", "page.css", "edit.css"),
    *("page.js", "edits.js", "shapes.js", "areas.js", "drawn_edits.js"),
    *("tools.js", "returns.js", "choices.js", "faults.js"),
    *("elements.js", "saying.js", "solid_edits.js", "solid.js", "three.js"),
    *("seen.js", "walk.js", "save.js"),
)
SETTINGS = {
    "selection": {"stop": {"n_scans": 3, "area_share": None}},
    "plan": {
        "method": "wall_length",
        "extractor": "cluster_ransac",
        "merge": {"merge_distance_m": 0.1, "min_scans": 2},
        "export": {"assumed_thickness_m": 0.1, "assumed_height_m": 2.5},
    },
}
SCAN_IDS = [0, 5, 9, 12, 20]
PLACES_M = [(1.0, 1.0), (2.0, 1.5), (4.05, 1.4), (6.0, 1.0), (6.5, 2.0)]
START_NS = 1_700_000_000_000_000_000
# what each scan shows of the faces of the plan
SEEN = [(9, 0), (9, 1), (9, 5), (5, 0), (5, 3), (5, 4), (12, 0), (12, 1), (0, 4)]
# on the faces in the south and the west, and on the floor
SCANNED_M = np.array([(1.0, 0.0, 1.2), (2.0, 0.0, 1.2), (0.0, 2.0, 1.2), (2.0, 2.0, 0.0)])
BENCHMARK = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n{}\n"


def _poses():
    n = len(SCAN_IDS)
    pose = dict(zip(("x_m", "y_m"), np.array(PLACES_M).T.copy(), strict=True))
    turn = {c: np.full(n, float(c == "qw")) for c in ("qx", "qy", "qz", "qw")}
    stamps = {
        "scan_id": np.array(SCAN_IDS, np.int32),
        "t_ns": START_NS + np.array(SCAN_IDS) * 10**8,
    }
    return stamps, pose | {"z_m": np.full(n, 0.4)} | turn


def poses():
    stamps, pose = _poses()
    return stamps | pose | {"gap_s": np.full(5, 0.1), "covered": np.ones(5, bool)}


def registration():
    stamps, pose = _poses()
    pose["x_m"] = pose["x_m"] + 0.03
    unknown = dict.fromkeys(schemas.COVARIANCE, np.full(5, np.nan))
    return stamps | pose | unknown | {
        "prior_fitness": np.array([np.nan, 0.8, 0.7, 0.9, 0.2]),
        "refined_fitness": np.array([np.nan, 0.9, 0.8, 0.95, np.nan]),
        "rmse_m": np.array([np.nan, 0.05, 0.06, 0.04, np.nan]),
        "kept": np.array([True, True, True, True, False]),
        "reason": np.array(["anchor", "kept", "kept", "kept", "low_prior_fitness"], object),
    }  # fmt: skip


def selection():
    covered_m2 = np.array([15.0, 20.0, 21.0, 21.0])
    return {
        "rank": np.arange(1, 5, dtype=np.int32),
        "scan_id": np.array([9, 5, 12, 0], np.int32),
        "n_points": np.full(4, 1000),
        "gain_m2": np.diff(covered_m2, prepend=0.0),
        "covered_m2": covered_m2,
        "bound_m2": np.array([15.0, 20.5, 21.0, 21.0]),
        # walls that the scans show
        "gain": np.array([12.0, 6.0, 1.0, 1.0]),
        "covered": np.array([12.0, 18.0, 19.0, 20.0]),
        "bound": np.array([12.0, 18.5, 19.5, 20.0]),
    }


def segments():
    rows = sorted(SEEN)
    lines = [floorplan_making.FACES[face][:4] for _, face in rows]
    table = wall_table(lines, scan_id=[scan for scan, _ in rows])
    table["wall"] = np.array(
        [sum(s == scan for s, _ in rows[:i]) for i, (scan, _) in enumerate(rows)], np.int32
    )
    return table


def evaluation(methods=("random", "wall_length")):
    k = [1, 2, 3, 4]
    columns = {}
    for name, kind in schemas.EVALUATION.columns.items():
        columns[name] = (
            np.tile(np.linspace(0.2, 0.9, 4), len(methods)) if kind == "float64" else None
        )
    columns["method"] = np.repeat(np.array(methods, object), 4)
    columns["extractor"] = np.array(["cluster_ransac"] * 4 * len(methods), object)
    columns["k"] = np.tile(np.array(k, np.int32), len(methods))
    columns["n_walls"] = columns["k"] * 3
    return columns


PREDICTION = PredictionFacts(
    n_scans=1,
    n_rays=1000,
    share=0.9,
    bounds=(0.85, 0.93),
    length_share=0.95,
    n_stopped=70,
    n_passed=20,
    n_beyond=10,
)


def validation():
    """The rows of the whole plan, in numbers that `PREDICTION` states."""
    counts = {"n_rays": 1000, "n_explained": 900, "n_stopped": 70, "n_passed": 20, "n_beyond": 10}
    known = {"kind": "plan_rays", "number": 0, "span": 0, **counts, "n_places": 1}
    shares = {"share": 0.9, "share_low": 0.85, "share_high": 0.93}
    values = dict.fromkeys(("x0_m", "y0_m", "x1_m", "y1_m"), np.nan) | known | shares
    by_length = {"kind": "plan_length", "share": 0.95}
    return {name: np.array([by_length.get(name, v), v]) for name, v in values.items()}


def confidence():
    """All elements are sure, but for the walls that have no point."""
    parts = []
    for table, number in floorplan.NUMBERS.items():
        made = getattr(floorplan_making, table)()
        n = len(made[number])
        verify = made["verify"] if table == "walls" else np.zeros(n, bool)
        parts.append(
            {
                "table": np.full(n, table, object),
                "number": made[number],
                "p_true": np.where(verify, 0.5, 0.99),
                "verify": verify,
                "about": np.where(verify, "existence", "").astype(object),
                "doubt": np.where(verify, "few points", "").astype(object),
                "needs_person": np.zeros(n, bool),
            }
        )
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    order = np.lexsort((joined["number"], joined["table"].astype(str)))
    return {name: values[order] for name, values in joined.items()}


def questions():
    """A wall that the only standpoint shows, and one that cannot be seen."""
    lines = [shapely.MultiLineString([[(4.05, 3.1), (7.1, 3.1)]])] * 2
    return {
        "kind": np.array(["wall", "wall"], object),
        "number": np.array([1, 2], np.int32),
        "doubt": np.array(["short", "few points"], object),
        "needs_person": np.array([True, False]),
        "x_m": np.full(2, 5.6),
        "y_m": np.full(2, 3.1),
        "seeable": np.array([1.0, 0.0]),
        "seen": np.array([1.0, 0.0]),
        "standpoint": np.array([1, -1], np.int32),
        "geometry": shapely.to_wkb(np.array(lines, object)),
    }


def standpoints():
    return {
        "standpoint": np.array([1], np.int32),
        "x_m": np.array([5.5]),
        "y_m": np.array([1.25]),
        "heading_deg": np.array([np.nan]),
        "way_m": np.array([4.5]),
        "n_questions": np.array([1], np.int32),
        "geometry": shapely.to_wkb(np.array([shapely.LineString([(1, 1.25), (5.5, 1.25)])])),
    }


VISIT = VisitFacts(questions(), standpoints(), "1 of 2 can be seen")


def plan_evaluation():
    columns = {
        name: np.array([3, 3], np.int32) if kind == "int32" else np.array([0.97, 0.98])
        for name, kind in schemas.PLAN_EVALUATION.columns.items()
    }
    return columns | {"frame": np.array(["aligned", "registered"], object)}


def files(folder):
    """Write everything that the report is made of into a folder; return its inputs."""
    made = {
        "faces": (schemas.FACES, floorplan_making.faces()),
        "walls": (schemas.PLAN_WALLS, floorplan_making.walls()),
        "openings": (schemas.OPENINGS, floorplan_making.openings()),
        "rooms": (schemas.ROOMS, floorplan_making.rooms()),
        "free": (schemas.FREE, floorplan_making.free()),
        "furniture": (schemas.FURNITURE, floorplan_making.furniture()),
        "evidence": (schemas.EVIDENCE, floorplan_making.evidence()),
        "selection": (schemas.SELECTION, selection()),
        "segments": (schemas.WALLS, segments()),
        "poses": (schemas.POSES, poses()),
        "registration": (schemas.REGISTRATION, registration()),
        "evaluation/walls": (schemas.EVALUATION, evaluation()),
        "evaluation/plan": (schemas.PLAN_EVALUATION, plan_evaluation()),
    }
    paths = {name: folder / f"{name}.parquet" for name in made}
    notes = {"poses": {schemas.N_RECORDED: "23"}}
    for name, (schema, columns) in made.items():
        tables.write_table(paths[name], schema, columns, notes=notes.get(name))
    paths["scans"] = folder / "scans.parquet"
    with tables.open_scan_writer(paths["scans"], planar=False) as write:
        for scan_id in SCAN_IDS[:4]:
            write(scan_id, SCANNED_M)
    paths["validation"] = folder / "validation.parquet"
    notes = {"n_scans": "1", "absent": ""}
    tables.write_table(paths["validation"], schemas.VALIDATION, validation(), notes=notes)
    paths["confidence"] = folder / "confidence.parquet"
    tables.write_table(paths["confidence"], schemas.CONFIDENCE, confidence())
    paths["questions"] = folder / "questions.parquet"
    notes = {"summary": VISIT.summary}
    tables.write_table(paths["questions"], schemas.QUESTIONS, questions(), notes=notes)
    paths["standpoints"] = folder / "standpoints.parquet"
    tables.write_table(paths["standpoints"], schemas.STANDPOINTS, standpoints())
    (folder / "scans.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path d="M0 0"/></svg>'
    )
    (folder / "survey.bag").write_bytes(bytes(2_500_000))
    for name in ("plan.svg", "plan.dxf"):
        (folder / name).write_text("drawn")
    (folder / "benchmarks").mkdir(exist_ok=True)
    (folder / "benchmarks/build_hulls.tsv").write_text(
        BENCHMARK.format("2.5\t0:00:02\t443.8\t1\t1\t1\t0\t0\t80\t3.4")
    )
    (folder / "benchmarks/draw_area.tsv").write_text(
        BENCHMARK.format("0.1\t0:00:00\t-\t-\t-\t-\t-\t-\t-\t-")
    )
    return paths | {
        "page": [PAGE / name for name in PAGE_FILES],
        "figures": [folder / "scans.svg"],
        "evaluation": [paths["evaluation/walls"], paths["evaluation/plan"]],
        "corrections": [],
        "recordings": [folder / "survey.bag"],
        "results": [paths["faces"], paths["walls"], folder / "plan.svg", folder / "plan.dxf"],
    }


def written(folder, files, name="office <two> rooms", output="report.html", storeys=()):
    """The report of such files."""
    write_report(
        files,
        folder / output,
        name=name,
        settings=SETTINGS,
        run_times=sorted((folder / "benchmarks").glob("*.tsv")),
        short=folder / "summary.txt",
        storeys=storeys,
    )
    return folder / output
