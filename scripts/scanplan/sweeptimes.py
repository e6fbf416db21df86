"""When within its sweep a point was measured: drivers' conventions, told apart by how long a sweep can last.

Drivers write seconds, milliseconds, microseconds or nanoseconds, since the scan's stamp, since the epoch, or since the
sensor was switched on, and say so nowhere. A sweep lasts between 5 ms and 0.5 s, which only one of these units can make
of the same numbers.
"""

from dataclasses import dataclass

import numpy as np

SHORTEST_SWEEP_S, LONGEST_SWEEP_S = 5e-3, 0.5
_FARTHEST_FROM_STAMP_S = 1.0
_UNIT_NS = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}


@dataclass(frozen=True)
class Convention:
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
            start = values.min(initial=np.iinfo(np.int64).max) if self.zero == "earliest" else 0
            return ((values - start) * unit_ns - stamp_ns) / 1e9
        values = _floats(values)
        start = np.nanmin(values, initial=np.inf) if self.zero == "earliest" else 0.0
        return (values - start - stamp_ns / unit_ns) * (unit_ns / 1e9)

    def __str__(self):
        since = {
            "stamp": "the stamp",
            "epoch": "the epoch",
            "earliest": "a start that is not told (the earliest taken for the stamp)",
        }
        return f"{self.unit} since {since[self.zero]}"


def convention(scans, units=tuple(_UNIT_NS)):
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
        None where no points are timed, or their times cannot be those of a sweep: all the same, or too far apart.
    """
    spans = [(_span(time_raw), np.asarray(time_raw), t_ns) for time_raw, t_ns in scans if time_raw is not None]
    longest, time_raw, t_ns = max(spans, key=lambda item: item[0], default=(0.0, None, 0))
    for unit in units:
        if SHORTEST_SWEEP_S <= longest * _UNIT_NS[unit] / 1e9 <= LONGEST_SWEEP_S:
            zeros = (Convention(unit, zero) for zero in ("stamp", "epoch"))
            found = next((c for c in zeros if is_sweep(_finite(c.seconds(time_raw, t_ns)))), None)
            return found or Convention(unit, "earliest")
    return None


def is_sweep(time_s):
    """Tell whether times (n,) relative to the stamp can be those of one sweep: close together, and close to it."""
    if len(time_s) == 0:
        return True
    first_s, last_s = time_s.min(), time_s.max()
    # a comparison with NaN is false
    near = max(-first_s, last_s) <= _FARTHEST_FROM_STAMP_S
    return bool(near and last_s - first_s <= LONGEST_SWEEP_S)


def _span(time_raw):
    values = _finite(_floats(time_raw))
    return float(np.ptp(values)) if len(values) else 0.0


def _floats(time_raw):
    values = np.asarray(time_raw).astype(np.float64)
    return np.where(np.isfinite(values), values, np.nan)


def _finite(values):
    return values[np.isfinite(values)]
