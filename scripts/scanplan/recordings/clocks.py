"""Stamps that cannot be true, found by comparing them with each other and with the times of receipt."""

import numpy as np

_STEP_S = 1.0
_AHEAD_S, _CLOCKS_DIFFER_S = 0.02, 5.0
_BACK_NS = 500_000_000
_FEWEST_BACK = 3


def count_stamp_faults(t_ns, receive_ns):
    """Count what is odd about the stamps of a topic.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64
        In the order of recording.

    Returns
    -------
    dict of str to int
        How many repeat the stamp before, go back behind it, or step by a second more or less than the recorder's clock.
    """
    step_ns, elapsed_ns = np.diff(t_ns), np.diff(receive_ns)
    return {
        "of a repeated stamp": int((step_ns == 0).sum()),
        "backwards in time": int((step_ns < 0).sum()),
        f"jumping by more than {_STEP_S:g} s": int(
            (np.abs(step_ns - elapsed_ns) > _STEP_S * 1e9).sum()
        ),
    }


def estimate_ahead_ns(t_ns, receive_ns, cloud_t_ns, cloud_receive_ns):
    """Return by how much stamps are ahead of their time, 0 if they are not.

    Nothing is received before it was measured. AMCL stamps map to odom ahead by its `transform_tolerance`,
    robot_localization by its `transform_time_offset`; what holds for the clouds too is the recorder's clock.

    Parameters
    ----------
    t_ns, receive_ns : (n,) int64, n >= 1
    cloud_t_ns, cloud_receive_ns : (m,) int64, m >= 1
        Of the clouds.

    Returns
    -------
    int
    """
    lead_ns = np.median(np.asarray(t_ns) - receive_ns) - max(
        np.median(np.asarray(cloud_t_ns) - cloud_receive_ns), 0.0
    )
    return int(lead_ns) if _AHEAD_S * 1e9 < lead_ns < _CLOCKS_DIFFER_S * 1e9 else 0


def find_repeated_times(t_ns):
    """Tell which stamps lie in a time that went by twice, since the clock was set back.

    One message that comes late, or was kept since long ago, is no clock set back.

    Parameters
    ----------
    t_ns : (n,) int64
        In the order of recording.

    Returns
    -------
    (n,) bool
    """
    twice = np.zeros(len(t_ns), bool)
    for i in np.flatnonzero(np.diff(t_ns) < -_BACK_NS) + 1:
        begin, end = t_ns[i], t_ns[:i].max()
        if (t_ns[i:] < end).sum() >= _FEWEST_BACK:
            twice |= (t_ns >= begin) & (t_ns <= end)
    return twice
