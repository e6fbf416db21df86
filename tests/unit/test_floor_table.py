"""The floors of a campus over time: counts of a plan and of a table of changes, on paper."""

import math
import re

import shapely

from helpers.changing_floor import survey
from scanplan.changes.change_table import tabulate_changes
from scanplan.changes.verdicts import GONE, MOVED, SAME, SHUT, Change
from scanplan.report import floor_table
from scanplan.store import schemas, tables

LINE = shapely.LineString([(0, 0), (3, 0)])
NONE = tables.no_rows(schemas.EVIDENCE)
OF = {"floor": "ground", "survey": "june", "earlier": "may"}


def test_a_survey_counts_what_its_plan_has_and_what_changed():
    changes = tabulate_changes(
        [
            Change("wall", 0, 0, SAME, 0.99, LINE),
            Change("wall", 1, 1, MOVED, 0.95, LINE, moved_m=(0.1, 0.0)),
            Change("wall", 2, -1, GONE, 0.5, LINE),
            Change("opening", 0, 0, SHUT, 0.97, LINE),
            Change("furniture", 3, -1, GONE, 0.99, shapely.box(0, 0, 1, 1)),
        ]
    )
    row = floor_table.describe_survey(OF, survey().plan, NONE, changes)
    assert (row["rooms"], row["doors"], row["windows"]) == (2, 1, 0)
    assert row["area_m2"] == 39.0 and row["wall_m"] == 31.0
    assert (row["walls_changed"], row["openings_changed"], row["furniture_changed"]) == (1, 0, 1)
    assert (row["doors_swung"], row["doubtful_changes"], row["unchanged_wall_m"]) == (1, 1, 3.0)


def test_the_first_survey_of_a_floor_has_no_changes_and_its_page_no_zeros(project_root):
    first = floor_table.describe_survey({**OF, "earlier": ""}, survey().plan, NONE, None)
    assert {v for name, v in first.items() if "changed" in name} == {None}
    assert not any(isinstance(v, float) and math.isnan(v) for v in first.values())
    none = tabulate_changes([])
    second = floor_table.describe_survey(OF, survey().plan, NONE, none)
    assert list(first) == list(second) and second["walls_changed"] == 0
    folder = project_root / "workflow/report/page"
    sources = {name: (folder / name).read_text() for name in ("floors.html.j2", "overview.css")}
    page = floor_table.format_page([first, second], sources)
    rows = page.partition("<tbody>")[2].split("</tr>")[:2]
    assert [len(re.findall("<td", row)) for row in rows] == [17, 17]
    assert page.count("<th>") == 17
    assert "changes/may/changes.html" in rows[1] and "changes.html" not in rows[0]
