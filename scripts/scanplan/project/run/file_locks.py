"""Locks of open files, which end with their process: what each system has for that."""

import sys

HAVE_FOLDERS = sys.platform != "win32"
"""Whether folders can be opened and locked as files can."""


def lock_file(descriptor: int) -> None:
    """Lock an open file for this process alone.

    Raises
    ------
    BlockingIOError
        If another process holds it.
    OSError
        If its file system locks none.
    """
    if sys.platform == "win32":
        import msvcrt

        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(*error.args) from None
    else:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
