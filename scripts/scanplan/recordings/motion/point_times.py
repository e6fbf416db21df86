"""When within its sweep a point was measured: drivers' conventions, recognised by a sweep's length.

Drivers write seconds, milliseconds, microseconds or nanoseconds, since the scan's stamp, since the
epoch, or since the sensor was switched on, and say so nowhere. A sweep lasts between 5 ms and
0.5 s, which only one of these units can make of the same numbers.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from scanplan.recordings import clocks
from scanplan.stage import log
from scanplan.types import Array, FloatArray

SHORTEST_SWEEP_S = 5e-3  # 200 Hz, faster than any scanner turns
LONGEST_SWEEP_S = 0.5  # 2 Hz, slower than any turns; a hundredfold range parts units of 1,000
_QUANTILES = (0.05, 0.95)  # a sweep is judged between them, as a few times may be bad
_LEAST_AGREEING = 0.75  # share of the scans that a unit must make sweeps of
UNITS = ("s", "ms", "us", "ns")


@dataclass(frozen=True)
class TimeConvention:
    """How a sensor's driver writes the time of a point.

    Attributes
    ----------
    unit : str
        s, ms, us or ns.
    zero : str
        What it counts from: `stamp`, `epoch`, or `earliest`: a clock of its own, whose earliest
        reading in a scan is taken for the scan's stamp.
    """

    unit: str
    zero: str

    def seconds(self, time_raw: Array, t_ns: int) -> FloatArray:
        """Return when points were measured, relative to their scan's stamp.

        Parameters
        ----------
        time_raw : (n,) number
            Of all points of a scan.
        t_ns : int
            The scan's stamp.

        Returns
        -------
        (n,) float64
            Seconds; NaN where `time_raw` is no finite number.
        """
        values = np.asarray(time_raw)
        unit_ns = _unit_ns(self.unit)
        stamp_ns = t_ns if self.zero == "epoch" else 0
        if values.dtype.kind in "iu":
            values = values.astype(np.int64)
            start = _earliest(values) if self.zero == "earliest" else 0
            return ((values - start) * unit_ns - stamp_ns) / 1e9
        values = _to_floats(values)
        start = _earliest(_finite(values)) if self.zero == "earliest" else 0.0
        return (values - start - stamp_ns / unit_ns) * (unit_ns / 1e9)

    def __str__(self) -> str:
        since = {
            "stamp": "the stamp",
            "epoch": "the epoch",
            "earliest": "a start that is not stated (the earliest taken for the stamp)",
        }
        return f"{self.unit} since {since[self.zero]}"


class _TimedScan(NamedTuple):
    values: FloatArray  # finite ones
    time_raw: Array
    t_ns: int


def find_sweep_times(
    scans: Iterable[tuple[Array | None, int]], where: str, units: Sequence[str] = UNITS
) -> TimeConvention | None:
    """Find how the times of a sensor's points are written, and log it; see `find_time_convention`.

    Parameters
    ----------
    scans : iterable of (time_raw (n,) number or None, t_ns int)
    where : str
        What the scans are of, for the log.
    """
    scans = list(scans)
    convention = find_time_convention(scans, units)
    if convention:
        log.log_line(f"{where}: times of points are {convention}")
    elif any(time_raw is not None for time_raw, _ in scans):
        log.log_line(f"{where}: times of points are not those of a sweep: scans stay as recorded")
    return convention


def find_time_convention(
    scans: Iterable[tuple[Array | None, int]], units: Sequence[str] = UNITS
) -> TimeConvention | None:
    """Find how the times of a sensor's points are written.

    Parameters
    ----------
    scans : iterable of (time_raw (n,) number or None, t_ns int)
        The first scans of a survey: as recorded, and the stamp.
    units : collection of str
        Those that come into question.

    Returns
    -------
    TimeConvention or None
        None where no points are timed, their times cannot be those of a sweep (all the same, or too
        far apart), or the scans do not agree.
    """
    timed = [
        _TimedScan(_finite(_to_floats(time_raw)), np.asarray(time_raw), t_ns)
        for time_raw, t_ns in scans
        if time_raw is not None
    ]
    most = max((len(scan.values) for scan in timed), default=0)
    # a scan with few returns does not show the sweep
    full = [scan for scan in timed if len(scan.values) > most / 2]
    if not full:
        return None
    spans = [_span(scan.values) for scan in full]
    middle = int(np.argsort(spans, kind="stable")[len(full) // 2])
    unit = next((unit for unit in units if _lasts_a_sweep(spans[middle], unit)), None)
    if unit is None or np.mean([_lasts_a_sweep(span, unit) for span in spans]) < _LEAST_AGREEING:
        return None
    for zero in ("stamp", "epoch"):
        convention = TimeConvention(unit, zero)
        time_s = convention.seconds(full[middle].time_raw, full[middle].t_ns)
        if is_one_sweep(_without_outliers(_finite(time_s))):
            return convention
    return TimeConvention(unit, "earliest")


def is_one_sweep(time_s: FloatArray) -> bool:
    """Return whether times (n,) can be those of one sweep: together, and near the stamp (0)."""
    if len(time_s) == 0:
        return True
    first_s = time_s.min()
    last_s = time_s.max()
    # a comparison with NaN is false
    is_near = max(-first_s, last_s) <= clocks.OF_ANOTHER_CLOCK_S
    return bool(is_near and last_s - first_s <= LONGEST_SWEEP_S)


def _unit_ns(unit: str) -> int:
    return int(np.timedelta64(1, unit) // np.timedelta64(1, "ns"))


def _lasts_a_sweep(span: float, unit: str) -> bool:
    return SHORTEST_SWEEP_S <= span * _unit_ns(unit) / 1e9 <= LONGEST_SWEEP_S


def _span(values: FloatArray) -> float:
    """Return how long a sweep (n,) of evenly spread times lasts, in spite of a few bad ones."""
    if len(values) == 0:
        return 0.0
    low, high = np.quantile(values, _QUANTILES)
    return float((high - low) / np.ptp(_QUANTILES))


def _without_outliers(values: Array) -> Array:
    """Return the times of (n,) finite ones that are not far from the others."""
    if len(values) == 0:
        return values
    low, high = np.quantile(values, _QUANTILES)
    # bad ones are farther from most others than these from one another
    reach = high - low
    return values[(values >= low - reach) & (values <= high + reach)]


def _earliest(values: Array) -> float | int:
    return _without_outliers(values).min() if len(values) else 0


def _to_floats(time_raw: Array) -> FloatArray:
    values = np.asarray(time_raw).astype(np.float64)
    return np.where(np.isfinite(values), values, np.nan)


def _finite(values: FloatArray) -> FloatArray:
    return values[np.isfinite(values)]
