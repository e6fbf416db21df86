"""GDAL reads level, units and openings in IMDF's words."""

import numpy as np
import pyogrio
import shapely

from helpers import floorplan_making
from scanplan.exports.data import element_ids, element_tables, geopackage, wayfinding


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
