"""From wall segments of many scans to the faces of walls, each standing once."""
