"""The house stays as ARCHITECTURE.md draws it: its packages, and what they import."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
import shapely

import house_finds

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
PACKAGE = SCRIPTS / "scanplan"
LABORATORY = SCRIPTS / "thesis"
STAGES = (*SCRIPTS.glob("*.py"), *LABORATORY.glob("stages/*.py"))
DRAWN = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")

HABITS = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")

HOMES = {
    "rosbags": (
        "recordings/bags.py",
        "recordings/integrity/",
        "recordings/salvage/",
        "recordings/rosbag1_messages.py",
        "recordings/typestores.py",
        "exports/bag_writer.py",
        "lab/simulation/",
    ),
    "pyarrow": ("store/tables.py", "store/parquet.py", "store/arrow_arrays.py", "store/lineage.py"),
    "open3d": (
        "extraction/iterative_ransac.py",
        "recordings/scan_folder.py",
        "registration/point_icp.py",
        "lab/simulation/raycast.py",
    ),
    "small_gicp": ("registration/",),
    "pye57": ("recordings/stations/e57_stations.py",),
    "defusedxml": ("recordings/integrity/e57_header.py",),
    "kiss_icp": ("recordings/motion/lidar_odometry.py",),
    "yaml": ("project/",),
    "jsonschema": ("project/",),
    "ezdxf": ("exports/", "design/", "edited/"),
    "ifcopenshell": ("exports/", "design/", "edited/"),
    "laspy": ("exports/data/point_cloud.py", "recordings/las_points.py"),
    "sqlite3": ("exports/data/geopackage.py",),
    "trimesh": ("lab/buildings/",),
    "jinja2": ("report/", "thesis/"),
    "matplotlib": ("exports/", "report/", "stage/figure_files.py", "thesis/"),
    "snakemake": (),
    "pandas": ("lab/", "thesis/"),
    "sklearn": ("selection/hulls.py",),
}
"""Library to the files and folders of the package that may import it."""

OVERLAYS = frozenset(
    (
        *("buffer", "build_area", "clip_by_rect", "coverage_simplify", "coverage_union"),
        *("coverage_union_all", "difference", "disjoint_subset_union", "disjoint_subset_union_all"),
        *("intersection", "intersection_all", "line_merge", "linemerge", "make_valid", "node"),
        *("offset_curve", "parallel_offset", "polygonize", "polygonize_full", "set_precision"),
        *("shared_paths", "simplify", "snap", "symmetric_difference", "symmetric_difference_all"),
        *("unary_union", "union", "union_all"),
    )
)
"""What shapely's functions and geometries call that which `geometry/overlays.py` alone may ask of
them; of a set, operators say the same."""

HEAVY = ("numpy", "shapely", "pyarrow", "scipy", "open3d", "matplotlib", "rosbags")


def section(title: str) -> str:
    """Return the text of a section of ARCHITECTURE.md."""
    _, _, after = DRAWN.partition(f"\n## {title}\n")
    return after.partition("\n## ")[0]


def first_cells(title: str) -> list[str]:
    """Return the names in backticks that the rows of a section's table begin with."""
    return re.findall(r"^\| `([\w/]+)`", section(title), re.M)


FLOORS = first_cells("Packages")
"""Packages from the roof down: a package imports itself and what stands below it."""


@cache
def modules() -> dict[str, Path]:
    """Return the helpers' files by their dotted names: below `scanplan`, or from `thesis` on."""
    helpers = [*PACKAGE.rglob("*.py"), *(set(LABORATORY.rglob("*.py")) - set(STAGES))]
    files = {}
    for path in sorted(helpers):
        parts = path.relative_to(home_of(path)).with_suffix("").parts
        files[".".join(parts).removesuffix(".__init__")] = path
    return files


def home_of(path: Path) -> Path:
    """Return the folder that a helper's name in the document begins at."""
    return PACKAGE if path.is_relative_to(PACKAGE) else SCRIPTS


@cache
def code() -> list[house_finds.Module]:
    """Return all files of `scripts/`, parsed once."""
    return house_finds.read_modules(SCRIPTS)


@cache
def trees() -> dict[Path, ast.Module]:
    """Return the syntax trees of all files of `scripts/`."""
    return {SCRIPTS / module.path: module.tree for module in code()}


