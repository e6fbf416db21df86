"""Every claim of the thesis (`stated_claims`) held against our measurement of it.

A measure takes the tables of one seed, by name, and returns what was measured and whether the claim's criterion holds
(None where it has none). No number is written in it but the criterion's.
"""

from scanplan.lab.thesis import drive_claims, room_claims
from scanplan.lab.thesis.stated_claims import CLAIMS

ROOMS, DRIVE = "rooms", "drive"


def judge_claims(kind, survey, tables):
    """Measure all claims that a kind of survey can tell about.

    Parameters
    ----------
    kind : {"rooms", "drive"}
    survey : str
        The survey's name, for the table.
    tables : dict of str to dict
        Columns by the tables' names; those of the rooms begin with `rooms_`, those of the drive with `drive_`, those of
        the drive with the thesis's limits with `limits_`.

    Returns
    -------
    list of dict
        Rows of `schemas.CLAIMS`, one per quantity.
    """
    rows = []
    for claim in CLAIMS:
        measure = _measure_of(claim)
        if _kind(measure) != kind:
            continue
        found = measure(tables)
        holds = "" if found.holds is None else ("yes" if found.holds else "no")
        rows += [
            {
                "claim": claim.name,
                "survey": survey,
                "quantity": quantity,
                "value": float(value),
                "unit": unit,
            }
            | {"holds": holds}
            for quantity, (value, unit) in found.values.items()
        ]
    return rows


def _kind(measure):
    return ROOMS if measure.__module__ == room_claims.__name__ else DRIVE


def _measure_of(claim):
    """The function that is called like the claim."""
    return getattr(room_claims, claim.name, None) or getattr(drive_claims, claim.name)
