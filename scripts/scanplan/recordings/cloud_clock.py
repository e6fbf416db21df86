"""Stamps of clouds by the clock of the poses, where a sensor has one of its own.

Ouster's driver, for one, stamps clouds by how long the sensor has been switched on. When messages
of both were received tells what is between the two clocks.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from scanplan.recordings import clocks, topics
from scanplan.recordings.small_messages import Samples, SmallMessages
from scanplan.stage import log
from scanplan.types import IntArray


class AlignedStamps(NamedTuple):
    """Stamps of clouds by the clock of the poses.

    Attributes
    ----------
    stamps_ns : (n,) int64
    sweep_ns : int
        How long before its receipt a cloud's stamp was taken to be, at least; 0 of one clock.
    """

    stamps_ns: IntArray
    sweep_ns: int = 0


def align_stamps(
    index: SmallMessages,
    source: topics.Topic,
    cloud: topics.Topic,
    recording_starts_ns: Sequence[int],
    measure_sweep_ns: Callable[[], int],
) -> AlignedStamps:
    """Return the stamps of all clouds by the clock of the poses; log what was added.

    Parameters
    ----------
    source, cloud : topics.Topic
        Of poses or of transforms, and of the clouds.
    recording_starts_ns : sequence of int
        When each recording begins, the first first.
    measure_sweep_ns : callable
        Returns how long after its stamp a cloud's last point is measured: none is received before.
    """
    samples = [index.poses.get(source.name, Samples())]
    if source.msgtype in topics.TRANSFORMS:
        samples = [found for (static, *_), found in index.transforms.items() if not static]
    t_ns, receive_ns = np.hstack([Samples().times_ns, *(found.times_ns for found in samples)])
    stamps_ns = index.stamps_ns
    if len(t_ns) == 0:
        return AlignedStamps(stamps_ns)
    t_ns = t_ns if t_ns.any() else receive_ns
    recording = np.searchsorted(recording_starts_ns, index.cloud_receive_ns, side="right")
    found = clocks.find_clock_offset(t_ns, receive_ns, stamps_ns, index.cloud_receive_ns, recording)
    if found is None:
        _compare_delays(receive_ns - t_ns, index.cloud_receive_ns - stamps_ns, cloud)
        return AlignedStamps(stamps_ns)
    sweep_ns = measure_sweep_ns()
    offset_ns = found.offset_ns - sweep_ns
    added = ", ".join(f"{each / 1e9:.3f}" for each in dict.fromkeys(offset_ns.tolist()))
    log.log_line(
        f"{cloud} has another clock than {source}: {added} s are added to its stamps, by the times"
        f" of receipt of both, nine tenths of which lie within {found.spread_ns / 1e9:.3f} s of it"
    )
    return AlignedStamps(stamps_ns + offset_ns, sweep_ns)


def _compare_delays(
    pose_delays_ns: IntArray, cloud_delays_ns: IntArray, cloud: topics.Topic
) -> None:
    """Clouds and poses stamped by different clocks give wrong poses that look right."""
    poses_s, clouds_s = (float(np.median(each)) / 1e9 for each in (pose_delays_ns, cloud_delays_ns))
    if abs(poses_s - clouds_s) > clocks.OF_ANOTHER_CLOCK_S:
        log.log_line(
            f"{cloud}: poses arrive {poses_s:.3f} s after their stamps, clouds {clouds_s:.3f} s:"
            " their clocks may differ"
        )
