"""The formats that may be asked for, and the files of each."""

from helpers.default_settings import SCHEMA, SETTINGS
from scanplan.project import export_formats


def test_every_format_of_the_settings_has_files():
    formats = SCHEMA["properties"]["plan"]["properties"]["export"]["properties"]["formats"]
    known = [*export_formats.FILES, *export_formats.PRESENTATION, *export_formats.CLOUD]
    assert formats["items"]["enum"] == known
    assert all(export_formats.list_exports([name]) for name in known)


def test_no_two_formats_share_a_file():
    files = export_formats.list_exports([*export_formats.FILES, "presentation", "laz"])
    assert len(files) == len(set(files)) == 25


def test_files_of_formats_that_are_not_chosen_are_replaced():
    left = export_formats.list_replaced(["ifc", "glb", "gpkg", "csv", "json", "laz"])
    assert {"trajectory.tum", "plan/presentation.pdf"} <= set(left) and "plan/plan.ifc" not in left
    assert export_formats.list_replaced([*export_formats.FILES, "presentation"]) == []


def test_points_are_not_written_unasked():
    chosen = SETTINGS["plan"]["export"]["formats"]
    files = export_formats.list_exports(chosen)
    assert "plan/plan.ifc" in files and "cloud.laz" not in files
    assert export_formats.list_exports(["laz"]) == ["cloud.laz", "cloud.png"]
    assert export_formats.list_exports([]) == []
