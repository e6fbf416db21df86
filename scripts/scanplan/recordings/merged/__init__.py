"""Merged clouds: points of a building that nothing tells from where they were seen."""
