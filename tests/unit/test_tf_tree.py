import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import frame_edges, tf_tree

QUARTER = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
NONE = [0, 0, 0, 1]
SECOND = 10**9


def still(parent, child, xyz=(0, 0, 0), quat=NONE):
    return frame_edges.FrameEdge(parent, child, np.array([xyz], float), np.array([quat], float))


def moving(parent, child, t_s=(0, 1), x=(0, 1), quat=NONE):
    xyz = [[value, 0, 0] for value in x]
    return frame_edges.FrameEdge(
        parent,
        child,
        np.array(xyz, float),
        np.tile(np.array(quat, float), (len(x), 1)),
        np.array(t_s) * SECOND,
    )


def rows(*xs, quat=NONE):
    return [[x, 0, 0, *quat] for x in xs]


def test_track_sorts_keeps_the_later_of_two_and_counts():
    edge, found = frame_edges.make_track_edge(
        "map", "base", [30, 10, 20, 20], [1, 2, 3, 4], rows(3, 1, 2, 2.5)
    )
    assert edge.t_ns.tolist() == [10, 20, 30]
    assert edge.xyz_m[:, 0].tolist() == [1, 2.5, 3]
    assert {k: v for k, v in found.items() if v} == {
        "backwards in time": 3,
        "of a repeated stamp": 1,
    }


def test_track_drops_what_is_no_pose():
    poses = [*rows(0), *rows(1, quat=[0, 0, 0, 0]), *rows(np.nan), *rows(3, quat=[0, 0, 0, 1.01])]
    poses += [*rows(4, quat=[0, 0, 0, 1.0005]), *rows(5, quat=[0, np.inf, 0, 1])]
    edge, found = frame_edges.make_track_edge("map", "base", range(1, 7), range(6), poses)
    assert edge.t_ns.tolist() == [1, 5]
    np.testing.assert_allclose(np.linalg.norm(edge.quat_xyzw, axis=1), 1, atol=1e-12)
    assert (found["not finite"], found["without unit quaternion"]) == (2, 2)


def test_a_place_that_is_nowhere_on_earth_is_no_pose():
    edge, found = frame_edges.make_track_edge("map", "base", [1, 2], [1, 2], rows(1e7, 1e308))
    assert edge.t_ns.tolist() == [1] and found["not finite"] == 1


def test_track_without_stamps_takes_receive_times():
    edge, found = frame_edges.make_track_edge("map", "base", [0, 0], [7, 9], rows(1, 2))
    assert edge.t_ns.tolist() == [7, 9]
    assert found["without stamp (receive time taken)"] == 2


def test_track_of_nothing_usable():
    assert frame_edges.make_track_edge("map", "base", [], [], [])[0] is None
    edge, found = frame_edges.make_track_edge("map", "base", [1], [1], rows(np.nan))
    assert edge is None
    assert found["not finite"] == 1


