"""`import scanplan` where a wheel has put it: its package lies among the files of the workflow.

The wheel calls this folder `scanplan`. What is imported is the package beside the stages, the same
one that a run of them finds, so that a digest of the code is that of a checkout.
"""

import importlib.util
import sys
from pathlib import Path

_FILE = Path(__file__).parents[1] / "scanplan_project/scripts/scanplan/__init__.py"
_spec = importlib.util.spec_from_file_location(
    __name__, _FILE, submodule_search_locations=[str(_FILE.parent)]
)
assert _spec is not None and _spec.loader is not None
# Python hands out what lies here, once this file has been read
sys.modules[__name__] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(sys.modules[__name__])
