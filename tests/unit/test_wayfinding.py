"""GDAL reads level, units and openings in IMDF's words."""

import json

import numpy as np
import pyogrio
import shapely

from helpers import floorplan_making
from scanplan.exports.data import element_ids, element_tables, geopackage, wayfinding
from scanplan.exports.model_origin import Site


def test_rooms_are_units_and_doors_openings_of_one_level(tmp_path):
    openings = floorplan_making.openings()
    openings["width_m"][1] = 0.8
    drawn = floorplan_making.plan(openings=openings)
    rows = element_tables.tabulate_elements(drawn, element_ids.ids_from_places(drawn))
    path = tmp_path / "plan.gpkg"
    geopackage.write_geopackage(path, wayfinding.imdf_layers(drawn, rows), 10**18)

    def read(layer):
        about, _, shapes, columns = pyogrio.raw.read(path, layer=layer)
        values = dict(zip(about["fields"], (c.tolist() for c in columns), strict=True))
        return shapely.from_wkb(shapes), values

    (outline,), level = read("imdf_level")
    # 7.4 m x 3.4 m, with the 0.1 m that are assumed behind the east wall's face
    assert outline.area == 7.4 * 3.4 and level["ordinal"] == [0]
    areas, units = read("imdf_unit")
    assert shapely.area(areas).round(6).tolist() == [12.0, 9.0]
    assert units["category"] == ["room"] * 2 and units["level_id"] == level["id"] * 2
    assert units["global_id"] == rows["rooms"]["global_id"]
    lines, doors = read("imdf_opening")
    # an entrance of 1 m, and a door that a wheelchair does not pass; the window is no opening
    assert np.round(shapely.length(lines), 6).tolist() == [1.0, 0.9]
    assert doors["accessibility"] == ["wheelchair", None]
    assert doors["category"] == ["pedestrian"] * 2 and doors["door_type"] == ["unspecified"] * 2
    assert len({*level["id"], *units["id"], *doors["id"]}) == 5


def test_wheelchairs_pass_doors_of_90_cm_that_were_seen_narrower():
    openings = floorplan_making.openings()
    openings["width_m"][:2] = 0.88
    drawn = floorplan_making.plan(openings=openings)
    ids = element_ids.ids_from_places(drawn)
    rows = element_tables.tabulate_elements(drawn, ids, {1: 0.9})
    doors = wayfinding.imdf_layers(drawn, rows)["imdf_opening"].rows
    assert doors["accessibility"] == [None, "wheelchair"]
    assert doors["width_m"] == [0.88, 0.88] and doors["nominal_width_m"] == [None, 0.9]


def test_geojson_has_the_same_with_the_members_of_imdf(tmp_path):
    rooms = floorplan_making.rooms()
    rooms["use"][:] = ["restroom", "our den"]
    drawn = floorplan_making.plan(rooms=rooms)
    rows = element_tables.tabulate_elements(drawn, element_ids.ids_from_places(drawn))
    site = Site("EPSG:25832", 500_000.0, 5_400_000.0, turn_deg=90.0)
    path = tmp_path / "imdf.geojson"
    path.write_text(wayfinding.format_imdf(drawn, rows, site, "Ground floor"))
    made = json.loads(path.read_text())
    by_type = {}
    for feature in made["features"]:
        by_type.setdefault(feature["feature_type"], []).append(feature)
    assert {kind: len(found) for kind, found in by_type.items()} == {
        **{"level": 1, "unit": 2, "opening": 2}
    }
    assert by_type["level"][0]["properties"]["name"] == {"en": "Ground floor"}
    # what is no category of IMDF's is a room
    assert [unit["properties"]["category"] for unit in by_type["unit"]] == ["restroom", "room"]
    door = by_type["opening"][0]
    assert door["properties"]["door"]["type"] == "unspecified"
    assert door["properties"]["accessibility"] == ["wheelchair"]
    assert {f["properties"]["level_id"] for f in by_type["unit"]} == {by_type["level"][0]["id"]}
    about, _, shapes, _ = pyogrio.raw.read(path)
    assert about["crs"] == "EPSG:25832"
    # turned by a quarter: what lies east of the map's origin lies north of the site's
    x0, y0, x1, y1 = shapely.total_bounds(shapely.from_wkb(shapes))
    assert 499_990 < x0 < x1 < 500_001 and 5_399_999 < y0 < y1 < 5_400_010
