"""Write the registered points as a LAZ file, and a picture of them from above."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.exports.data import point_cloud
from scanplan.exports.data.cloud_picture import CloudPicture
from scanplan.exports.model_origin import find_site
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import GeoReference
from scanplan.plan.survey_scale import find_factor
from scanplan.recordings.clocks import end_of_survey_ns
from scanplan.recordings.survey import Reading, open_colours
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, registered_scans, schemas, tables
from scanplan.types import Array, FilePath, FloatArray, Settings

_MARGIN_M = 1.0  # around the floor that was seen: walls, and what is against them


def export_cloud(
    inputs: Mapping[str, Any],
    outputs: Mapping[str, FilePath],
    *,
    settings: Settings,
    reading: Mapping[str, Any] | None = None,
    **stop: Any,
) -> None:
    """Write the points of all scans, or of those that make the plan.

    Parameters
    ----------
    inputs : dict
        `scans`, `registration`, `selection` and `free`, path-like: scans.parquet,
        registration.parquet, selection/<method>.parquet and plan/free.parquet, which states how
        reference points place the map; `recordings`, list of str: the dataset's files, of which the
        points' colours are read, if it has any.
    outputs : dict of str to path-like
        `cloud` and `picture`: cloud.laz and cloud.png, to write.
    settings : dict
        `scans`, `chosen` or `all`, and `cell_m`, see `point_cloud.write_laz`; `site`, see
        `model_origin.Site`.
    reading : dict, optional
        Keywords of `survey.open_survey`.
    **stop
        How many scans are chosen, see `stopping.choose_n_scans`.
    """
    free = inputs["free"]
    store = tables.ScanStore(inputs["scans"])
    wanted = store.scan_ids
    if settings["scans"] == "chosen":
        wanted = np.sort(stopping.read_chosen_scans(inputs["selection"], **stop)[0])
    registered = registered_scans.read_registered_scans(inputs["registration"])
    note = tables.read_note(free, schemas.FREE, "georeference")
    site = find_site(GeoReference(**json.loads(note)) if note else None, settings["site"])
    picture = _begin_picture(free)
    with (
        atomic.replace_file(outputs["cloud"]) as temporary,
        open_colours(inputs["recordings"], Reading(**(reading or {}))) as read_colours,
    ):
        clouds = log.report_progress(store.scans(wanted), "export_cloud", total=len(wanted))
        n_points, n_kept = point_cloud.write_laz(
            temporary,
            _draw(_colour(clouds, read_colours), picture, _read_factor(free)),
            settings["cell_m"],
            end_of_survey_ns(registered.t_ns),
            site,
            coloured=read_colours is not None,
        )
    atomic.write_bytes(outputs["picture"], picture.format_png())
    coloured = "" if read_colours is None else " in their colours"
    log.log_line(f"export_cloud: {len(wanted)} scans, {n_kept:,} of {n_points:,} points{coloured}")


def _begin_picture(free: FilePath) -> CloudPicture:
    """Return an empty picture of the ground around the floor that was seen."""
    floor = shapely.from_wkb(tables.read_table(free, schemas.FREE)["geometry"])
    low_high_m = shapely.total_bounds(floor) + np.array([-1, -1, 1, 1]) * _MARGIN_M
    levels = [
        float(tables.read_note(free, schemas.FREE, name) or "nan")
        for name in ("floor_z_m", "ceiling_z_m")
    ]
    return CloudPicture(low_high_m, *levels)


def _colour(
    scans: Iterable[tuple[int, FloatArray]], read_colours: Callable[[int], Array | None] | None
) -> Iterator[point_cloud.ScanPoints]:
    """Yield scans with the colours of their points."""
    for scan_id, xyz_m in scans:
        rgb = None if read_colours is None else read_colours(scan_id)
        if rgb is not None and len(rgb) != len(xyz_m):
            raise StageError(
                f"scan {scan_id}: {len(xyz_m)} points were registered, and the recording has now"
                f" {len(rgb)}; {tables.RERUN_ALL}"
            )
        yield scan_id, xyz_m, rgb


def _read_factor(free: FilePath) -> float:
    """Return by what lengths of the map are corrected."""
    return find_factor(floorplan_files.read_scale(tables.read_notes(free, schemas.FREE)))


def _draw(
    scans: Iterable[point_cloud.ScanPoints], picture: CloudPicture, factor: float
) -> Iterator[point_cloud.ScanPoints]:
    for scan_id, xyz_m, rgb in scans:
        picture.add(xyz_m, rgb)
        yield scan_id, factor * xyz_m, rgb


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_cloud(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            settings=snakemake.params.settings,
            reading=snakemake.params.reading,
            **snakemake.params.stop,
        )
