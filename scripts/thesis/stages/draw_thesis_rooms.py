"""Draw the thesis's figures 3.1 to 5.7, and all orders, from the survey of the rooms."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from scanplan.extraction import extractors
from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.lab.evaluation import truth_file
from scanplan.stage import figure_files, log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import FilePath, Settings
from thesis import thesis_schemas
from thesis.claim_measures import OURS
from thesis.comparison import oracle_figure
from thesis.figures import room_figures

_METHODS = ("hull", "cluster_hull", "sequential")


def draw_thesis_rooms(
    files: Mapping[str, FilePath],
    evaluated: Sequence[FilePath],
    outputs: Mapping[str, Any],
    *,
    bitmap_cell_m: float,
    max_range_m: float,
    extraction: Settings,
) -> None:
    """Write the figures as SVG.

    Parameters
    ----------
    files : dict of str to path-like
        Tables of one survey by their stems (`scans`, `registration`, `hulls`, `clusters`, the
        methods, the extractor), and `truth` and `true_poses`.
    evaluated : list of path-like
        evaluation/walls.parquet of every seed.
    outputs : dict
        `figures`, list of path-like, and `orders`, path-like, to write: figure_<number>.svg, and
        orders.svg, how near every order comes to the oracle's.
    bitmap_cell_m : float
        Of figure 5.1.
    max_range_m : float
        How far a scan can see.
    extraction : dict
        The settings of cluster RANSAC.
    """
    scans = registered_scans.read_registered_scans(files["registration"])
    poses = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(files["true_poses"]), scans.t_ns, files["true_poses"]
    )
    survey = room_figures.RoomSurvey(
        store=tables.ScanStore(files["scans"]),
        scan_ids=scans.scan_ids,
        places_m=poses[:, :2, 3],
        sensor_xyz_m=scans.map_from_sensor[:, :3, 3],
        extraction=extractors.select_settings(ClusterRansacSettings, extraction),
        faces=truth_file.read_true_faces(files["truth"]),
        hulls=tables.read_table(files["hulls"], schemas.HULLS),
        walls=tables.read_table(files[OURS], schemas.WALLS, allow_empty=True),
        clusters=pd.DataFrame(tables.read_table(files["clusters"], thesis_schemas.CLUSTERS)),
        selections={
            m: pd.DataFrame(tables.read_table(files[m], schemas.SELECTION)) for m in _METHODS
        },
        evaluated=[pd.DataFrame(tables.read_table(path, schemas.EVALUATION)) for path in evaluated],
        max_range_m=max_range_m,
    )
    for path in outputs["figures"]:
        figure = room_figures.draw_room_figure(survey, Path(path).stem, bitmap_cell_m)
        atomic.write_text(path, figure_files.format_svg(figure))
    orders_figure = oracle_figure.draw_oracle_figure(*survey.evaluated)
    atomic.write_text(outputs["orders"], figure_files.format_svg(orders_figure))
    log.log_line(f"draw_thesis_rooms: {len(outputs['figures'])} figures")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_thesis_rooms(
            {name: path for name, path in snakemake.input.items() if name != "evaluated"},
            list(snakemake.input.evaluated),
            dict(snakemake.output.items()),
            bitmap_cell_m=snakemake.params.bitmap_cell_m,
            max_range_m=snakemake.params.max_range_m,
            extraction=snakemake.params.extraction,
        )
