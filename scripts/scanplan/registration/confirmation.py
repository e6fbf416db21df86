"""Anchors that no other scan confirms: a scan put where a lost localiser said, which would smear the map."""

from dataclasses import replace

import numpy as np


def find_unconfirmed(verdicts, is_linked, apart_m):
    """Find the anchors without a link where other scans are known to be in place.

    None are where nothing better is to be had: without a pose between them, a stretch in which no scan has a link is
    kept unless it lies within `apart_m` of one that has; and where even linked scans are mostly farther apart than that
    no scan needs to show what another does.

    Parameters
    ----------
    verdicts : sequence of sequential.ScanResult
        Of all candidates, in order.
    is_linked : (n,) bool
        Whether a candidate has a link that is believed.
    apart_m : float

    Returns
    -------
    (n,) bool
    """
    is_linked = np.asarray(is_linked, bool)
    place_m = np.array([verdict.world_from_sensor[:3, 3] for verdict in verdicts]).reshape(-1, 3)
    lone = np.array([verdict.reason == "anchor" for verdict in verdicts], bool) & ~is_linked
    known = np.isfinite(place_m).all(axis=1)
    step_m = np.linalg.norm(np.diff(place_m[is_linked], axis=0), axis=1)
    if not lone.any() or not is_linked.any() or np.median(step_m) > apart_m:
        return np.zeros(len(lone), bool)
    stretch = np.cumsum(~known)
    better = np.isin(stretch, stretch[is_linked])
    for row in np.flatnonzero(lone & ~better):
        better[row] = np.linalg.norm(place_m[is_linked] - place_m[row], axis=1).min() <= apart_m
    return lone & better


def drop_anchor(verdict, prior):
    """Return the verdict (sequential.ScanResult) on an anchor that is not confirmed, with the localiser's pose."""
    return replace(verdict, kept=False, reason="unconfirmed", world_from_sensor=prior)
