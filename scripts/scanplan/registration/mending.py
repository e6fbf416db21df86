"""Map of a survey whose localiser may have changed its map on the way: parts laid together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scanplan.errors import MOST_NAMED, StageError
from scanplan.registration import contradictions, mapping, parts
from scanplan.registration.constraints import neighbour_reach_m
from scanplan.registration.driven_map import DrivenMap, take_map
from scanplan.registration.mapping import SequentialMap
from scanplan.registration.multiway import OptimisedMap
from scanplan.registration.prepared_clouds import PreparedScans
from scanplan.registration.registration_settings import RegistrationSettings
from scanplan.registration.sequential import ScanResult
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import FloatArray, IntArray

_LEAST_SCANS = 3  # of a map that is told: a scan or two show next to nothing
_PART_KEY = "advanced.registration.part"


@dataclass(frozen=True)
class PlacedCandidates:
    """Candidates in one map.

    Attributes
    ----------
    results : list of sequential.ScanResult
        One per candidate; those of other maps are not kept.
    optimised : multiway.OptimisedMap or None
        None where no scan was registered.
    witnesses : sequence of witnesses.Measured
        Whether the map can be, and what became of others.
    """

    results: list[ScanResult]
    optimised: OptimisedMap | None
    witnesses: Sequence[Measured]


def place_candidates(
    registered: SequentialMap,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
    odometry: mapping.StepsBetween | None = None,
) -> PlacedCandidates:
    """Bring the candidates into one map; where a localiser changed its map, those that are tied.

    Parameters
    ----------
    registered, run, settings, odometry
        As of `mapping.optimise_map`.

    Raises
    ------
    StageError
        If a map is asked for that there is not.
    """
    survey, t_ns = registered.survey, registered.t_ns
    placed, optimised = mapping.optimise_map(registered, run, settings, odometry)
    if optimised is None or survey.is_odometry or not settings.graph.optimise:
        witnesses = () if optimised is None else optimised.witnesses
        _check_part(settings.part, 1)
        return PlacedCandidates(placed, optimised, witnesses)
    driven = _take_map(registered, placed, optimised, settings, odometry)
    changes = parts.find_changes(driven)
    if not changes:
        _check_part(settings.part, 1)
        return PlacedCandidates(placed, optimised, contradictions.measure_map(driven))
    tied = parts.tie_parts(driven, changes, run)
    _check_part(settings.part, len(tied.count_scans()))
    chosen = int(tied.count_scans().argmax()) if settings.part is None else settings.part - 1
    begins = np.searchsorted(survey.scan_ids, driven.scan_ids[tied.begins])
    # what lies between two parts fits neither: it is of the later one
    part = np.searchsorted(begins[1:], np.arange(len(survey.scan_ids)), side="right")
    of_map = registered.take((tied.group[part] == chosen).tolist(), tied.motion[part])
    placed, optimised = mapping.optimise_map(of_map, run, settings, odometry)
    if optimised is None:
        return PlacedCandidates(placed, None, ())
    driven = _take_map(of_map, placed, optimised, settings, odometry, begins)
    after_s = (t_ns[begins] - t_ns[0]) / 1e9
    told = [
        _measure_mended(tied, chosen, after_s),
        _measure_others(tied, chosen, after_s, is_asked=settings.part is not None),
    ]
    return PlacedCandidates(placed, optimised, [*told, *contradictions.measure_map(driven)])


def _take_map(
    registered: SequentialMap,
    placed: Sequence[ScanResult],
    optimised: OptimisedMap,
    settings: RegistrationSettings,
    odometry: mapping.StepsBetween | None,
    begins: IntArray | None = None,
) -> DrivenMap:
    """Return the map of candidates that were optimised together.

    Parameters
    ----------
    begins : (k,) int, optional
        Candidates with which parts begin, which are known to lie right.
    """
    kept = np.flatnonzero([result.kept for result in placed])
    clouds = PreparedScans(
        registered.thinned, registered.survey.planar, neighbour_reach_m(settings.limits)
    ).take(np.flatnonzero(np.isin(registered.kept, kept)))
    poses = np.array([placed[row].world_from_sensor for row in kept.tolist()])
    begun = [] if begins is None else begins[begins <= kept[-1]]
    settled = np.searchsorted(kept, begun).tolist()
    motions = None if odometry is None else odometry(kept)
    survey, t_ns = registered.survey.take(kept), registered.t_ns[kept]
    driven = take_map(survey, t_ns, poses, optimised, clouds, motions)
    return replace(driven, settled=settled)


def _measure_mended(tied: parts.TiedParts, chosen: int, after_s: FloatArray) -> Measured:
    """Return how many parts of the drive were laid into the map of the largest.

    Parameters
    ----------
    after_s : (k,) float64
        When each part begins, seconds after the first scan.
    """
    is_moved = ~np.isin(tied.by, ["", parts.RECORDED])
    moved = np.flatnonzero((tied.group == chosen) & is_moved).tolist()
    named = [f"{after_s[part]:,.0f} s by {tied.by[part]}" for part in moved[:MOST_NAMED]]
    more = " and later" if len(moved) > MOST_NAMED else ""
    return state_witness("mended map", len(moved), said=f"{', '.join(named)}{more}")


def _measure_others(
    tied: parts.TiedParts, chosen: int, after_s: FloatArray, *, is_asked: bool
) -> Measured:
    """Return how many parts of the drive, tied to no other, are left out.

    Parameters
    ----------
    after_s : (k,) float64
        As of `_measure_mended`.
    is_asked : bool
        Whether the chosen one was asked for: then that others are left out is no doubt.
    """
    size = tied.count_scans()
    others = [number for number in np.argsort(-size, kind="stable").tolist() if number != chosen]
    large = [number for number in others if size[number] >= _LEAST_SCANS]
    first = {number: int(np.argmax(tied.group == number)) for number in large}
    named = [
        f"part {number + 1} of {size[number]:,} scans from {after_s[first[number]]:,.0f} s on"
        for number in large[:MOST_NAMED]
    ]
    return state_witness(
        "other maps",
        0 if is_asked else len(large),
        n_left=int(size[others].sum()),
        n_scans=int(size.sum()),
        chosen=chosen + 1,
        said=", ".join(named),
        other=large[0] + 1 if large else 0,
    )


def _check_part(asked: int | None, n_maps: int) -> None:
    if asked is not None and asked > n_maps:
        raise StageError(
            f"{_PART_KEY}: is {asked}, and parts of the drive that nothing ties are {n_maps} in"
            " all; give the number of one, 1 the first, or leave the key out"
        )
