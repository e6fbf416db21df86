"""What people write: names, lists, corrections, buildings, and what is in the files' place."""

import json
from functools import partial
from pathlib import Path

from faults import word_inputs
from faults.judging import Case
from helpers import odd_files
from helpers.corrected_files import exported, read_texts
from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.exports.sheet.lettering import clean_text
from scanplan.project import building_file, corrections_file, dataset, overlooked_files
from scanplan.project.settings import KnownSettings, end_on_faulty_settings

_ROOT = Path(__file__).resolve().parents[2]
_DRAWINGS = _ROOT / "config/buildings"
_KNOWN = KnownSettings(SETTINGS, [], SCHEMA)


def list_word_cases(folder, n_drawn):
    """Cases of all that people write; of names that are drawn so many."""
    folder = Path(folder, "words")
    folder.mkdir()
    return [
        *_list_corrections(folder),
        *_list_lists(folder),
        *_list_buildings(folder),
        *_list_places(folder),
        *_list_overlooked(folder),
        *_list_drawn(folder, n_drawn),
    ]


def _write(folder, name, content):
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
    return path


def _list_corrections(folder):
    texts = {
        name: f"corrections:\n- {entry}\n" for name, entry in word_inputs.ENTRIES.items()
    } | word_inputs.YAML
    for system in word_inputs.SYSTEMS:
        texts[f"crs {system}"] = _state_points([[0, 0], [9, 0]], [[1, 2], [10, 2]], system)
    for name, (at, world) in word_inputs.POINTS.items():
        texts[f"points {name}"] = _state_points(at, world, "EPSG:25832")
    cases = []
    for number, (name, text) in enumerate(texts.items()):
        path = _write(folder / f"corrections_{number}", "corrections.yaml", text)
        run = partial(corrections_file.read_corrections, path)
        cases.append(Case("corrections", name, run, may_pass=False))
    for number, (name, text) in enumerate(word_inputs.FEATURES.items()):
        path = _write(folder / f"features_{number}", "corrections.geojson", text)
        run = partial(corrections_file.read_corrections, path)
        cases.append(Case("corrections of GeoJSON", name, run, may_pass=False))
    pair = json.dumps({"element": "room", "at": [1, 2], "name": "🏠"})
    path = _write(folder / "pair", "corrections.yaml", f"corrections:\n- {pair}\n")
    run = partial(corrections_file.read_corrections, path)
    return [*cases, Case("corrections", "a pair", run, lambda found: found[0].name == "🏠")]


def _state_points(at, world, crs):
    said = {"element": "reference_point", "crs": crs}
    points = [said | {"at": a, "world": w} for a, w in zip(at, world, strict=True)]
    # YAML has JSON in it, but for exponents without a point
    return json.dumps({"corrections": points}, ensure_ascii=False).replace("1e+300", "1.0e+300")


def _list_lists(folder):
    cases = []
    for number, (name, text) in enumerate(word_inputs.LISTS.items()):
        path = _write(folder / f"list_{number}", "floors.tsv", text)
        run = partial(dataset.name_datasets, str(path))
        cases.append(Case("lists", name, run, may_pass=False))
    for name, path in word_inputs.PATHS.items():
        run = partial(dataset.name_datasets, [path])
        cases.append(Case("paths", name, run, may_pass=False))
    return cases


def _list_buildings(folder):
    cases = []
    for number, (name, text) in enumerate(word_inputs.BUILDINGS.items()):
        inside = folder / f"building_{number}"
        _write(inside, "building.yaml", text)
        given = {dataset: str(inside / dataset) for dataset in "ab"}
        run = partial(building_file.find_building, given)
        cases.append(Case("buildings", name, run, may_pass=False))
    return cases


def _put_large(path):
    path.write_bytes(b"# no end\n" * 10**6)


_IN_PLACE = {
    "a pipe": odd_files.put_pipe,
    "a device": odd_files.put_device,
    "a folder": odd_files.put_folder,
    "a dangling link": odd_files.put_lost_link,
    "+ a link to itself": odd_files.put_loop,
    "+ a socket": odd_files.put_socket,
    "+ nine megabytes": _put_large,
}


