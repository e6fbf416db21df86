"""The page of what changed between two surveys: a slider between both plans, a table, the sheet."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import shapely
from markupsafe import Markup
from shapely.geometry.base import BaseGeometry

from scanplan.changes.change_words import say_change
from scanplan.changes.comparison import Comparison
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import LIKELY
from scanplan.geometry import overlays
from scanplan.report.templates import render_template
from scanplan.types import FilePath

_AROUND_M = 0.5  # of the plans in the picture
_TEMPLATE = "changes.html.j2"


def read_sources(paths: Iterable[FilePath]) -> dict[str, str]:
    """Return the texts of template and styles, by file name."""
    return {Path(path).name: Path(path).read_text(encoding="utf-8") for path in paths}


def format_page(
    compared: Comparison, sources: Mapping[str, str], summary: Sequence[str], sheet: str
) -> str:
    """Return the page, which opens offline.

    Parameters
    ----------
    sources : dict of str to str
        File name to text: template and styles.
    summary : sequence of str
        Title and lines.
    sheet : str
        The drawing as SVG.
    """
    plans = [(name, list(_list_shapes(s))) for name, s in (("a", compared.a), ("b", compared.b))]
    bounds = np.array([shapely.bounds(s) for _, shapes in plans for _, s in shapes])
    bounds = bounds[np.isfinite(bounds).all(axis=1)]
    low_m, high_m = bounds[:, :2].min(axis=0) - _AROUND_M, bounds[:, 2:].max(axis=0) + _AROUND_M
    width_m, height_m = (high_m - low_m).tolist()
    told = [of for of in compared.wholes if of[0].is_told or of[0].is_doubtful]
    told.sort(key=lambda whole: (not whole[0].is_change, whole[0].is_doubtful))
    return render_template(
        sources,
        _TEMPLATE,
        summary=summary,
        names=(compared.a.plan.name, compared.b.plan.name),
        view=f"{low_m[0]:.3f} {-high_m[1]:.3f} {width_m:.3f} {height_m:.3f}",
        aspect=f"{width_m / height_m:.4f}",
        plans=[
            (name, [(kind, _format_path(shape)) for kind, shape in shapes])
            for name, shapes in plans
        ],
        rows=[(*say_change(whole), whole[0].doubt) for whole in told],
        likely=LIKELY,
        sheet=Markup(sheet.partition("?>")[2]),
    )


def _list_shapes(survey: Survey) -> Iterator[tuple[str, BaseGeometry]]:
    """Yield furniture, walls and openings of a survey, in the common frame."""
    plan = survey.plan
    for piece in shapely.from_wkb(np.asarray(plan.furniture["geometry"], object)):
        yield "furniture", survey.place(piece)
    open_areas = plan.all_gaps
    walls = overlays.subtract_areas(overlays.unite_areas(plan.bodies), open_areas)
    yield "wall", survey.place(walls)
    yield "opening", survey.place(open_areas)


def _format_path(shape: BaseGeometry) -> str:
    """Return a shape as an SVG path in metres, y down."""
    rings = [
        shapely.get_coordinates(ring)
        for part in shapely.get_parts(shape)
        if part.geom_type == "Polygon"
        for ring in shapely.get_rings(part)
    ]
    lines = ("L".join(f"{x:.3f} {-y:.3f}" for x, y in ring[:-1]) for ring in rings)
    return "".join(f"M{line}Z" for line in lines)
