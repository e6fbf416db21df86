"""Which elements of two surveys are one, by what they share."""

from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray


@dataclass(frozen=True)
class Pairing:
    """Rows of two lists.

    Attributes
    ----------
    pairs : list of (int, int)
        That are one, in order.
    lone_a, lone_b : list of int
        In no pair.
    """

    pairs: list[tuple[int, int]]
    lone_a: list[int]
    lone_b: list[int]


def pair_most(shared: FloatArray, least: float = 0.0) -> Pairing:
    """Pair rows with columns of a matrix (n, m), each once: first those that share most.

    No pair shares so little as a least.

    Examples
    --------
    >>> pair_most(np.array([[0.6, 0.9], [0.5, 0.8]])).pairs
    [(0, 1), (1, 0)]
    """
    rows: dict[int, int] = {}
    order = np.argsort(-shared, axis=None, kind="stable")
    order = order[shared.ravel()[order] > least]
    for i, j in zip(*(of.tolist() for of in np.unravel_index(order, shared.shape)), strict=True):
        if i not in rows and j not in rows.values():
            rows[i] = j
    n_a, n_b = shared.shape
    lone_a = [i for i in range(n_a) if i not in rows]
    lone_b = [j for j in range(n_b) if j not in rows.values()]
    return Pairing(sorted(rows.items()), lone_a, lone_b)