def test_product_of_a_chain_on_paper():
    # at t = 0.5 s the base is at x = 0.5; the sensor sits 0.2 m ahead, turned by 90 degrees
    edges = [moving("map", "base"), still("base", "lidar", (0.2, 0, 0), QUARTER)]
    pose, gap_s, covered = frame_edges.chain_poses(edges, [SECOND // 2, 0, 2 * SECOND], max_gap_s=1)
    np.testing.assert_allclose(
        se3.transform_points(pose[0], [[1, 0, 0]]), [[0.7, 1, 0]], atol=1e-12
    )
    assert covered.tolist() == [True, True, False]
    assert gap_s.tolist() == [1, 0, np.inf]
    assert np.isnan(pose[2]).all()


def test_every_edge_must_cover_and_the_longest_gap_counts():
    edges = [
        moving("map", "odom", (0, 4), (0, 0)),
        moving("odom", "base", (0, 1, 2, 3), (0, 1, 2, 3)),
    ]
    query = np.array([1.5, 3.5]) * SECOND
    _, gap_s, covered = frame_edges.chain_poses(edges, query.astype(np.int64), max_gap_s=5)
    assert gap_s.tolist() == [4, np.inf]
    assert covered.tolist() == [True, False]
    assert not frame_edges.chain_poses(edges, query.astype(np.int64), max_gap_s=3)[2].any()


def test_constant_chain_is_always_covered():
    pose, gap_s, covered = frame_edges.chain_poses(
        [still("map", "lidar", (1, 2, 3))], [5], max_gap_s=0
    )
    np.testing.assert_allclose(pose[0, :3, 3], [1, 2, 3])
    assert (gap_s[0], covered[0]) == (0, True)
    assert frame_edges.chain_poses([], [5], max_gap_s=0)[0].tolist() == [np.eye(4).tolist()]


@given(st.lists(st.floats(-3, 3), min_size=12, max_size=12))
def test_inverse_undoes_an_edge(values):
    quat = Rotation.from_rotvec(np.reshape(values[6:], (2, 3))).as_quat()
    edge = frame_edges.FrameEdge(
        "a", "b", np.reshape(values[:6], (2, 3)), quat, np.array([0, SECOND])
    )
    back = edge.inverse()
    assert (back.parent, back.child) == ("b", "a")
    product, _, _ = frame_edges.chain_poses([edge, back], edge.t_ns, max_gap_s=1)
    np.testing.assert_allclose(product, np.tile(np.eye(4), (2, 1, 1)), atol=1e-9)


TREE = tf_tree.FrameTree(
    [
        moving("map", "odom"),
        moving("odom", "base_link"),
        moving("base_link", "shell", x=(0.3, 0.3)),
        still("shell", "lidar", quat=QUARTER),
        still("base_link", "base_footprint"),
        still("elsewhere", "island"),
    ]
)


def names(edges):
    return [(edge.parent, edge.child) for edge in edges]


def test_paths_down_up_and_across():
    down = [("map", "odom"), ("odom", "base_link"), ("base_link", "shell"), ("shell", "lidar")]
    assert names(TREE.path("map", "lidar")) == down
    assert names(TREE.path("lidar", "shell")) == [("lidar", "shell")]
    across = [("base_footprint", "base_link"), ("base_link", "shell"), ("shell", "lidar")]
    assert names(TREE.path("base_footprint", "lidar")) == across
    assert TREE.path("lidar", "lidar") == []
    assert TREE.path("island", "lidar") is None
    assert TREE.path("nowhere", "lidar") is None


def test_roots():
    assert TREE.world_root("lidar") == "map"
    assert TREE.mount_root("lidar", "map") == "base_link"
    assert TREE.world_root("island") == "elsewhere"
    assert tf_tree.FrameTree([moving("a", "odom"), moving("odom", "b")]).world_root("b") == "odom"
    assert tf_tree.FrameTree([moving("earth", "map"), moving("map", "b")]).world_root("b") == "map"


def test_a_base_above_which_two_localisers_move_is_still_the_mounts():
    placed = [moving(name, "base_link", x=x) for name, x in (("mocap", (0, 1)), ("slam", (5, 7)))]
    tree = tf_tree.FrameTree([*placed, still("base_link", "laser")])
    assert tree.mount_root("laser", "map") == "base_link"


def test_a_mount_that_nods_is_of_the_robots_base():
    tilting = moving("mount", "tilt", quat=NONE)
    edges = [moving("odom", "base_link"), still("base_link", "mount"), tilting]
    tree = tf_tree.FrameTree([*edges, still("tilt", "laser")])
    assert tree.mount_root("laser", "map") == "base_link"


def test_what_never_moves_is_mounted_but_a_standing_robot_is_not():
    tree = tf_tree.FrameTree(
        [moving("odom", "base_link", x=(2, 2)), moving("base_link", "lidar", x=(1, 1))]
    )
    odom, lidar = tree.path("odom", "lidar")
    assert odom.t_ns is not None
    assert lidar.t_ns is None
    assert tree.mount_root("lidar", "odom") == "base_link"
    custom = tf_tree.FrameTree([still("arena", "base_link"), still("base_link", "lidar")])
    assert custom.mount_root("lidar", "arena") == "base_link"


def test_cycles_and_two_parents():
    with refused(value="a -> c -> b -> a"):
        tf_tree.FrameTree([still("b", "c"), still("a", "b"), still("c", "a")]).world_root("a")
    two = tf_tree.FrameTree([still("a", "x"), still("b", "x"), still("x", "lidar")])
    with refused(value=("x", "a and b")):
        two.world_root("lidar")
    assert names(two.path("x", "lidar")) == [("x", "lidar")]
    assert names(two.path("lidar", "x")) == [("lidar", "x")]
    with refused(value=("x", "a and b")):
        two.path("a", "lidar")


def test_a_base_that_two_localisers_place_is_still_the_base_of_the_mount():
    tree = tf_tree.FrameTree(
        [moving("map", "base"), moving("mocap", "base"), still("base", "lidar")]
    )
    assert tree.mount_root("lidar", "map") == "base"


def test_a_mounting_that_is_broadcast_over_two_chains_is_one():
    """A driver's tf and the robot's description, equal to a micrometre."""
    robot = [moving("odom", "base"), still("base", "mount", (1, 0, 0), QUARTER)]
    over_mount = still("mount", "laser", (2, 0, 0))
    direct = still("base", "laser", (1, 2.000001, 0), QUARTER)
    tree = tf_tree.FrameTree([*robot, over_mount, direct])
    assert names(tree.path("odom", "laser")) == [("odom", "base"), ("base", "laser")]
    assert tree.mount_root("laser", "map") == "base"


@pytest.mark.parametrize(
    "direct",
    [
        still("base", "laser", (1, 2.01, 0), QUARTER),
        still("base", "laser", (1, 2, 0)),
        still("elsewhere", "laser", (1, 2, 0), QUARTER),
        moving("base", "laser"),
    ],
)
def test_chains_that_do_not_agree_are_told(direct):
    robot = [moving("odom", "base"), still("base", "mount", (1, 0, 0), QUARTER)]
    tree = tf_tree.FrameTree([*robot, still("mount", "laser", (2, 0, 0)), direct])
    with refused(key="base_from_sensor"):
        tree.path("odom", "laser")


def test_two_chains_in_a_cycle_end():
    tree = tf_tree.FrameTree([still("a", "x"), still("b", "x"), still("x", "a"), still("x", "b")])
    with pytest.raises(StageError, match="x"):
        list(tree.up("x"))
