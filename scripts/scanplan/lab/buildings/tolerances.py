"""Lengths that reading, cutting and describing buildings agree on, from digits to a room."""

DECIMALS = 6  # of coordinates and lengths in metres, as written
MESHING_M = 1e-4  # seams and corners of one thing differ by this in a mesh
DRAWN_M = 0.001  # how exactly things lie on each other in drawings; lines count as this wide
CRACK_M = 0.01  # what is thinner is a gap between parts, or the difference of two thicknesses
THRESHOLD_M = 0.06  # ASSUME the rover climbs this: up to it the ground is floor, doors are open
ROOM_M = 0.6  # ASSUME narrower spaces are shafts, narrower gaps in a floor thresholds
MAX_EXTENT_M = 2000.0  # a larger floor is in another unit, on a globe, or a town
