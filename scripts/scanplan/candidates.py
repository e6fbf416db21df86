"""Which scans go on to registration."""

import numpy as np


def choose(world_from_sensor, *, keep_every, max_step_m, max_turn_deg):
    """Retain every `keep_every`-th scan (thesis, algorithm 3, step 2), and more where the sensor moves fast.

    A scan between two of them is retained too once the sensor has moved more than `max_step_m` or turned more than
    `max_turn_deg` since the last retained scan with a pose, so that neighbours keep overlapping however slow the
    recorder was. Motion is known only where there are poses; the scans without go by their number alone.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float
        NaN where not known.
    keep_every : int
    max_step_m, max_turn_deg : float

    Returns
    -------
    (m,) int64
        Indices, increasing.
    """
    if keep_every < 1:
        raise ValueError(f"keep_every is {keep_every}")
    pose = np.asarray(world_from_sensor, float)
    known = np.isfinite(pose).all(axis=(1, 2))
    # |R - S| in the Frobenius norm is sqrt(8) sin(angle / 2)
    max_difference = np.sqrt(8) * np.sin(np.radians(min(max_turn_deg, 180)) / 2)
    chosen, last = [], None
    for i in range(len(pose)):
        moved = known[i] and last is not None and _moved(pose[last], pose[i], max_step_m, max_difference)
        if i % keep_every == 0 or moved:
            chosen.append(i)
            last = i if known[i] else last
    return np.array(chosen, np.int64)


def _moved(before, now, max_step_m, max_difference):
    step_m = np.linalg.norm(now[:3, 3] - before[:3, 3])
    return step_m > max_step_m or np.linalg.norm(now[:3, :3] - before[:3, :3]) > max_difference
