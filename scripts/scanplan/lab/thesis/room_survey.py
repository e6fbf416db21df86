"""What the thesis's figures of the synthetic survey are drawn from."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from scanplan.lab.evaluation import truth_file
from scanplan.lab.thesis import coverage_figures, plan_figures, seen_area
from scanplan.lab.thesis.claim_measures import MANY, OURS, SUBSET
from scanplan.selection import hulls
from scanplan.store import registered_scans, schemas, tables


@dataclass(frozen=True)
class RoomSurvey:
    """One survey with its truth.

    Attributes
    ----------
    store : tables.ScanStore
    scan_ids : (n,) int
        Of the registered scans.
    places_m : (n, 2) float64
        Where each was truly taken.
    faces : truth_file.TrueFaces
    hulls, walls, clusters : dict
        Columns of hulls.parquet, walls/cluster_ransac.parquet and thesis/clusters.parquet.
    selections : dict of str to dict
        Method to the columns of its ordering.
    evaluated : list of dict
        evaluation/walls.parquet of every seed.
    max_range_m : float
    """

    store: tables.ScanStore
    scan_ids: np.ndarray
    places_m: np.ndarray
    faces: truth_file.TrueFaces
    hulls: dict
    walls: dict
    clusters: dict
    selections: dict
    evaluated: list
    max_range_m: float


def read_room_survey(files, evaluated, *, max_range_m):
    """Read a survey from its files, by stem (`scans`, `registration`, `hulls`, the methods, ...)."""
    scans, faces = (
        registered_scans.read_registered_scans(files["registration"]),
        truth_file.read_true_faces(files["truth"]),
    )
    poses = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(files["true_poses"]), scans.t_ns, files["true_poses"]
    )
    return RoomSurvey(
        store=tables.ScanStore(files["scans"]),
        scan_ids=scans.scan_ids,
        places_m=poses[:, :2, 3],
        faces=faces,
        hulls=tables.read_table(files["hulls"], schemas.HULLS),
        walls=tables.read_table(files[OURS], schemas.WALLS, allow_empty=True),
        clusters=tables.read_table(files["clusters"], schemas.CLUSTERS),
        selections={
            m: tables.read_table(files[m], schemas.SELECTION)
            for m in ("hull", "cluster_hull", "sequential")
        },
        evaluated=[tables.read_table(path, schemas.EVALUATION) for path in evaluated],
        max_range_m=max_range_m,
    )


def draw_room_figure(survey, path, bitmap_cell_m):
    """Draw the figure that a file is called after."""
    figures = {
        "figure_3_2": lambda: _hulls(survey),
        "figure_5_1": lambda: plan_figures.draw_overlay_figure(
            first_walls(survey, "cluster_hull", MANY)[0], survey.faces.inner_m, bitmap_cell_m
        ),
        "figure_5_2": lambda: plan_figures.draw_survey_figure(
            survey.faces.inner_m, survey.places_m
        ),
        "figure_5_3": lambda: _walls(survey, {"cluster_hull": "order by cluster hulls"}, MANY),
        "figure_5_4": lambda: coverage_figures.draw_shares_figure(survey.evaluated, OURS),
        "figure_5_5": lambda: _walls(
            survey, {"sequential": "as recorded", "cluster_hull": "order by cluster hulls"}, SUBSET
        ),
        "figure_5_6": lambda: coverage_figures.draw_convergence_figure(
            {method: survey.selections[method] for method in ("hull", "cluster_hull")}
        ),
        "figure_5_7": lambda: coverage_figures.draw_clusters_figure(survey.clusters),
    }
    return figures[Path(path).stem]()


def first_walls(survey, method, k):
    """Return the walls (m, 2, 2) of the first k scans of an order, and where those truly were taken, (k, 2)."""
    chosen = survey.selections[method]["scan_id"][:k]
    ends = np.column_stack([survey.walls[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
        -1, 2, 2
    )
    return ends[np.isin(survey.walls["scan_id"], chosen)], survey.places_m[
        np.searchsorted(survey.scan_ids, chosen)
    ]


def _walls(survey, methods, k):
    return plan_figures.draw_wall_panels(
        survey.faces.inner_m,
        {title: first_walls(survey, method, k) for method, title in methods.items()},
    )


def _hulls(survey):
    """Draw the scan whose full hull exceeds what it sees by the median of all scans."""
    _, full = hulls.scan_full_hulls(survey.hulls)
    seen = seen_area.seen_polygons(survey.faces, survey.places_m, max_range_m=survey.max_range_m)
    ratio = shapely.area(full) / shapely.area(seen)
    row = int(np.argsort(ratio, kind="stable")[len(ratio) // 2])
    scan_id = survey.scan_ids[row]
    shapes = shapely.from_wkb(survey.hulls["geometry"][survey.hulls["scan_id"] == scan_id])
    clusters = shapes[shapely.get_dimensions(shapes) == 2]
    return coverage_figures.draw_hulls_figure(
        survey.store.read(scan_id)[:, :2], survey.places_m[row], full[row], clusters, seen[row]
    )
