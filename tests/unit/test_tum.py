"""evo reads poses as we write them, and we read them back to the nanosecond."""

import numpy as np
import pytest
from evo.tools import file_interface

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.store import tum

T_NS = np.array([1_700_000_000_123_456_789, 1_700_000_001_000_000_001], np.int64)
XYZ_M = np.array([(1.0, -2.0, 0.3), (1.5, -2.0, 0.3)])
HALF = np.sqrt(0.5)
QUAT = np.array([(0.0, 0.0, 0.0, 1.0), (0.0, 0.0, HALF, HALF)])


def test_evo_and_we_read_the_poses_that_were_written(tmp_path):
    path = tmp_path / "trajectory.tum"
    path.write_text(tum.format_tum(T_NS, se3.pose_matrix(XYZ_M, QUAT)))
    t_ns, rows = tum.read_tum(path)
    assert t_ns.tolist() == T_NS.tolist()
    assert rows == pytest.approx(np.hstack([XYZ_M, QUAT]), abs=1e-9)
    read = file_interface.read_tum_trajectory_file(str(path))
    assert read.positions_xyz == pytest.approx(XYZ_M)
    assert read.path_length == pytest.approx(0.5)
    assert read.check()[0]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("1 2 3 4 5 6 7", "line 2 has 7 numbers instead of 8"),
        ("1700000000123456789 0 0 0 0 0 0 1", "line 2 .*after the year 2262; give seconds"),
        ("1700000000123 0 0 0 0 0 0 1", "line 2 .*after the year 2262; give seconds"),
        ("2_0.0 0 0 0 0 0 0 1", "line 2 is not `t tx"),
        ("1 0 0 0 0 0 0 one", "line 2 is not `t tx"),
        ("1 " * 10_000, "line 2 has 20000 characters"),
    ],
)
def test_what_is_no_pose_is_told_with_its_line(tmp_path, line, told):
    path = tmp_path / "poses.tum"
    path.write_text(f"0 0 0 0 0 0 0 1 # a_comment\n{line}\n")
    with pytest.raises(StageError, match=told):
        tum.read_tum(path)
