import numpy as np

from scanplan.recordings import pose_jumps

S = 10**9
T_NS = np.arange(6) * S // 2
# steps of 0.4, 2, 0.5, 1.6 and 1 m in half a second each
X_M = np.cumsum([0, 0.4, 2, 0.5, 1.6, 1.0])


def found(**limits):
    return pose_jumps.find_jumps(T_NS, np.column_stack([X_M, 0 * X_M, 0 * X_M]), **limits)


def test_a_jump_is_far_and_fast():
    assert found(max_speed_m_s=3.0).tolist() == [False, True, False, True, False]
    assert found(max_speed_m_s=0.1).tolist() == [False, True, False, True, True]
    assert not found(max_speed_m_s=np.inf).any()
    assert len(pose_jumps.find_jumps(T_NS[:1], np.zeros((1, 3)), max_speed_m_s=1.0)) == 0


def test_inside_is_between_the_stamps():
    asked = (np.array([-1, 0, 0.3, 0.5, 0.7, 1.0, 1.2, 1.7, 2.0, 2.2, 9]) * S).astype(np.int64)
    expected = [False, False, False, False, True, False, False, True, False, False, False]
    assert pose_jumps.is_inside_jump(T_NS, found(max_speed_m_s=3.0), asked).tolist() == expected
    assert not pose_jumps.is_inside_jump(T_NS, found(max_speed_m_s=np.inf), asked).any()
    assert not pose_jumps.is_inside_jump(T_NS[:1], np.zeros(0, bool), asked).any()
