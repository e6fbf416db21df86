"""Drawing a building of a kind from a seed."""

import importlib
import zlib

import numpy as np

from .plan import Plan

KINDS = (
    "dwelling",
    "office_cellular",
    "office_open",
    "office_glass",
    "school",
    "hospital",
    "hotel",
    "old_house",
    "museum",
    "hall",
    "basement",
    "attic",
    "library",
    "shop",
)


def draw_building(kind: str, seed: int) -> Plan:
    """Draw a building of one of `KINDS`; the same kind and seed draw the same.

    Returns
    -------
    Plan
    """
    if kind not in KINDS:
        raise ValueError(f"{kind!r} is none of {', '.join(KINDS)}")
    plan = Plan(np.random.default_rng([seed, zlib.crc32(kind.encode())]))
    importlib.import_module(f".kinds.{kind}", __package__).draw(plan)
    return plan
