"""Independent random numbers for every part of a simulated survey, all from its one seed."""

from enum import IntEnum

import numpy as np


class RandomStream(IntEnum):
    """A stream's purpose; a number that stands for two would correlate their errors."""

    RANGE_NOISE = 0
    LOCALISER_NOISE = 1
    ODOMETRY = 2
    BEAM_BIAS = 3
    GRAZING_LOSS = 4
    GLASS = 5
    PEOPLE = 6
    LOCALISER_DRIFT = 7
    LOCALISER_JUMPS = 8
    ROUTE_START = 9
    CLUTTER = 10
    MIRROR = 20
    POLISHED = 21
    MIXED = 22
    STRAY = 23
    SWAY = 24
    SLAM = 25
    START = 26
    ODOMETRY_WALK = 27
    SLIP = 28
    STANDING = 29
    LEAVES = 30


def open_stream(seed: int, stream: RandomStream, *index: int) -> np.random.Generator:
    """Return the generator of a stream, of one scan or person of it where an index is given."""
    return np.random.default_rng([seed, int(stream), *index])
