"""Recordings held against what they state of themselves: sizes, counts, checksums."""
