import numpy as np
import pytest

from assemble_plan import assemble_plan
from scanplan import tables
from scanplan.errors import StageError
from wallmaking import BARE, SETTINGS, lengths_m, observed, walls

EVERYTHING = {"n_scans": None, "area_share": None}


def ordering(scan_ids, covered_m2):
    gain = np.diff(covered_m2, prepend=0.0)
    rank = np.arange(1, len(scan_ids) + 1)
    areas = {"gain_m2": gain, "covered_m2": covered_m2, "bound_m2": covered_m2}
    own = {"gain": gain, "covered": covered_m2, "bound": covered_m2}
    return {"rank": rank, "scan_id": scan_ids, **areas, **own}


@pytest.fixture
def files(tmp_path):
    """Three scans in the order 2, 0, 1; each sees another wall."""
    tables.write(tmp_path / "walls.parquet", tables.WALLS, walls([(0, 0, 1, 0), (0, 5, 2, 5), (0, 9, 3, 9)]))
    tables.write(tmp_path / "selection.parquet", tables.SELECTION, ordering([2, 0, 1], np.array([80.0, 95, 100])))
    return tmp_path / "walls.parquet", tmp_path / "selection.parquet", tmp_path / "faces.parquet"


def test_only_the_first_scans_make_the_plan(files):
    assemble_plan(*files, n_scans=2, area_share=None, settings=BARE)
    np.testing.assert_allclose(lengths_m(tables.read(files[2], tables.FACES)), [3, 1])


def test_the_covered_share_decides_as_well(files):
    assemble_plan(*files, n_scans=None, area_share=0.75, settings=BARE)
    np.testing.assert_allclose(lengths_m(tables.read(files[2], tables.FACES)), [3])


def test_without_a_limit_all_scans_count(files):
    assemble_plan(*files, **EVERYTHING, settings=BARE)
    assert len(tables.read(files[2], tables.FACES)["face"]) == 3


def test_the_same_tables_give_the_same_bytes(files, tmp_path):
    table = observed([(0, 0, 5, 0.3), (5, 0.3, 5, 4)], np.random.default_rng(1), n_scans=3)
    tables.write(files[0], tables.WALLS, table)
    assemble_plan(*files, **EVERYTHING, settings=SETTINGS)
    first = files[2].read_bytes()
    assemble_plan(*files, **EVERYTHING, settings=SETTINGS)
    assert files[2].read_bytes() == first


def test_no_wall_in_the_selected_scans_is_told(files):
    tables.write(files[0], tables.WALLS, walls([(0, 0, 1, 0)]))
    with pytest.raises(StageError, match=r"walls\.parquet: no wall in the first 1 scans .*selection\.stop"):
        assemble_plan(*files, n_scans=1, area_share=None, settings=BARE)
    assert not files[2].exists()


def test_no_wall_at_all_is_told(files):
    tables.write(files[0], tables.WALLS, walls([]), allow_empty=True)
    with pytest.raises(StageError, match="no wall in the first 3 scans"):
        assemble_plan(*files, **EVERYTHING, settings=BARE)


def test_walls_that_are_all_too_short_are_told(files):
    with pytest.raises(StageError, match=r"none of 3 wall segments .*min_length_m"):
        assemble_plan(*files, **EVERYTHING, settings=BARE | {"min_length_m": 4.0})


def test_numbers_that_are_not_finite_are_told(files):
    tables.write(files[0], tables.WALLS, walls([(0, 0, 1, 0)]) | {"x1_m": np.array([np.nan])})
    with pytest.raises(StageError, match="1 numbers are not finite"):
        assemble_plan(*files, **EVERYTHING, settings=BARE)
