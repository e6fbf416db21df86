"""Every claim of the thesis (`stated_claims`) held against our measurement of it.

A measure takes the tables of one seed, by name, and returns what was measured and by how much the
claim's criterion holds (None where it has none). No number is written in it but the criterion's.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from thesis import drive_claims, room_claims
from thesis.claim_measures import MARGIN, ClaimMeasure, Tables
from thesis.stated_claims import CLAIMS, Claim

ROOMS, DRIVE = "rooms", "drive"


def judge_claims(kind: str, survey: str, tables: Tables) -> list[dict[str, Any]]:
    """Measure all claims that a kind of survey is about.

    Parameters
    ----------
    kind : {"rooms", "drive"}
    survey : str
        The survey's name, for the table.
    tables : dict of str to pandas.DataFrame
        By the tables' names; those of the rooms begin with `rooms_`, those of the drive
        with `drive_`, those of the drive with the thesis's limits with `limits_`.

    Returns
    -------
    list of dict
        Rows of `thesis_schemas.CLAIMS`, one per quantity; of a judged claim the margin is one of
        them.
    """
    rows = []
    for claim in CLAIMS:
        measure = _measure_of(claim)
        if _kind(measure) != kind:
            continue
        measured = measure(tables)
        values = dict(measured.values)
        if measured.margin is not None:
            values[MARGIN] = measured.margin, measured.unit
        for quantity, (value, unit) in values.items():
            rows.append({
                "claim": claim.name,
                "survey": survey,
                "quantity": quantity,
                "value": float(value),
                "unit": unit,
                "holds": _verdict(measured.margin),
            })  # fmt: skip
    return rows


def _verdict(margin: float | None) -> str:
    if margin is None or np.isnan(margin):
        return ""
    return "yes" if margin > 0 else "no"


def _kind(measure: Callable[[Tables], ClaimMeasure]) -> str:
    return ROOMS if measure.__module__ == room_claims.__name__ else DRIVE


def _measure_of(claim: Claim) -> Callable[[Tables], ClaimMeasure]:
    """Return the function that is called like the claim."""
    return getattr(room_claims, claim.name, None) or getattr(drive_claims, claim.name)
