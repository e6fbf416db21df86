"""A second visit to a house of two rooms is planned from its tables."""

import json

import numpy as np
import pytest

from assemble_plan import assemble_plan
from helpers import house_making
from plan_next_visit import plan_next_visit
from scanplan.plan import floorplan, floorplan_files, planning
from scanplan.store import schemas, tables

PARTS = ("faces", "walls", "openings", "rooms", "free")
SETTINGS = {"clearance_m": 0.3, "spacing_m": 0.5}


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    folder = tmp_path_factory.mktemp("house")
    inputs = house_making.write(folder, house_making.segments(), house_making.SENSORS)
    paths = {name: folder / f"plan_{name}.parquet" for name in planning.TABLES}
    assemble_plan(*inputs, paths, settings=house_making.PLAN, n_scans=None)
    further = dict(zip(("selection", "scans", "registration"), inputs[1:], strict=True))
    return {name: paths[name] for name in PARTS} | further


def planned(plan, folder, doubtful=(), **stated):
    """Plan a visit where the rooms named are doubtful and all else is sure."""
    parts = []
    for table, number in sorted(floorplan.NUMBERS.items()):
        schema = schemas.PLAN_WALLS if table == "walls" else getattr(schemas, table.upper())
        numbers = tables.read_table(plan[table], schema, allow_empty=True)[number]
        verify = np.isin(numbers, doubtful) if table == "rooms" else np.zeros(len(numbers), bool)
        parts.append({
            "table": np.full(len(numbers), table, object),
            "number": numbers.astype(np.int32),
            "p_true": np.where(verify, 0.4, 0.99),
            "verify": verify,
            "about": np.where(verify, "existence", "").astype(object),
            "doubt": np.where(verify, "few scans", "").astype(object),
            "needs_person": np.zeros(len(numbers), bool),
        })  # fmt: skip
    rated = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    tables.write_table(folder / "confidence.parquet", schemas.CONFIDENCE, rated)
    files = {name: folder / f"{name}.parquet" for name in ("questions", "standpoints")}
    files["geojson"] = folder / "next_visit.geojson"
    known = plan | {"confidence": folder / "confidence.parquet"}
    plan_next_visit(known, files, name="house", settings=SETTINGS, n_scans=None, **stated)
    asked = tables.read_table(files["questions"], schemas.QUESTIONS, allow_empty=True)
    stops = tables.read_table(files["standpoints"], schemas.STANDPOINTS, allow_empty=True)
    return asked, stops, json.loads(files["geojson"].read_text())


def test_where_nothing_is_doubtful_nobody_has_to_come_again(house, tmp_path):
    asked, stops, collection = planned(house, tmp_path)
    assert len(asked["kind"]) == len(stops["standpoint"]) == 0
    assert collection["features"] == []
    assert collection["summary"] == "nothing of the plan is unseen or doubtful"


def test_a_doubtful_room_is_seen_from_within(house, tmp_path):
    areas = floorplan_files.read_floorplan(house).areas
    for room, area in enumerate(areas):
        asked, stops, _ = planned(house, tmp_path, doubtful=[room])
        assert (asked["kind"].tolist(), asked["number"].tolist()) == (["room"], [room])
        assert asked["seen"][0] > 0.8 and asked["standpoint"][0] >= 1
        x_m, y_m = area.centroid.x, area.centroid.y
        assert np.hypot(stops["x_m"] - x_m, stops["y_m"] - y_m).max() < 2
        assert np.isnan(stops["heading_deg"]).all()


def test_a_visit_is_placed_where_the_settings_place_the_plan(house, tmp_path):
    site = {"crs": "EPSG:25832", "east_m": 5e5, "north_m": 54e5}
    _, stops, collection = planned(house, tmp_path, doubtful=[0], site=site)
    assert collection["crs"]["properties"]["name"].endswith("25832")
    x_m, y_m = collection["features"][0]["geometry"]["coordinates"]
    placed = (5e5 + stops["x_m"][0], 54e5 + stops["y_m"][0])
    assert (x_m, y_m) == pytest.approx(placed, abs=1e-3)


def test_the_same_tables_give_the_same_bytes(house, tmp_path):
    texts = []
    for _ in range(2):
        planned(house, tmp_path, doubtful=[0, 1])
        texts.append((tmp_path / "standpoints.parquet").read_bytes())
    assert texts[0] == texts[1]
