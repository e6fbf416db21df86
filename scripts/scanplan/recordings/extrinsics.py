"""The sensor's extrinsics, base_from_sensor: from the config, from tf, or the identity."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.recordings import clocks, frame_edges, tf_tree, topics
from scanplan.recordings.small_messages import Samples, TransformKey
from scanplan.stage import log
from scanplan.types import IntArray


def configured_extrinsics(base_from_sensor: Sequence[float]) -> list[frame_edges.FrameEdge]:
    """Return the config's extrinsics as a chain of one edge.

    Parameters
    ----------
    base_from_sensor : (6,) float
        x, y, z in metres, roll, pitch, yaw in degrees (REP 103: about fixed x, y, z in this order).

    Returns
    -------
    list of frame_edges.FrameEdge

    Raises
    ------
    StageError
        If it is not six finite numbers.
    """
    from scipy.spatial.transform import Rotation  # 0.3 s, and few sensors are configured

    values = np.asarray(base_from_sensor, float)
    if values.shape != (6,) or not np.isfinite(values).all():
        raise StageError(
            f"input.base_from_sensor: {base_from_sensor} is not"
            " [x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg]; give six numbers"
        )
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("xyz", values[3:], degrees=True).as_matrix()
    pose[:3, 3] = values[:3]
    return [frame_edges.make_static_edge("", "", pose)]


def make_transform_edges(
    samples: Mapping[TransformKey, Samples],
    cloud_t_ns: IntArray,
    cloud_receive_ns: IntArray,
) -> list[frame_edges.FrameEdge]:
    """Make edges of recorded transforms; those stamped ahead of their time are taken back to it.

    Parameters
    ----------
    cloud_t_ns, cloud_receive_ns : (m,) int64, m >= 1
        Stamps and times of receipt of the clouds, for `clocks.estimate_ahead_ns`.

    Returns
    -------
    list of frame_edges.FrameEdge
        The constant ones last; of each constant transform the one recorded last, whatever its
        stamp.
    """
    edges = []
    n_invalid = 0
    n_ambiguous = 0
    for (static, parent, child), recorded in sorted(samples.items(), key=lambda item: item[0]):
        if static:
            edge, faults = _make_static_edge(parent, child, recorded)
        else:
            edge, faults = _make_moving_edge(parent, child, recorded, cloud_t_ns, cloud_receive_ns)
        n_ambiguous += faults[frame_edges.AMBIGUOUS]
        n_invalid += faults["not finite"] + faults["without unit quaternion"]
        if edge is not None:
            edges.append(edge)
    if n_invalid:
        log.log_line(f"tf: {n_invalid} transforms dropped: not finite or without unit quaternion")
    if n_ambiguous:
        log.log_line(f"tf: {n_ambiguous} transforms dropped: in a time that went by twice")
    return edges


def _make_static_edge(
    parent: str, child: str, recorded: Samples
) -> tuple[frame_edges.FrameEdge | None, dict[str, int]]:
    """Make an edge of the last valid transform: their order stands in for their stamps.

    Those that differ by less than a millimetre were printed with fewer digits once.
    """
    rows = recorded.rows
    order = np.arange(1, len(rows) + 1)
    edge, faults = frame_edges.make_track_edge(parent, child, order, order, rows)
    if edge is None:
        return None, faults
    return replace(edge.frozen(), is_contradicted=not edge.is_still(SHORTEST_M)), faults


def _make_moving_edge(
    parent: str,
    child: str,
    recorded: Samples,
    cloud_t_ns: IntArray,
    cloud_receive_ns: IntArray,
) -> tuple[frame_edges.FrameEdge | None, dict[str, int]]:
    t_ns, receive_ns = recorded.times_ns
    ahead_ns = clocks.estimate_ahead_ns(t_ns, receive_ns, cloud_t_ns, cloud_receive_ns)
    if ahead_ns:
        log.log_line(clocks.describe_lead(f"tf {parent} -> {child}", ahead_ns))
    return frame_edges.make_track_edge(parent, child, t_ns - ahead_ns, receive_ns, recorded.rows)


def find_extrinsics(
    tree: tf_tree.FrameTree, base: str, sensor: str, world: str, where: str
) -> list[frame_edges.FrameEdge]:
    """Return the chain base_from_sensor that tf holds.

    Parameters
    ----------
    base : str
        The frame that the poses are of; empty if it is not stated.
    sensor : str
        The frame of the clouds.
    world : str
        The frame that the poses are given in.
    where : str
        The dataset, for errors.

    Returns
    -------
    list of frame_edges.FrameEdge
        Empty where the two are one frame.

    Raises
    ------
    StageError
        If `base` is stated and tf does not connect it to `sensor`.
    """
    if not tree.frames:
        log.log_line(
            f"{where}: no tf, so the poses are taken for the sensor's own;"
            " else set input.base_from_sensor"
        )
        return []
    if not base and sensor not in tree.frames:
        log.log_line(
            f"{where}: tf does not know the clouds' frame {sensor},"
            " the poses are taken for the sensor's own"
        )
        return []
    base = base or tree.mount_root(sensor, world)
    path = tree.path(base, sensor)
    if path is None:
        raise StageError(
            f"{where}: tf does not connect base frame {base} to the clouds' frame {sensor};"
            f" its frames are {', '.join(tree.frames)};"
            " set input.base_frame or input.base_from_sensor"
        )
    return path


def better_poses_hint(tree: tf_tree.FrameTree, source: topics.Topic, world: str) -> str | None:
    """Return a line on better poses in tf where the chosen ones are plain odometry, else None."""
    try:
        root = tree.world_root(world)
    except StageError:  # a tree that cannot be climbed is no better source
        return None
    if source.msgtype != topics.ODOMETRY or root in (world, "odom"):
        return None
    return (
        f"{source} drifts, and tf places {world} in {root}: set input.pose_topic to /tf to use that"
    )
