"""Results of the plan of two rooms, with all files that may be edited elsewhere and come back."""

import json
from dataclasses import replace

import yaml

from helpers.correcting import write_plan
from scanplan.edited.take import take_edits
from scanplan.exports import dxf, ifc
from scanplan.exports.data import element_ids, openplan
from scanplan.exports.drafting.presentation import compose_presentation
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.model_origin import ModelOrigin
from scanplan.exports.sheet.composition import compose_sheet
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.locale import make_locale
from scanplan.plan import floorplan_files, planning
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.project.catalogue_file import read_catalogue, translate_names
from scanplan.project.words_file import read_words
from scanplan.store import schemas, tables


def make_results(root, language="en"):
    """A folder results/office of the plan, uncorrected, whose recording is in `rec` beside it."""
    results = root / "results/office"
    (results / "plan").mkdir(parents=True)
    (root / "rec").mkdir()
    (results / "source.txt").write_text("rec\n")
    (results / "run.json").write_text(json.dumps({"storeys": [], "settings": {}}))
    data = json.dumps({"made": "abc", "survey": "office 0123", "corrections": []})
    (results / "report.html").write_text(
        f'<script type="application/json" id="data">{data}</script>'
    )
    write_plan(results / "plan")
    export(results, results / "plan", language)
    return results


def read_plan(folder):
    """The plan of the tables in a folder."""
    paths = {name: folder / f"{name}.parquet" for name in planning.TABLES}
    return floorplan_files.read_floorplan(paths, "office")


def export(results, folder, language="en"):
    """Write the files that may be edited, of the tables in a folder."""
    locale = make_locale("m", read_words(language))
    origin, facts = ModelOrigin(locale=locale), SheetFacts(locale=locale)
    plan = replace(scale_floorplan(read_plan(folder)), room_word=locale.say("Room"))
    known = element_ids.no_known()
    kept = results / "plan/known_elements.parquet"
    if kept.exists():
        known = tables.read_table(kept, schemas.KNOWN_ELEMENTS, allow_empty=True)
    elements = element_ids.list_elements(plan)
    found = element_ids.identify_elements(elements, known, "office")
    merged = element_ids.merge_known(elements, found, known)
    tables.write_table(kept, schemas.KNOWN_ELEMENTS, merged, notes={"source": "rec"})
    columns = element_ids.tabulate_ids(plan, found)
    tables.write_table(results / "plan/ids.parquet", schemas.ELEMENT_IDS, columns)
    ids = element_ids.ids_of_table(columns)
    catalogue = translate_names(read_catalogue(None), locale.say)
    regular, drafted = draft_plan(plan, make_draft_settings(0.05, catalogue))
    own_ids = element_ids.take_ids(ids, plan, regular)
    files = {
        "plan.openplan3d.json": openplan.format_openplan(plan, ids, origin),
        "plan.ifc": ifc.format_ifc(plan, ids, origin),
        "presentation.ifc": ifc.format_ifc(regular, own_ids, origin, catalogue=catalogue),
        "plan.dxf": dxf.format_dxf(compose_sheet(plan, facts)),
        "presentation.dxf": dxf.format_dxf(
            compose_presentation(plan, regular, drafted, facts), "m"
        ),
    }
    for name, text in files.items():
        (results / "plan" / name).write_text(text, encoding="utf-8")
    return plan


def taken(results, path, by=""):
    """What the command tells of an edited file."""
    return take_edits(path, results, by)


def edited_json(results, edit, name="plan.openplan3d.json"):
    """The project after an edit of its floor, at another place."""
    project = json.loads((results / "plan" / name).read_text())
    edit(project["floors"][0])
    path = results.parent / "edited.json"
    path.write_text(json.dumps(project))
    return path


def wall_between(floor, x_m=4.05):
    """The wall between both rooms."""
    (wall,) = [w for w in floor["walls"] if abs(w["start"]["x"] - w["end"]["x"]) < 1
               and abs(w["start"]["x"] - 100 * x_m) < 1]  # fmt: skip
    return wall


def move_wall(floor, x_m=4.05):
    """Move it by 0.2 m to the east."""
    wall = wall_between(floor, x_m)
    wall["start"]["x"] += 20
    wall["end"]["x"] += 20


def write_entries(results, *entries):
    """Let there be a file of corrections."""
    place = results.parents[1] / "rec/corrections.yaml"
    place.write_text(yaml.safe_dump({"corrections": list(entries)}))


def entries_of(results):
    """The entries of the file of corrections, without when and by whom."""
    place = results.parents[1] / "rec/corrections.yaml"
    if not place.exists():
        return []
    entries = yaml.safe_load(place.read_text())["corrections"]
    return [{k: v for k, v in entry.items() if k not in ("when", "by")} for entry in entries]


def run_again(results, *, with_files=False):
    """The plan with the corrections carried out, and its files made anew of it if wanted."""
    from correct_plan import correct_plan

    folder = results / "plan"
    plan = {name: folder / f"{name}.parquet" for name in planning.TABLES}
    outputs = {name: folder / f"corrected/{name}.parquet" for name in planning.TABLES}
    correct_plan(results.parents[1] / "rec/corrections.yaml", plan, outputs)
    return export(results, folder / "corrected") if with_files else read_plan(folder / "corrected")
