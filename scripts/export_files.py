"""Write the plan, and the way of the sensor, as files for other programs, with ids that stay."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import shapely

import scanplan
from scanplan.exports import grid_map
from scanplan.exports.data import (
    doubt_topics,
    element_ids,
    element_tables,
    geopackage,
    mesh,
    nominal_widths,
    room_graph,
    wayfinding,
)
from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.grid_map import GridMap
from scanplan.exports.model_origin import ModelOrigin, find_site
from scanplan.exports.sheet.locale import make_locale
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.plan.survey_scale import find_factor
from scanplan.project.catalogue_file import read_catalogue, translate_names
from scanplan.project.words_file import tag_language
from scanplan.recordings.clocks import end_of_survey_ns
from scanplan.stage import log
from scanplan.store import atomic, registered_scans, schemas, sqlite_paths, tables, tum
from scanplan.store.pose_columns import pose_matrices
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import Columns, FilePath, Settings


def export_files(
    plan: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    source: str,
    settings: Settings,
    catalogue: Mapping[str, Any] | None = None,
    words: Mapping[str, Any] | None = None,
    version: str = "",
    unwanted: Iterable[FilePath] = (),
) -> None:
    """Write the ids of the plan's elements, and the files that are asked for.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free` and `furniture` of plan/; `registration` and
        `poses`.
    outputs : dict of str to path-like
        `ids` and `known`, to write: the GlobalIds of the plan's elements, and all elements that
        plans of the dataset ever had. The latter is read, too, where there is one of the same
        source: what lies where something did before keeps its id. Of `export_formats.FILES` what
        is to be written.
    source : str
        What the dataset's results are made of, see `provenance.identify_source`.
    settings : dict
        See `stage_settings.select_files`.
    catalogue : dict, optional
        See `catalogue_file.read_catalogue`; ours if not given.
    words : dict, optional
        Of the receiver's language, see `words_file.read_words`; English if not given.
    version : str
        Of the code.
    unwanted : iterable of path-like
        Files of formats that were asked for before: they are removed, being of an older plan.
    """
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    in_map = floorplan_files.read_floorplan(plan, name, **assumed_m)
    locale = make_locale(settings["units"], words)
    drawn = replace(scale_floorplan(in_map), room_word=locale.say("Room"))
    registered = registered_scans.read_registered_scans(plan["registration"])
    t_ns = end_of_survey_ns(registered.t_ns)
    ids = _identify_elements(in_map, outputs["ids"], outputs["known"], source)
    site = find_site(drawn.georeference, settings["site"])
    origin = ModelOrigin(
        author=settings["author"] or "",
        organisation=settings["organisation"] or "",
        project=settings["project"] or "",
        storey=settings["storey"] or "",
        version=version or "not stated",
        t_ns=t_ns,
        site=site,
        locale=locale,
    )
    sizes = translate_names(catalogue or read_catalogue(None), locale.say)

    @cache
    def draft() -> FloorPlan:
        return _draft_regular(drawn, settings["max_change_m"], sizes)

    @cache
    def tabulate() -> dict[str, element_tables.Rows]:
        nominal_m = nominal_widths.find_nominal_widths(draft(), sizes)
        return element_tables.tabulate_elements(drawn, ids, nominal_m)

    def models() -> dict[str, str]:
        # to go on with first: what is left out of that is in the other
        wanted = [what for what in ("editable", "ifc") if what in outputs]
        return {Path(outputs[what]).name: str(writers[what]()) for what in wanted}

    writers: dict[str, Callable[[], str | bytes]] = {
        "ifc": cache(lambda: _format_ifc(drawn, ids, origin)),
        "editable": cache(lambda: _format_editable(drawn, draft(), ids, origin, sizes)),
        "bcf": lambda: doubt_topics.format_bcf(drawn, ids, origin, models()),
        "openplan": lambda: _format_openplan(drawn, ids, origin),
        "glb": lambda: mesh.format_glb(drawn, ids, site, locale),
        "trajectory": lambda: tum.format_tum(registered.t_ns, registered.map_from_sensor),
        "localiser": lambda: _format_localiser(plan["poses"]),
    }
    for mask, draw, mode in (
        ("keepout", grid_map.draw_keepout, "trinary"),
        ("speed", grid_map.draw_speed, "raw"),
    ):
        writers |= _write_mask(mask, lambda draw=draw: draw(in_map, settings["map_cell_m"]), mode)
    for table in ("walls", "openings", "rooms"):
        writers[f"{table}_csv"] = lambda table=table: element_tables.format_csv(tabulate()[table])
    language = tag_language(settings["language"])
    writers["imdf"] = lambda: wayfinding.format_imdf(
        drawn, tabulate(), site, origin.storey, language
    )
    writers["json"] = lambda: room_graph.format_room_graph(drawn, tabulate())
    for what in [what for what in outputs if what in writers]:
        content = writers[what]()
        binary = content.encode() if isinstance(content, str) else content
        atomic.write_bytes(outputs[what], binary)
    for file in unwanted:
        Path(file).unlink(missing_ok=True)
    if "gpkg" in outputs:
        factor = find_factor(drawn.scale)
        layers = geopackage.plan_layers(drawn, tabulate()) | _way_layers(registered, factor)
        layers |= wayfinding.imdf_layers(drawn, tabulate(), origin.storey)
        remedy = "leave gpkg out of plan.export.formats"
        with atomic.replace_file(outputs["gpkg"]) as temporary:
            sqlite_paths.check_sqlite_path(temporary, remedy)
            geopackage.write_geopackage(temporary, layers, t_ns, site)


def _format_ifc(plan: FloorPlan, ids: ElementIds, origin: ModelOrigin) -> str:
    # its library is 200 MB, and not installed by all who want the other files
    from scanplan.exports import ifc

    return ifc.format_ifc(plan, ids, origin)


def _format_openplan(plan: FloorPlan, ids: ElementIds, origin: ModelOrigin) -> str:
    # scipy besides, as of the regular plan
    from scanplan.exports.data import openplan

    return openplan.format_openplan(plan, ids, origin)


def _write_mask(
    name: str, draw: Callable[[], GridMap], mode: str
) -> dict[str, Callable[[], str | bytes]]:
    """Return what writes a mask of the map, and the file that nav2 reads it by."""
    drawn = cache(draw)
    return {
        f"{name}_pgm": lambda: grid_map.format_pgm(drawn()),
        f"{name}_yaml": lambda: grid_map.format_map_yaml(drawn(), f"{name}.pgm", mode),
    }


def _draft_regular(plan: FloorPlan, max_change_m: float, catalogue: Mapping[str, Any]) -> FloorPlan:
    # scipy, which takes a second to import
    from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings

    return draft_plan(plan, make_draft_settings(max_change_m, catalogue))[0]


def _format_editable(
    plan: FloorPlan,
    regular: FloorPlan,
    ids: ElementIds,
    origin: ModelOrigin,
    catalogue: Mapping[str, Any],
) -> str:
    """Return the regular plan as a building model, whose elements have the ids of the measured."""
    from scanplan.exports import ifc

    own_ids = element_ids.take_ids(ids, plan, regular)
    return ifc.format_ifc(regular, own_ids, origin, catalogue=catalogue)


def _identify_elements(
    plan: FloorPlan, output: FilePath, known: FilePath, source: str
) -> ElementIds:
    """Write the GlobalIds of walls, openings and rooms, note those that are new, return them."""
    elements = element_ids.list_elements(plan)
    before = _read_known(known, source)
    ids = element_ids.identify_elements(elements, before, plan.name)
    after = element_ids.merge_known(elements, ids, before)
    columns = element_ids.tabulate_ids(plan, ids)
    notes = {"source": source}
    tables.write_table(known, schemas.KNOWN_ELEMENTS, after, notes=notes, allow_empty=True)
    tables.write_table(output, schemas.ELEMENT_IDS, columns, allow_empty=True)
    n_new = len(after["kind"]) - len(before["kind"])
    log.log_line(
        f"export_files: {len(ids)} elements, {len(ids) - n_new} of them known before, {n_new} new"
    )
    return element_ids.ids_of_table(columns)


def _read_known(path: FilePath, source: str) -> Columns:
    schema = schemas.KNOWN_ELEMENTS
    if not Path(path).exists() or tables.read_note(path, schema, "source") != source:
        return element_ids.no_known()
    return tables.read_table(path, schema, allow_empty=True)


def _format_localiser(path: FilePath) -> str:
    """Return the localiser's poses of all candidate scans that have one."""
    poses = tables.read_table(path, schemas.POSES)
    known = {column: values[poses["covered"]] for column, values in poses.items()}
    return tum.format_tum(known["t_ns"], pose_matrices(known))


def _way_layers(registered: RegisteredScans, factor: float) -> dict[str, geopackage.Layer]:
    """Return the sensor's way, and where it took the registered scans, as layers.

    Places of the map are multiplied by the factor of the plan's lengths.
    """
    places_m = factor * registered.map_from_sensor[:, :2, 3]
    # one scan alone is a way of no length
    way_m = places_m if len(places_m) > 1 else np.repeat(places_m, 2, axis=0)
    track = np.array([shapely.LineString(way_m)], object)
    scans: element_tables.Rows = {
        "scan_id": registered.scan_ids.tolist(),
        "t_ns": registered.t_ns.tolist(),
    }
    return {
        "trajectory": geopackage.Layer("LINESTRING", track, {"n_scans": [len(places_m)]}),
        "scans": geopackage.Layer("POINT", np.asarray(shapely.points(places_m), object), scans),
    }


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_files(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            source=snakemake.params.source,
            settings=snakemake.params.settings,
            catalogue=snakemake.params.catalogue,
            words=snakemake.params.words,
            version=f"{scanplan.__version__}, code {snakemake.params.code}",
            unwanted=snakemake.params.unwanted,
        )
