import io

import ezdxf
import numpy as np
import pytest
import shapely

from helpers.floorplan_making import FOOTPRINT_M2, bare, plan
from scanplan.exports import dxf


def reopened(drawn):
    return ezdxf.read(io.StringIO(dxf.format_dxf(drawn)))


def outlines(document, layer):
    polylines = document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    return shapely.union_all([shapely.Polygon(p.get_points("xy")) for p in polylines if p.closed])


def test_walls_are_double_lines_as_far_apart_as_the_walls_are_thick():
    walls = outlines(reopened(plan()), "WALLS")
    for start, end, thick_m in (
        ((-1, 2.5), (1, 2.5), 0.2),
        ((3, 0.5), (5, 0.5), 0.1),
        ((3, -1), (3, 1), 0.2),
    ):
        assert shapely.intersection(
            shapely.LineString([start, end]), walls
        ).length == pytest.approx(thick_m, abs=1e-3)


def test_what_is_inferred_has_a_layer_of_its_own():
    document = reopened(plan())
    inferred = outlines(document, "WALLS_INFERRED")
    assert inferred.bounds == pytest.approx((4.05, 3.0, 7.1, 3.2), abs=1e-3)
    drawn_m2 = outlines(document, "WALLS").area + inferred.area
    assert drawn_m2 == pytest.approx(FOOTPRINT_M2 - 0.1 * 3.4 - 0.53, abs=1e-3)


def test_openings_are_as_long_as_they_are_wide_and_say_so():
    document = reopened(plan())
    lines = [
        p.get_points("xy") for p in document.modelspace().query('LWPOLYLINE[layer=="OPENINGS"]')
    ]
    np.testing.assert_allclose([np.hypot(*np.subtract(*xy)) for xy in lines], [1.0, 0.9, 1.2])
    said = [text.dxf.text for text in document.modelspace().query('TEXT[layer=="TEXT"]')]
    assert {"1.00", "0.90", "1.20", "Room 0", "12.0 m2", "9.0 m2"} == set(said) - {"Room 1"}
    panes = document.modelspace().query('LINE[layer=="OPENINGS"]')
    assert sorted(line.dxf.start.y for line in panes) == pytest.approx([-0.2, 0.0])


def test_openings_are_cut_out_of_the_walls():
    walls = outlines(reopened(plan()), "WALLS")
    assert not walls.intersects(shapely.LineString([(3, 1.5), (5, 1.5)]))


def test_rooms_are_closed_outlines_of_their_area():
    assert outlines(reopened(plan()), "ROOMS").area == pytest.approx(21)


def test_faces_alone_are_lines_of_their_length():
    lines = reopened(bare()).modelspace().query("LINE")
    assert [line.dxf.start.distance(line.dxf.end) for line in lines] == pytest.approx([5, 2])
    assert (lines[0].dxf.start.xyz, lines[0].dxf.end.xyz) == ((0, 0, 0), (4, 3, 0))


@pytest.mark.parametrize("drawn", [plan(), bare()])
def test_it_is_in_metres_on_named_layers_and_clean(drawn):
    document = reopened(drawn)
    assert document.dxfversion == "AC1024"
    assert document.units == ezdxf.units.M
    named = {"WALLS", "WALLS_INFERRED", "OPENINGS", "ROOMS", "TEXT"}
    assert (
        {entity.dxf.layer for entity in document.modelspace()}
        <= named
        <= {e.dxf.name for e in document.layers}
    )
    assert not document.audit().has_errors


def test_the_view_opens_on_the_plan():
    port = reopened(bare()).viewports.get_config("*Active")[0]
    assert port.dxf.center.isclose((5, 1.5))


def test_the_same_plan_gives_the_same_bytes():
    assert dxf.format_dxf(plan()) == dxf.format_dxf(plan())


def test_it_leaves_the_options_of_ezdxf_as_they_were():
    before = ezdxf.options.write_fixed_meta_data_for_testing
    dxf.format_dxf(plan())
    assert ezdxf.options.write_fixed_meta_data_for_testing == before
