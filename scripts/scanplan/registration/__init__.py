"""From candidate scans to poses in one map."""
