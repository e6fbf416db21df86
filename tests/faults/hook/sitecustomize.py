"""Faults of a computer, brought about in every Python process of a run whose PYTHONPATH ends here.

FAULT is `call:error:part of a path`: the call raises the error for paths with this part. It is
`clock:SECONDS:` where every file that is put in its place is dated so much ahead.
"""

import errno
import os
import time

CALL, ERROR, PART = (os.environ.get("FAULT") or "::").split(":", 2)


def _name(place):
    # what this is imported before must not be imported by it
    return os.readlink(f"/proc/self/fd/{place}") if isinstance(place, int) else os.fspath(place)  # noqa: PTH115


def _failing(call):
    def fail(place, *others, **named):
        if PART in str(_name(place)):
            number = getattr(errno, ERROR)
            raise OSError(number, os.strerror(number), str(_name(place)))
        return call(place, *others, **named)

    return fail


def _redating(call):
    def redate(source, target, **named):
        dated_s = time.time() + float(ERROR)
        os.utime(source, (dated_s, dated_s))
        return call(source, target, **named)

    return redate


if CALL == "clock":
    os.replace = _redating(os.replace)
elif CALL:
    setattr(os, CALL, _failing(getattr(os, CALL)))
    if CALL == "unlink":
        os.remove = os.unlink
