import json
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest

from export_plan import export_plan
from scanplan import faces, tables
from wallmaking import BARE, lengths_m, walls


@pytest.fixture
def exported(tmp_path):
    def run(folder):
        outputs = [tmp_path / folder / f"plan.{suffix}" for suffix in ("geojson", "svg", "dxf")]
        export_plan(tmp_path / "faces.parquet", *outputs, name="office")
        return outputs

    merged = faces.merge(walls([(0, 0, 4, 3), (10, 0, 10, 2)]), faces.MergeSettings(**BARE))
    tables.write(tmp_path / "faces.parquet", tables.FACES, merged)
    return run, merged


def test_all_three_files_hold_the_same_faces(exported):
    run, merged = exported
    geojson, svg, dxf = run("plan")
    stated = [f["properties"]["length_m"] for f in json.loads(geojson.read_text())["features"]]
    lines = ezdxf.readfile(dxf).modelspace().query("LINE")
    np.testing.assert_allclose(stated, lengths_m(merged), atol=1e-4)
    np.testing.assert_allclose([line.dxf.start.distance(line.dxf.end) for line in lines], lengths_m(merged))
    drawn = [e.get("id") for e in ElementTree.parse(svg).iter() if (e.get("id") or "").startswith("face-")]
    assert drawn == ["face-0", "face-1"]


def test_a_second_run_gives_the_same_bytes(exported):
    run, _ = exported
    assert [f.read_bytes() for f in run("once")] == [f.read_bytes() for f in run("again")]