@cache
def imported(path: Path, *, types: bool) -> frozenset[str]:
    """Return the dotted names that a file imports; with `types` also those for type checkers."""
    tree = trees()[path]
    names = set()
    for node in run_nodes(tree) if not types else ast.walk(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.update(f"{node.module}.{alias.name}" for alias in node.names)
    return frozenset(names)


def run_nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a tree but those under `if TYPE_CHECKING`."""
    for node in ast.iter_child_nodes(tree):
        if not (isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")):
            yield node
            yield from run_nodes(node)


def own_imports(path: Path, *, types: bool = True) -> set[str]:
    """Return the helpers that a file imports, as keys of `modules`."""
    found = set()
    for name in imported(path, types=types):
        if name.startswith(("scanplan.", "thesis.")):
            inner = name.removeprefix("scanplan.")
            found.add(inner if inner in modules() else inner.rpartition(".")[0])
    return found


def floor(module: str) -> str:
    """Return the package of `FLOORS` that a module is in."""
    place = module.replace(".", "/")
    return max((f for f in FLOORS if f"{place}/".startswith(f"{f}/")), key=len, default=place)


def test_the_document_names_every_package_and_no_other():
    inits = [path for path in modules().values() if path.name == "__init__.py"]
    folders = {path.parent.relative_to(home_of(path)) for path in inits} - {Path()}
    in_parts = ("lab", "thesis")
    packages = {f.as_posix() for f in folders if len(f.parts) == 1 or f.parts[0] in in_parts}
    loose = {path.stem for path in PACKAGE.glob("*.py")} - {"__init__"}
    assert set(FLOORS) == packages | loose


def test_the_picture_names_packages_that_exist():
    named = set(re.findall(r"\[(\w+(?:/\w+)?)\]", section("The way of the data")))
    assert len(named) >= 8 and named <= set(FLOORS)


def test_the_document_names_files_that_exist():
    places = re.findall(r"`([\w./]+/[\w.]+\.(?:py|yaml|smk|md|j2))`", DRAWN + HABITS)
    homes = (ROOT, PACKAGE, SCRIPTS)
    absent = [p for p in places if not any((home / p).exists() for home in homes)]
    assert places and absent == []


STEPS = [title for title in re.findall(r"^## (.+)$", HABITS, re.M) if title.startswith("Add a")]
"""What CONTRIBUTING.md takes step by step."""


def test_the_commonest_changes_are_taken_step_by_step():
    wanted = {"Add a kind of recording", "Add a label of the model", "Add a column of a table"}
    assert wanted <= set(STEPS)


@pytest.mark.parametrize("title", STEPS)
def test_steps_lead_to_names_that_there_are(title):
    """Functions, constants and attributes stand in a file that is named, all else in the rules."""
    steps = HABITS.partition(f"\n## {title}\n")[2].partition("\n## ")[0]
    places = re.findall(r"`((?:\w+/)+[\w.]+|\w+\.(?:py|yaml))`", steps)
    homes = [home / place for place in places for home in (ROOT, PACKAGE, SCRIPTS)]
    files = [path for home in homes for path in (home.rglob("*.py") if home.is_dir() else [home])]
    files += (ROOT / "workflow").rglob("*.smk")
    text = "\n".join(path.read_text(encoding="utf-8") for path in files if path.is_file())
    names = re.findall(r"`([a-zA-Z_]\w+)(?:\([^`]*\))?`", steps)
    assert places and [name for name in names if not re.search(rf"\b{name}\b", text)] == []


@pytest.mark.parametrize("package", FLOORS)
def test_a_package_imports_only_downwards(package):
    below = set(FLOORS[FLOORS.index(package) :])
    wrong = [
        f"{name} imports {other}"
        for name, path in modules().items()
        if floor(name) == package
        for other in own_imports(path)
        if floor(other) not in below
    ]
    assert wrong == []


@pytest.mark.parametrize("part", ["lab", "thesis"])
def test_helpers_of_no_user_are_imported_by_no_others(part):
    inside = {name for name in modules() if name.split(".")[0] in (part, "thesis")}
    outside = [path for name, path in modules().items() if name not in inside]
    outside += SCRIPTS.glob("*.py") if part == "thesis" else []
    wrong = [p for p in outside if any(m.split(".")[0] == part for m in own_imports(p))]
    assert inside and wrong == []


CIRCLES_OF_TYPES = {"plan.faces.candidates", "plan.faces.face_pairs"}
"""Modules that name one another's types; they go with the rules that they are of."""


@pytest.mark.parametrize("types", [False, True])
def test_no_module_imports_itself_through_others(types):
    left_out = CIRCLES_OF_TYPES if types else set()
    arrows = {n: own_imports(path, types=types) - left_out for n, path in modules().items()}
    while arrows:
        leaves = [name for name, targets in arrows.items() if not targets & arrows.keys()]
        assert leaves, f"these import one another: {sorted(arrows)}"
        for name in leaves:
            del arrows[name]


@pytest.mark.parametrize("library", HOMES)
def test_a_library_is_imported_in_its_homes_only(library):
    users = [
        path.relative_to(home_of(path)).as_posix()
        for path in modules().values()
        if any(name.split(".")[0] == library for name in imported(path, types=True))
    ]
    assert [user for user in users if not user.startswith(HOMES[library] or ("-",))] == []


def find_overlays(path: Path, tree: ast.Module) -> list[str]:
    """Return the places of a file, file:line, that ask shapely for an overlay."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in OVERLAYS:
            # the output's bytes, sets by their class, rows of pandas
            of = ast.unparse(node.value).rpartition(".")[2]
            is_other = of in ("stdout", "stderr", "set", "frozenset", "index")
            found += [] if is_other else [f"{path.relative_to(ROOT)}:{node.lineno}"]
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("shapely"):
            is_one = any(alias.name in OVERLAYS for alias in node.names)
            found += [f"{path.relative_to(ROOT)}:{node.lineno}"] if is_one else []
    return found


def test_only_overlays_asks_for_overlays():
    homes = {PACKAGE / "geometry/overlays.py", PACKAGE / "geometry/overlay_steps.py"}
    found = {path: find_overlays(path, tree) for path, tree in trees().items()}
    assert all(found.pop(home) for home in homes)
    assert [place for places in found.values() for place in places] == []


@pytest.mark.parametrize(
    "planted",
    [
        "import shapely\nshapely.union_all(areas)",
        "import shapely\nareas = room.buffer(0.1)",
        "import shapely\nreduce(shapely.difference, areas)",
        "import shapely\nparts = [room.intersection(area).area for room in rooms]",
        "import shapely\nfrom shapely.ops import unary_union",
        "import shapely\nfrom shapely import difference as minus",
    ],
)
def test_an_overlay_elsewhere_is_found_with_its_line(planted):
    place = PACKAGE / "plan/planted.py"
    assert find_overlays(place, ast.parse(planted)) == ["scripts/scanplan/plan/planted.py:2"]


@pytest.mark.parametrize("operator", "|&-^")
def test_an_operator_of_shapes_is_refused_in_scripts_and_nowhere_else(operator):
    shapes = {"one": shapely.box(0, 0, 2, 1), "other": shapely.box(1, 0, 3, 1)}
    code = f"one {operator} other"
    assert eval(compile(code, __file__, "eval"), shapes).area in (1, 2, 3)  # noqa: S307
    with pytest.raises(AssertionError, match="overlays"):
        eval(compile(code, PACKAGE / "planted.py", "eval"), shapes)  # noqa: S307


def read_by_rules() -> set[str]:
    """Return the modules that rules import: they run whenever the workflow is parsed."""
    rules = "\n".join(file.read_text() for file in (ROOT / "workflow").rglob("*.smk"))
    rules += (ROOT / "workflow/thesis/Snakefile").read_text()
    names = set()
    pattern = r"^from ((?:scanplan|thesis)[\w.]*) import ([\w, ]+|\()"
    for origin, what in re.findall(pattern, rules, re.M):
        inner = origin.removeprefix("scanplan").removeprefix(".")
        parts = [f"{inner}.{name.strip()}" for name in what.split(",")]
        names.update(part for part in parts if part in modules())
        names.add(inner)
    return {name if name.startswith("thesis") else f"scanplan.{name}" for name in names}


def test_what_rules_import_is_light():
    code = (
        f"import sys, {', '.join(read_by_rules())}; print([m for m in {HEAVY} if m in sys.modules])"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], cwd=SCRIPTS, capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"


WITHOUT_SCIPY = (
    *("observe_walls", "order_scans", "extract_chosen_walls", "validate_plan"),
    *("draw_figures", "export_plan", "export_files", "write_report"),
    # what worker processes of the registration import
    *("scanplan.registration.batches", "scanplan.registration.loops"),
)
"""Stages of the default target that work without scipy, which takes as long to import as they."""


def test_stages_begin_without_scipy_where_they_do_not_need_it():
    code = f"import sys, {', '.join(WITHOUT_SCIPY)}; print('scipy' in sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", code], cwd=SCRIPTS, capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "False"


def test_only_guarded_calls_of_stages_say_snakemake():
    for script in STAGES:
        before, _, _ = script.read_text(encoding="utf-8").partition('if __name__ == "__main__":')
        assert "snakemake." not in before, script.name


RERUN_ALONE = ("code", "content")
"""Params of rules that make a stage run again, and tell it nothing."""


def test_stages_take_all_that_their_rules_hand_them():
    taken, missed = [], []
    for rules in (ROOT / "workflow").rglob("*.smk"):
        for part in re.split(r"^ *rule\b.*:$", rules.read_text(), flags=re.MULTILINE)[1:]:
            script = re.search(r'^ *script:\s+"(.+)"', part, re.MULTILINE)
            params = re.search(r"^( *)params:\n((?:\1 +.*\n)+)", part, re.MULTILINE)
            if script and params:
                says = (rules.parent / script[1]).read_text()
                names = re.findall(rf"^{params[1]}    (\w+)=", params[2], re.MULTILINE)
                is_whole = "dict(snakemake.params" in says or "**snakemake.params" in says
                for name in names:
                    is_read = is_whole or re.search(rf"snakemake\.params\.{name}\b", says)
                    is_taken = is_read or name in RERUN_ALONE
                    (taken if is_taken else missed).append((script[1], name))
    assert missed == []
    assert ("../../scripts/assemble_building.py", "receivers") in taken


def test_public_functions_are_annotated():
    assert house_finds.find_unannotated(code()) == []


def test_lines_are_short():
    assert house_finds.find_long_lines(code()) == []


def test_parameters_are_listed_where_there_is_more_to_say_than_their_class():
    found = house_finds.find_silent_parameters(code())
    # rules of a plan make way for its model, and take their docstrings with them
    assert [place for place in found if not place.startswith("scanplan/plan/")] == []


def test_a_silent_parameter_is_found(tmp_path):
    listed = "\n    ".join(
        ("a : int", "b, c : list of Wall", "d : int", "    Told.", "e : (n,) int")
    )
    text = f'def f(a, b, c, d, e):\n    """Do.\n\n    Parameters\n    ---\n    {listed}\n    """\n'
    (tmp_path / "planted.py").write_text(text)
    found = house_finds.find_silent_parameters(house_finds.read_modules(tmp_path))
    assert found == ["planted.py:1 a", "planted.py:1 b, c"]


def annotated(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield names of parameters, fields and functions of nothing but `self`, with their types."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg) and node.annotation:
            yield node.arg, ast.unparse(node.annotation)
        elif isinstance(node, ast.AnnAssign):
            name = getattr(node.target, "id", None) or getattr(node.target, "attr", "")
            yield name, ast.unparse(node.annotation)
        elif isinstance(node, ast.FunctionDef) and node.returns and len(node.args.args) <= 1:
            yield node.name, ast.unparse(node.returns)


def stated_types() -> dict[str, set[str]]:
    """Return the types that the glossary says names of one meaning have."""
    rows = re.findall(r"^\| (`.+?`) \| (.+) \|$", section("Glossary"), re.M)
    return {
        name: {of.replace("\\|", "|") for of in re.findall(r"`(.+?)`", types)}
        for names, types in rows
        for name in re.findall(r"`(\w+)`", names)
    }


def test_names_of_one_meaning_have_the_types_that_the_glossary_says():
    stated = stated_types()
    found = [(module.path, *of) for module in code() for of in annotated(module.tree)]
    wrong = [of for of in found if of[2] not in stated.get(of[1], {of[2]})]
    assert wrong == []
    assert len(stated) > 10 and set(stated) <= {name for _, name, _ in found}


@pytest.mark.parametrize(
    "planted", ["def find(seen: Polygon): ...", "seen: int = 0", "def seen(self) -> Polygon: ..."]
)
def test_a_name_of_another_meaning_is_found(planted):
    ((name, of),) = annotated(ast.parse(planted))
    assert name == "seen" and of not in stated_types()["seen"]
