"""How floors are divided: strips of rooms, corridors, and the walls between boxes."""

from collections import defaultdict
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from .plan import Box, Plan, Xy

_TOUCH_M = 1e-3


def strip(
    rng: np.random.Generator,
    along: tuple[float, float],
    across: tuple[float, float],
    widths_m: tuple[float, float],
    grid_m: float = 0.05,
) -> list[Box]:
    """Divide a strip along x into boxes of random widths on a grid.

    Parameters
    ----------
    rng : numpy.random.Generator
    along, across : (float, float)
        From and to in x; from and to in y.
    widths_m : (float, float)
        Least and greatest width; the last box is mended into it where the length allows.
    grid_m : float
        Widths are multiples of it.

    Returns
    -------
    list of Box
    """
    length_m = along[1] - along[0]
    mean_m = (widths_m[0] + widths_m[1]) / 2
    count = max(1, round(length_m / mean_m))
    drawn = rng.uniform(*widths_m, count)
    edges = along[0] + np.concatenate([[0.0], np.cumsum(drawn)]) / drawn.sum() * length_m
    edges[1:-1] = along[0] + np.round((edges[1:-1] - along[0]) / grid_m) * grid_m
    spans = zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)
    return [(round(a, 4), across[0], round(b, 4), across[1]) for a, b in spans]


def parts(start_m: float, *widths_m: float) -> list[tuple[float, float]]:
    """Return the spans of given widths one after the other."""
    edges = np.round(np.concatenate([[start_m], start_m + np.cumsum(widths_m)]), 4).tolist()
    return list(pairwise(edges))


def border(a: Box, b: Box) -> tuple[Xy, Xy] | None:
    """Return the common side of two boxes, its lesser end first; None where there is none."""
    for axis in (0, 1):
        low, high = max(a[1 - axis], b[1 - axis]), min(a[3 - axis], b[3 - axis])
        for one, other in ((a, b), (b, a)):
            if abs(one[2 + axis] - other[axis]) < _TOUCH_M and high - low > _TOUCH_M:
                at = one[2 + axis]
                return ((low, at), (high, at)) if axis else ((at, low), (at, high))
    return None


def draw_partitions(
    plan: Plan, boxes: Sequence[Box], thickness_m: float | Callable[[int, int], float | None]
) -> None:
    """Draw the walls between boxes that touch, each as long as it is straight and as thick.

    Parameters
    ----------
    plan : Plan
    boxes : sequence of Box
    thickness_m : float or function
        Of the indices of two boxes; None where no wall stands between them.
    """
    runs = defaultdict(list)
    for j, b in enumerate(boxes):
        for i, a in enumerate(boxes[:j]):
            line = border(a, b)
            thick = thickness_m(i, j) if callable(thickness_m) else thickness_m
            if line is not None and thick is not None:
                axis = int(line[0][0] == line[1][0])
                key = (axis, round(line[0][1 - axis], 3), thick)
                runs[key].append((line[0][axis], line[1][axis]))
    for (axis, at, thick), spans in runs.items():
        for low, high in _joined(spans):
            ends = ((at, low), (at, high)) if axis else ((low, at), (high, at))
            plan.wall(*ends, thick)


def _joined(spans: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return spans with those joined that touch or overlap."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(spans):
        if joined and low <= joined[-1][1] + _TOUCH_M:
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return joined


def middle(box: Box) -> Xy:
    """Return the middle of a box."""
    return (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
