"""Work space of the libraries for matrices, taken while there is memory for it.

OpenBLAS asks for 32 MB at its first product and keeps them. Where a limit (`ulimit -d` or `-v`)
refuses them it asks again for ever, without a signal being heard.
"""

import mmap
import sys

import numpy as np

_ROOM = 2 * 40 << 20  # bytes: what numpy's and scipy's take, and their matrices
_TOO_LARGE_TO_DO_WITHOUT = 256  # rows: products of few numbers take no work space


def take_work_space() -> None:
    """Have OpenBLAS take its work space, where the memory of this process is limited.

    Raises
    ------
    MemoryError
        If there is no room for it.
    """
    # it limits the memory of no process
    if sys.platform == "win32":
        return
    import resource

    limits = [resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_DATA, resource.RLIMIT_AS)]
    if all(limit == resource.RLIM_INFINITY for limit in limits):
        return
    try:
        mmap.mmap(-1, _ROOM).close()
    except OSError as error:
        raise MemoryError(f"no room for {_ROOM >> 20} MB of work space") from error
    matrix = np.ones((_TOO_LARGE_TO_DO_WITHOUT, _TOO_LARGE_TO_DO_WITHOUT))
    _ = matrix @ matrix
    # it has an OpenBLAS of its own, and half of the stages do without
    if "scipy" in sys.modules:
        from scipy import linalg

        linalg.cholesky(np.eye(len(matrix)))
