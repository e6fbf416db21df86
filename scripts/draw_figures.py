"""Draw the figures of a plan: its registration, scans, walls and validation.

One stage, as what they share costs more than they do: a start of Python with Matplotlib takes
longer than a figure, and two of them show the same points.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from scanplan.report import (
    deviation_figure,
    figures,
    registration_figure,
    top_view,
    validation_figure,
)
from scanplan.selection import stopping
from scanplan.stage import figure_files, log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import Columns, FilePath, FloatArray, IntArray

_LINKS = ["source", "target", "kind", "residual_m"]


def draw_figures(
    made: Mapping[str, FilePath], outputs: Mapping[str, FilePath], **stop: Any
) -> None:
    """Write the figures as SVG.

    Parameters
    ----------
    made : dict of str to path-like
        `scans`, `registration`, `edges` and `crispness` of the registration; `selection`, the
        plan's ordering; `faces`, `free`, `elements` and `rays` of plan/, the latter two of its
        validation.
        `crispness`, or these two, are empty lists where their stage failed.
    outputs : dict of str to path-like
        To write: `registration`, the audit of the registration; `scans`, where they were taken and
        which are selected (thesis, figure 5.9); `walls`, the plan's faces over the points of the
        selected scans (thesis, figure 5.11); `validation`, where rays of other scans ended;
        `deviation`, how far points lie from the faces.
    **stop
        How many scans are selected, see `stopping.choose_n_scans`.
    """
    poses = tables.read_table(made["registration"], schemas.REGISTRATION)
    chosen_ids, reason = stopping.read_chosen_scans(made["selection"], **stop)
    for name, figure in _draw_figures(made, poses, chosen_ids):
        atomic.write_text(outputs[name], figure_files.format_svg(figure))
    log.log_line(f"draw_figures: {reason}")


def _draw_figures(
    made: Mapping[str, FilePath], poses: Columns, chosen_ids: IntArray
) -> Iterator[tuple[str, Figure]]:
    store = tables.ScanStore(made["scans"])
    shown = top_view.choose_scans(store.scan_ids)
    clouds = log.report_progress(store.scans(shown), "draw_figures", total=len(shown))
    points_xy_m = top_view.sample_points(clouds, len(shown))
    chosen_xy_m = registered_scans.sensor_places(poses, chosen_ids)
    yield "registration", _draw_registration(made, poses, points_xy_m)
    every_xy_m = registered_scans.sensor_places(poses, store.scan_ids)
    yield "scans", figures.draw_scans_figure(points_xy_m, every_xy_m, chosen_xy_m)
    faces = tables.read_table(made["faces"], schemas.FACES)
    selected_xy_m = top_view.sample_points(store.scans(chosen_ids.tolist()), len(chosen_ids))
    yield "walls", figures.draw_walls_figure(selected_xy_m, faces, chosen_xy_m)
    yield "validation", _draw_validation(made)
    yield "deviation", _draw_deviation(made, store, chosen_ids)


def _draw_registration(
    made: Mapping[str, FilePath], poses: Columns, points_xy_m: FloatArray
) -> Figure:
    """Draw the track, every scan's verdict, and how well neighbours fit."""
    links = tables.read_table(made["edges"], schemas.EDGES, _LINKS, allow_empty=True)
    sigma_m: dict[str, float] = {}
    if made["crispness"]:
        thickness = tables.read_table(made["crispness"], schemas.CRISPNESS, ["poses", "sigma_m"])
        sigma_m = dict(zip(thickness["poses"].tolist(), thickness["sigma_m"].tolist(), strict=True))
    return registration_figure.draw_registration_figure(points_xy_m, poses, links, sigma_m)


def _draw_deviation(
    made: Mapping[str, FilePath], store: tables.ScanStore, chosen_ids: IntArray
) -> Figure:
    """Draw how far points of the selected scans, between floor and ceiling, lie from the faces."""
    faces = tables.read_table(made["faces"], schemas.FACES)
    notes = tables.read_notes(made["free"], schemas.FREE)
    low_m, high_m = (float(notes.get(name) or "nan") for name in ("floor_z_m", "ceiling_z_m"))
    scans = (
        (scan_id, deviation_figure.take_upright(xyz_m, low_m, high_m))
        for scan_id, xyz_m in store.scans(chosen_ids.tolist())
    )
    xy_m = top_view.sample_points(scans, len(chosen_ids))
    return deviation_figure.draw_deviation_figure(xy_m, faces)


def _draw_validation(made: Mapping[str, FilePath]) -> Figure:
    """Draw where rays of scans left out of the plan ended, and whether the plan explains it."""
    if not made["elements"]:
        return _draw_unvalidated(made)
    judged = tables.read_table(made["elements"], schemas.VALIDATION)
    notes = tables.read_notes(made["elements"], schemas.VALIDATION)
    rays = tables.read_table(made["rays"], schemas.VALIDATION_RAYS, allow_empty=True)
    n_scans = int(notes["n_scans"])
    n_rays = judged["n_rays"][-1]
    title = f"{judged['share'][-1]:.1%} of {n_rays:,} rays of {n_scans:,} scans are as predicted"
    absent = notes.get("absent", "")
    return validation_figure.draw_validation_figure(judged, rays, absent or title)


def _draw_unvalidated(made: Mapping[str, FilePath]) -> Figure:
    """Draw the faces of the plan, of which nothing is known."""
    faces = tables.read_table(made["faces"], schemas.FACES)
    n_faces = len(faces["face"])
    unknown = {"share": np.full(n_faces, np.nan), "kind": np.full(n_faces, "face")}
    rays = tables.no_rows(schemas.VALIDATION_RAYS)
    title = "not validated: the stage that does it failed"
    return validation_figure.draw_validation_figure(faces | unknown, rays, title)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_figures(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            **snakemake.params.stop,
        )
