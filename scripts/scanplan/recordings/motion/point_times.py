"""When within its sweep a point was measured: drivers' conventions, told apart by how long a sweep can last.

Drivers write seconds, milliseconds, microseconds or nanoseconds, since the scan's stamp, since the epoch, or since the
sensor was switched on, and say so nowhere. A sweep lasts between 5 ms and 0.5 s, which only one of these units can make
of the same numbers.
"""

from dataclasses import dataclass

import numpy as np

SHORTEST_SWEEP_S, LONGEST_SWEEP_S = 5e-3, 0.5
_FARTHEST_FROM_STAMP_S = 1.0
# percentiles between which a sweep is judged, the share that lies between them, and how far others may lie beyond
_QUANTILES, _BETWEEN, _BEYOND = (5, 95), 0.9, 0.25
# so many of the scans have to agree
_MOST = 0.75
_UNIT_NS = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}


@dataclass(frozen=True)
class TimeConvention:
    """How a sensor's driver writes the time of a point.

    Attributes
    ----------
    unit : str
        s, ms, us or ns.
    zero : str
        What it counts from: `stamp`, `epoch`, or `earliest`: a clock of its own, whose earliest reading in a scan is
        taken for the scan's stamp.
    """

    unit: str
    zero: str

    def seconds(self, time_raw, t_ns):
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
        values, unit_ns = np.asarray(time_raw), _UNIT_NS[self.unit]
        stamp_ns = t_ns if self.zero == "epoch" else 0
        if values.dtype.kind in "iu":
            values = values.astype(np.int64)
            start = _earliest(values) if self.zero == "earliest" else 0
            return ((values - start) * unit_ns - stamp_ns) / 1e9
        values = _floats(values)
        start = _earliest(_finite(values)) if self.zero == "earliest" else 0.0
        return (values - start - stamp_ns / unit_ns) * (unit_ns / 1e9)

    def __str__(self):
        since = {
            "stamp": "the stamp",
            "epoch": "the epoch",
            "earliest": "a start that is not told (the earliest taken for the stamp)",
        }
        return f"{self.unit} since {since[self.zero]}"


def find_time_convention(scans, units=tuple(_UNIT_NS)):
    """Find how the times of a sensor's points are written.

    Parameters
    ----------
    scans : iterable of (time_raw (n,) number or None, t_ns int)
        The first scans of a survey: as recorded, and the stamp.
    units : collection of str
        Those that come into question.

    Returns
    -------
    Convention or None
        None where no points are timed, their times cannot be those of a sweep (all the same, or too far apart), or
        the scans do not agree.
    """
    timed = [
        (_finite(_floats(time_raw)), np.asarray(time_raw), t_ns)
        for time_raw, t_ns in scans
        if time_raw is not None
    ]
    most = max((len(values) for values, _, _ in timed), default=0)
    # of a scan with few returns the sweep is not seen
    full = [(_span(values), raw, t_ns) for values, raw, t_ns in timed if len(values) > most / 2]
    if not full:
        return None
    span, time_raw, t_ns = sorted(full, key=lambda item: item[0])[len(full) // 2]
    unit = next((unit for unit in units if _lasts_a_sweep(span, unit)), None)
    if unit is None or np.mean([_lasts_a_sweep(item[0], unit) for item in full]) < _MOST:
        return None
    zeros = (TimeConvention(unit, zero) for zero in ("stamp", "epoch"))
    return next(
        (c for c in zeros if is_one_sweep(_usual(_finite(c.seconds(time_raw, t_ns))))),
        TimeConvention(unit, "earliest"),
    )


def is_one_sweep(time_s):
    """Tell whether times (n,) relative to the stamp can be those of one sweep: close together, and close to it."""
    if len(time_s) == 0:
        return True
    first_s, last_s = time_s.min(), time_s.max()
    # a comparison with NaN is false
    near = max(-first_s, last_s) <= _FARTHEST_FROM_STAMP_S
    return bool(near and last_s - first_s <= LONGEST_SWEEP_S)


def _lasts_a_sweep(span, unit):
    return SHORTEST_SWEEP_S <= span * _UNIT_NS[unit] / 1e9 <= LONGEST_SWEEP_S


def _span(values):
    """How long a sweep (n,) lasts, whatever a few bad times say; they go evenly from its start to its end."""
    return (
        float(np.subtract(*np.percentile(values, _QUANTILES[::-1]))) / _BETWEEN
        if len(values)
        else 0.0
    )


def _usual(values):
    """Return the times of (n,) finite ones that are not far from the others."""
    if len(values) == 0:
        return values
    low, high = np.percentile(values, _QUANTILES)
    return values[
        (values >= low - _BEYOND * (high - low)) & (values <= high + _BEYOND * (high - low))
    ]


def _earliest(values):
    return _usual(values).min() if len(values) else 0


def _floats(time_raw):
    values = np.asarray(time_raw).astype(np.float64)
    return np.where(np.isfinite(values), values, np.nan)


def _finite(values):
    return values[np.isfinite(values)]
