"""Where the sensor sits on what the poses are of: from the config, from tf, or nowhere told."""

import numpy as np
from scipy.spatial.transform import Rotation

from scanplan.errors import StageError
from scanplan.recordings import clocks, tf_tree, topics
from scanplan.stage import log


def configured_extrinsics(base_from_sensor):
    """Return the config's mount as a chain of one edge.

    Parameters
    ----------
    base_from_sensor : (6,) float
        x, y, z in metres, roll, pitch, yaw in degrees (REP 103: about fixed x, y, z in this order).

    Returns
    -------
    list of tf_tree.FrameEdge

    Raises
    ------
    StageError
        If it is not six finite numbers.
    """
    values = np.asarray(base_from_sensor, float)
    if values.shape != (6,) or not np.isfinite(values).all():
        raise StageError(
            f"input.base_from_sensor: {base_from_sensor} is not [x_m, y_m, z_m, roll_deg, pitch_deg, yaw_deg];"
            " give six numbers"
        )
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("xyz", values[3:], degrees=True).as_matrix()
    pose[:3, 3] = values[:3]
    return [tf_tree.make_static_edge("", "", pose)]


def make_transform_edges(samples, cloud_t_ns, cloud_receive_ns):
    """Make edges of recorded transforms; those stamped ahead of their time are taken back to it.

    Parameters
    ----------
    samples : dict of (static, parent, child) to list of (t_ns, receive_ns, row)
        In the order of recording.
    cloud_t_ns, cloud_receive_ns : (m,) int64, m >= 1
        Stamps and times of receipt of the clouds, for `clocks.estimate_ahead_ns`.

    Returns
    -------
    list of tf_tree.FrameEdge
        The constant ones last; of each constant transform the one recorded last, whatever its stamp.
    """
    edges, dropped, unclear = [], 0, 0
    for (static, parent, child), recorded in sorted(samples.items(), key=lambda item: item[0]):
        t_ns, receive_ns, rows = zip(*recorded, strict=True)
        order = range(1, len(rows) + 1)
        ahead_ns = (
            0
            if static
            else clocks.estimate_ahead_ns(t_ns, receive_ns, cloud_t_ns, cloud_receive_ns)
        )
        if ahead_ns:
            log.log_line(
                f"tf {parent} -> {child} is stamped {ahead_ns / 1e9:.3f} s ahead of its receipt: taken back"
            )
            t_ns = np.asarray(t_ns, np.int64) - ahead_ns
        edge, found = tf_tree.make_track_edge(
            parent, child, order if static else t_ns, order if static else receive_ns, rows
        )
        unclear += sum(count for kind, count in found.items() if "clock told twice" in kind)
        dropped += found["not finite"] + found["without unit quaternion"]
        if edge is not None:
            edges.append(edge.frozen() if static else edge)
    if dropped:
        log.log_line(f"tf: {dropped} transforms dropped: not finite or without unit quaternion")
    if unclear:
        log.log_line(f"tf: {unclear} transforms dropped: in a time that the clock told twice")
    return edges


def find_extrinsics(tree, base, sensor, world, where):
    """Return the chain base_from_sensor that tf knows.

    Parameters
    ----------
    tree : tf_tree.FrameTree
    base : str
        The frame that the poses are of; empty if nobody says.
    sensor : str
        The frame of the clouds.
    world : str
        The frame that the poses are given in.
    where : str
        The dataset, for errors.

    Returns
    -------
    list of tf_tree.FrameEdge
        Empty where the two are one frame.

    Raises
    ------
    StageError
        If `base` is stated and tf does not connect it to `sensor`.
    """
    if not tree.frames:
        log.log_line(
            f"{where}: no tf, so the poses are taken for the sensor's own; else set input.base_from_sensor"
        )
        return []
    known = sensor in tree.frames
    if not base and not known:
        log.log_line(
            f"{where}: tf does not know the clouds' frame {sensor}, the poses are taken for the sensor's own"
        )
        return []
    base = base or tree.mount_root(sensor, world)
    path = tree.path(base, sensor)
    if path is None:
        raise StageError(
            f"{where}: tf does not connect base frame {base} to the clouds' frame {sensor}; its frames are"
            f" {', '.join(tree.frames)}; set input.base_frame or input.base_from_sensor"
        )
    return path


def better_poses_hint(tree, source, world):
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
