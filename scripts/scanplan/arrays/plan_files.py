"""A plan of arrays as a file."""

from pathlib import Path

from scanplan.arrays.array_plan import ArrayPlan
from scanplan.exports import drawing, dxf, geojson, svg
from scanplan.exports.sheet import composition
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.facts import summarise_survey
from scanplan.stage import figure_files
from scanplan.store import atomic
from scanplan.types import FilePath

_SHEETS = {
    ".svg": svg.format_svg_sheet,
    ".dxf": dxf.format_dxf,
    ".pdf": lambda sheet: figure_files.format_pdf([drawing.draw_sheet(sheet)], _title(sheet)),
    ".png": lambda sheet: figure_files.format_png(drawing.draw_sheet(sheet)),
}


def write_plan(plan: ArrayPlan, path: FilePath) -> None:
    """Write a plan as its file's suffix says: .svg, .pdf, .png, .dxf or .geojson.

    Raises
    ------
    ValueError
        If it is none of them.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".geojson":
        content = geojson.format_geojson(plan.drawn, plan.evidence)
    elif suffix in _SHEETS:
        sheet = composition.compose_sheet(plan.drawn, summarise_survey(plan.evidence))
        content = _SHEETS[suffix](sheet)
    else:
        raise ValueError(f"{path}: must be one of .geojson, {', '.join(_SHEETS)}")
    atomic.write_bytes(path, content.encode() if isinstance(content, str) else content)


def _title(sheet: Sheet) -> str:
    return f"Floor plan of {sheet.name}"
