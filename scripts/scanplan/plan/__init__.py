"""From wall segments and points of the chosen scans to walls, openings and rooms."""
