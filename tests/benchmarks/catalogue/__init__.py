"""Buildings as they are, and drives through them, from seeds: see `drives`."""

from .drives import HALVES, SEEDS, SUBSET, Drive, list_drives, write_survey

__all__ = ["HALVES", "SEEDS", "SUBSET", "Drive", "list_drives", "write_survey"]
