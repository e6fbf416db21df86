"""What was taped and where points lie correct all lengths that people get, and what comes back."""

import ifcopenshell
import numpy as np
import pandas as pd
import pytest
from ifcopenshell.util.element import get_psets
from PIL import Image

from helpers.corrected_files import exported, pdf_texts
from helpers.correcting import corrected, write_plan
from helpers.editing import (
    edited_json,
    entries_of,
    make_results,
    move_wall,
    run_again,
    taken,
    write_entries,
)
from scanplan.exports.model_origin import find_site

TAPED = [
    {"element": "length", "action": "add", "line": line, "length_m": m, "sigma_m": 0.002}
    for line, m in (([[0.1, 1.0], [3.9, 1.0]], 4.08), ([[2.0, 0.05], [2.0, 2.8]], 3.06))
]


def read_areas_m2(path):
    model = ifcopenshell.open(path)
    sets = [get_psets(space) for space in model.by_type("IfcSpace")]
    return [of["Qto_SpaceBaseQuantities"]["NetFloorArea"] for of in sets]


def test_lengths_of_all_files_are_those_of_the_tape(tmp_path):
    """Two lengths that are 2 % longer than drawn: what people get has them, a robot's map not."""
    sized = {"element": "opening", "at": [4.1, 1.4], "width_m": 1.0}
    files = {}
    for name, said in (("map", [sized]), ("tape", [sized, *TAPED])):
        (tmp_path / name).mkdir()
        files[name] = exported(tmp_path / name, said)
    areas_m2 = {name: pd.read_csv(of["rooms_csv"])["area_m2"] for name, of in files.items()}
    np.testing.assert_allclose(areas_m2["tape"], 1.02**2 * areas_m2["map"], rtol=1e-3)
    spaces = {name: read_areas_m2(of["ifc"]) for name, of in files.items()}
    np.testing.assert_allclose(spaces["tape"], 1.02**2 * np.array(spaces["map"]), rtol=1e-3)
    # what was said to be a metre wide stays so
    for of in files.values():
        assert pd.read_csv(of["openings_csv"])["width_m"][1] == pytest.approx(1.0, abs=1e-3)
    assert files["tape"]["yaml"].read_text() == files["map"]["yaml"].read_text()
    with Image.open(files["tape"]["pgm"]) as grid, Image.open(files["map"]["pgm"]) as same:
        assert grid.size == same.size
    assert files["tape"]["trajectory"].read_text() == files["map"]["trajectory"].read_text()
    words = " ".join(pdf_texts(files["tape"]["pdf"].read_bytes()))
    assert "+2.00 % ± 0.07 % by 2 taped" in words
    assert "taped" not in " ".join(pdf_texts(files["map"]["pdf"].read_bytes()))


def test_points_of_three_places_and_tapes_are_one_scale(tmp_path):
    places = [
        ((x, y), (500000 + 1.02 * x, 5400000 + 1.02 * y)) for x, y in ((0, 0), (7, 0), (0, 3))
    ]
    said = [
        {"element": "reference_point", "at": list(at), "world": list(world), "crs": "EPSG:25832",
         "sigma_m": 0.005}
        for at, world in places
    ]  # fmt: skip
    plan = corrected(write_plan(tmp_path), *said, *TAPED)
    assert (plan.scale.n_lengths, plan.scale.n_points) == (2, 3)
    assert plan.scale.applied == pytest.approx(1.02) and plan.georeference.residual_m < 1e-6
    # the place on Earth is of the plan in metres of the tape
    site = find_site(plan.georeference, {})
    np.testing.assert_allclose(
        site.place(1.02 * np.array([7.0, 3.0])), (500007.14, 5400003.06), atol=1e-6
    )


def test_what_is_moved_in_a_scaled_file_comes_back_in_metres_of_the_map(tmp_path):
    results = make_results(tmp_path)
    write_entries(results, *TAPED)
    run_again(results, with_files=True)
    taken(results, edited_json(results, lambda floor: None))
    assert entries_of(results) == TAPED
    # 0.2 m to the east, of a file whose metres are 2 % longer
    taken(results, edited_json(results, lambda floor: move_wall(floor, 4.05 * 1.02)))
    (moved,) = entries_of(results)[2:]
    assert {end[0] for end in moved["line"]} == {round(4.05 + 0.2 / 1.02, 3)}
