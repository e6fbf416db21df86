"""Files of surveys as programs of others see them: validators, and readers that are not ours."""

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import ezdxf.filemanagement
import ifcopenshell
import ifcopenshell.validate
from ifctester import ids

_DEMANDS = {"plan.ifc": "building_model.ids", "presentation.ifc": "presentation_model.ids"}
_DRAWINGS = ("plan.dxf", "presentation.dxf")
_SHEETS = ("plan.pdf", "presentation.pdf", "presentation_a3.pdf")
_LAYERS = ("plan.gpkg", "plan.geojson", "imdf.geojson")
_FIRST_FONT = 2  # of the lines that pdffonts writes: below its heads
_EMBEDDED = -5  # of a font's columns, from the end: its name may have blanks
_SECONDS = 120  # for a program that hangs
# of packages of npm: gltf-validator, web-ifc
_GLTF = """
const fs = require("fs"), v = require("gltf-validator");
v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(({issues: i}) =>
  console.log(`${i.numErrors} errors, ${i.numWarnings} warnings`));
"""
_IFC = """
const fs = require("fs"), W = require("web-ifc"), api = new W.IfcAPI();
api.Init().then(() => {
  const model = api.OpenModel(new Uint8Array(fs.readFileSync(process.argv[1])));
  const count = (name) => api.GetLineIDsWithType(model, W[name]).size();
  let bodies = 0;
  api.StreamAllMeshes(model, () => { bodies += 1; });
  const names = ["WALL", "DOOR", "WINDOW", "SPACE", "FURNITURE"];
  const counts = names.map((name) => `${count("IFC" + name)} ${name.toLowerCase()}`);
  console.log(`${counts.join(", ")}; ${bodies} bodies`);
});
"""


def bench(root: Path, results: Path, surveys: Sequence[str], node: str = "") -> None:
    """Print what validators and other readers say of the files of each survey.

    Parameters
    ----------
    root : Path
        The project, with the demands on models.
    results : Path
        Folder of the surveys' results.
    surveys : sequence of str
    node : str
        A folder with `node_modules` of gltf-validator and web-ifc, which are asked if it is given.
    """
    for survey in surveys:
        plan = results / survey / "plan"
        for line in _check(root, plan, node):
            print(f"{survey}: {line}", flush=True)


def _check(root: Path, plan: Path, node: str) -> Iterator[str]:
    checks: list[tuple[Sequence[str], Callable[[Path], str]]] = [
        (_DRAWINGS, _audit),
        (_DRAWINGS, _print_drawing),
        (_SHEETS, _check_sheet),
        (_LAYERS, _read_layers),
    ]
    if node:
        checks += [(("plan.glb",), lambda file: _ask_node(_GLTF, file, node))]
        checks += [(tuple(_DEMANDS), lambda file: _ask_node(_IFC, file, node))]
    for name, demands in _DEMANDS.items():
        if (plan / name).is_file():
            yield f"{name}: {_validate(plan / name, root / 'workflow/schemas' / demands)}"
    for names, check in checks:
        for name in names:
            if (plan / name).is_file():
                yield f"{name}: {check(plan / name)}"


def _validate(file: Path, demands: Path) -> str:
    model = ifcopenshell.open(file)
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(model, log, express_rules=True)
    asked = ids.open(str(demands))
    asked.validate(model)
    n_met = sum(bool(specification.status) for specification in asked.specifications)
    return (
        f"{len(log.statements)} statements of the schema and its rules,"
        f" {n_met} of {len(asked.specifications)} demands met"
    )


def _audit(file: Path) -> str:
    auditor = ezdxf.filemanagement.readfile(file).audit()
    return f"{len(auditor.errors)} errors, {len(auditor.fixes)} repairs by ezdxf"


def _print_drawing(file: Path) -> str:
    """Let LibreCAD open a copy of a drawing and print it."""
    with tempfile.TemporaryDirectory() as folder:
        # it prints beside the drawing
        copy = Path(shutil.copy(file, folder))
        said = _run("librecad", "dxf2pdf", "-a", str(copy), QT_QPA_PLATFORM="offscreen")
        is_printed = copy.with_suffix(".pdf").is_file()
    return "opened and printed by LibreCAD" if is_printed else f"LibreCAD: {said}"


def _check_sheet(file: Path) -> str:
    fonts = _run("pdffonts", str(file)).splitlines()[_FIRST_FONT:]
    n_embedded = sum(font.split()[_EMBEDDED] == "yes" for font in fonts)
    embedded = f"{n_embedded} of {len(fonts)} fonts embedded" if fonts else "no fonts listed"
    checked = _run("qpdf", "--check", str(file)).replace("\n", " ")
    return f"qpdf: {checked}; {embedded}"


def _read_layers(file: Path) -> str:
    return _run("ogrinfo", "-so", "-q", str(file)).replace("\n", "; ")


def _ask_node(script: str, file: Path, node: str) -> str:
    return _run("node", "-e", script, str(file), NODE_PATH=f"{node}/node_modules")


def _run(program: str, *words: str, **surroundings: str) -> str:
    """Return what a program says, its faults and how it ended where that was not well."""
    if shutil.which(program) is None:
        return f"{program} is not installed"
    asked = ["env", *(f"{name}={value}" for name, value in surroundings.items()), program, *words]
    try:
        done = subprocess.run(asked, capture_output=True, text=True, timeout=_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"{program} gave no answer in {_SECONDS} s"
    if done.returncode:
        return f"{done.stdout}{done.stderr}".strip() + f" ({program} ended with {done.returncode})"
    return (done.stdout or done.stderr).strip()
