"""Which design a survey is held against, and tables of tolerances: faults end in one line."""

import pytest
import yaml

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.project.dataset import Dataset, list_deviations, list_replaced_models
from scanplan.project.design_file import choose_design, find_designs
from scanplan.project.tolerance_file import TABLES, read_tolerances

TABLE = {"title": "ours", "upto_m": [3], **{table: [10, 20] for table in TABLES}}


def test_the_only_design_in_the_folder_is_it_and_a_key_comes_first(tmp_path):
    assert find_designs(None, tmp_path) == find_designs(None, None) == ()
    (tmp_path / "House.IFC").write_text("")
    assert find_designs(None, tmp_path) == (str(tmp_path / "House.IFC"),)
    (tmp_path / "house.dxf").write_text("")
    named = str(tmp_path / "house.dxf")
    assert find_designs(named, tmp_path) == (named,)
    assert len(find_designs(None, tmp_path)) == 2


def test_several_designs_are_refused_where_deviations_are_asked_for():
    designs = ("floor/House.IFC", "floor/house.dxf")
    told = r"a has several, House\.IFC, house\.dxf.*plan\.design\.file"
    with pytest.raises(StageError, match=told):
        list_deviations(Dataset("a", {}, (), designs=designs))
    assert choose_design("a", designs[:1]) == designs[0]


@pytest.mark.parametrize(("named", "told"), [("house.dwg", "is no .ifc"), ("a.ifc", "not exist")])
def test_a_design_that_cannot_be_one_is_refused(tmp_path, named, told):
    with pytest.raises(StageError, match=told):
        find_designs(str(tmp_path / named), tmp_path)


def test_a_model_is_annotated_and_a_drawing_is_not():
    def files(*designs):
        return list_deviations(Dataset("a", {}, (), designs=designs))

    assert "results/a/design/deviations.bcf" in files("x.IFC")
    assert "results/a/design/as_built.ifc" in files("x.ifc")
    assert not [file for file in files("x.dxf") if file.endswith((".ifc", ".bcf"))]
    with refused(key="plan.design.file"):
        files()


@pytest.mark.parametrize(("design", "n_left"), [("x.IFC", 0), ("x.dxf", 2)])
def test_models_of_an_earlier_design_are_named_where_there_is_none_now(design, n_left):
    found = Dataset("a", {}, (), designs=(design,))
    left = list_replaced_models(found)
    assert len(left) == n_left and not set(left) & set(list_deviations(found))


def test_our_table_is_that_of_the_standard():
    table = read_tolerances("din_18202")
    assert table["upto_m"] == [1, 3, 6, 15, 30]
    assert table["wall"][:5] == [12, 16, 20, 24, 30] and table["opening"][:3] == [10, 12, 16]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"wall": [10]}, "1 limits for 1 sizes, expected 2"),
        ({"wall": [10, -1]}, "-1, expected 0.1"),
        ({"wall": [10, 10**400]}, "expected 0.1"),
        ({"wall": 10}, "no list"),
        ({"upto_m": [3, 1], **{table: [1, 2, 3] for table in TABLES}}, "does not increase"),
        ({"roof": [1, 2]}, "too much or too little: roof"),
        ({"title": ""}, "title"),
    ],
)
def test_a_wrong_table_is_refused_with_the_place(tmp_path, change, told):
    path = tmp_path / "limits.yaml"
    path.write_text(yaml.safe_dump(TABLE | change))
    with pytest.raises(StageError, match=told) as fault:
        read_tolerances(str(path))
    assert "\n" not in str(fault.value) and "limits.yaml" in str(fault.value)


def test_a_table_of_ones_own_is_read_and_an_unknown_name_told(tmp_path):
    path = tmp_path / "limits.yaml"
    path.write_text(yaml.safe_dump(TABLE))
    assert read_tolerances(str(path)) == TABLE
    with pytest.raises(StageError, match=r"plan\.design\.tolerances: din_1 .*din_18202"):
        read_tolerances("din_1")
