import io

import ezdxf
import numpy as np
import pytest

from scanplan import cad, faces
from wallmaking import BARE, lengths_m, walls


@pytest.fixture
def merged():
    return faces.merge(walls([(0, 0, 4, 3), (10, 0, 10, 2), (0, 7, 3, 7)]), faces.MergeSettings(**BARE))


def reopened(text):
    return ezdxf.read(io.StringIO(text))


def test_lengths_of_the_lines_are_those_of_the_faces(merged):
    lines = reopened(cad.dumps(merged)).modelspace().query("LINE")
    np.testing.assert_allclose([line.dxf.start.distance(line.dxf.end) for line in lines], lengths_m(merged))


def test_lines_lie_where_the_faces_do(merged):
    line = reopened(cad.dumps(merged)).modelspace().query("LINE")[0]
    assert (line.dxf.start.xyz, line.dxf.end.xyz) == ((0, 0, 0), (4, 3, 0))


def test_it_is_in_metres_on_the_layer_walls_and_clean(merged):
    document = reopened(cad.dumps(merged))
    assert document.dxfversion == "AC1024"
    assert document.units == ezdxf.units.M
    assert {entity.dxf.layer for entity in document.modelspace()} == {"WALLS"}
    assert not document.audit().has_errors


def test_the_view_opens_on_the_plan(merged):
    port = reopened(cad.dumps(merged)).viewports.get_config("*Active")[0]
    assert port.dxf.center.isclose((5, 3.5))


def test_the_same_faces_give_the_same_bytes(merged):
    assert cad.dumps(merged) == cad.dumps(merged)


def test_it_leaves_the_options_of_ezdxf_as_they_were(merged):
    before = ezdxf.options.write_fixed_meta_data_for_testing
    cad.dumps(merged)
    assert ezdxf.options.write_fixed_meta_data_for_testing == before
