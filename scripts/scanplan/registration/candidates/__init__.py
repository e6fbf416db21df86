"""Poses that drift: motions between scans instead of places in a map, and the loops among them."""