def _list_places(folder):
    """Something else in the place of a file that people write."""
    cases = []
    read = {
        "dataset.yaml": _describe,
        "corrections.yaml": _describe,
        "corrections.geojson": _describe,
        "building.yaml": _find_building,
        "floors.tsv": _read_list,
        "survey.yaml": _describe_survey,
        "mine.yaml": _read_configfile,
    }
    for name, run in read.items():
        for what, put in _IN_PLACE.items():
            if (name, what) in (("floors.tsv", "a folder"), ("survey.yaml", "a folder")):
                continue  # a folder of any name is a dataset
            inside = folder / f"{name}_{put.__name__}"
            _write(inside / "d", "run.bag", "x")
            _write(inside / "e", "run.bag", "x")
            put((inside / "d" if run is _describe else inside) / name)
            case = partial(run, inside, name)
            cases.append(Case("in the place of files", f"{what}: {name}", case, may_pass=False))
    others = ("truth.geojson", "truth_poses.tum", "b.bag", "b.mcap", "b.db3", "c/b.bag")
    for number, name in enumerate(others):
        for what in ("a pipe", "a dangling link", "+ a link to itself"):
            inside = folder / f"other_{number}_{_IN_PLACE[what].__name__}"
            _write(inside / "d", "run.bag", "x")
            path = inside / "d" / name
            path.parent.mkdir(exist_ok=True)
            _IN_PLACE[what](path)
            case = partial(_describe, inside, name)
            kind = f"+ {what.removeprefix('+ ')}: {name}"
            cases.append(Case("in the place of files", kind, case, may_pass=False))
    return cases


def _describe(folder, _):
    return dataset.describe_dataset("d", folder / "d", _KNOWN, drawings=_DRAWINGS)


def _describe_survey(folder, name):
    return dataset.describe_dataset("d", folder / name, _KNOWN, drawings=_DRAWINGS)


def _find_building(folder, _):
    return building_file.find_building({name: str(folder / name) for name in "de"})


def _read_list(folder, name):
    return dataset.name_datasets(str(folder / name))


def _read_configfile(folder, name):
    end_on_faulty_settings(["snakemake", "--configfile", str(folder / name)])


def _list_overlooked(folder):
    """Names of files that are nearly those that are read: each is told."""
    cases = []
    names = ["corrections.yml", "Corrections.yaml", "corrections.json", "+ CORRECTIONS.YAML.TXT"]
    names += ["+ Dataset.YML", "+ truth.json", "+ Truth_poses.tum"]
    for number, name in enumerate(names):
        inside = folder / f"overlooked_{number}"
        _write(inside, "run.bag", "x")
        _write(inside, name.removeprefix("+ "), "{}")
        run = partial(overlooked_files.list_overlooked, inside)
        cases.append(Case("overlooked files", name, run, lambda notes: len(notes) == 1))
    given = folder / "overlooked_building"
    _write(given, "Building.yml", word_inputs.STOREYS)
    run = partial(building_file.list_overlooked, {name: str(given / name) for name in "ab"})
    return [*cases, Case("overlooked files", "+ Building.yml", run, lambda notes: len(notes) == 1)]


def _list_drawn(folder, n_drawn):
    cases = []
    for number, (what, name) in enumerate([*word_inputs.DRAWN.items()][:n_drawn]):
        inside = folder / f"drawn_{number}"
        inside.mkdir()
        run = partial(_draw, inside, name)
        cases.append(Case("names in drawings", what, run, partial(_holds, name)))
    return cases


def _draw(folder, name):
    entry = {"element": "room", "at": [5, 1], "name": name}
    return read_texts(exported(folder, [entry], name="office", project=name, storey=name))


def _holds(name, found):
    """Whether all files hold a name, in drawings as far as there is room and a glyph."""
    quoted = f"'{name}" if name.startswith("=") else name
    told = {**dict.fromkeys(("ifc", "geojson", "json", "gpkg"), name), "csv": quoted}
    if len(name) < 40:
        told |= {"dxf": clean_text(name), "svg": clean_text(name)}
    if name.isascii() and len(name) < 40:
        told |= {"pdf": name}
    return all(text in found[kind] for kind, text in told.items())
