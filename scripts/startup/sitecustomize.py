"""Ctrl-C while a process still imports ends it in one line; Python runs this before all else.

So does what a stage's imports raise, and streams, warnings and homes are mended that it could not
do with. All this holds where this folder is on PYTHONPATH: `make run` puts
it there for Snakemake, and a run for its stages.
"""

import os
import sys
import types

# what is imported here is what Python itself has imported by now: this is to be over at once
_HERE = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120
_SCRIPTS = os.path.dirname(_HERE)  # noqa: PTH120

sys.path.insert(0, _SCRIPTS)
from scanplan import interrupts, surroundings  # noqa: E402

sys.path.remove(_SCRIPTS)


def tell_fault(
    kind: type[BaseException], error: BaseException, trace: types.TracebackType | None
) -> None:
    """Tell what a stage raised before it began its log like what it raises later."""
    stage = getattr(sys.modules.get("__main__"), "snakemake", None)
    path = next(iter(getattr(stage, "log", ())), None)
    if path is None:
        sys.__excepthook__(kind, error, trace)
        return
    try:
        from scanplan.stage import log

        with log.log_to_file(path):
            raise error
    except SystemExit:
        pass
    except BaseException:
        # a stage that lacks code to tell it by
        sys.__excepthook__(kind, error.with_traceback(trace), trace)


surroundings.mend_surroundings()
sys.excepthook = tell_fault
# workers end with their stage, which is told when one ends by itself
if "--multiprocessing-fork" not in sys.orig_argv:
    interrupts.end_on_interrupt()

# the computer's own module of this name, if it has one, is not to be kept from its work
sys.path[:] = [place for place in sys.path if os.path.abspath(place) != _HERE]  # noqa: PTH100
_own = sys.modules.pop("sitecustomize")
try:
    import sitecustomize  # noqa: F401
except ImportError:
    sys.modules["sitecustomize"] = _own
