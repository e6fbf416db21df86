"""What all steps of a plan take for noise, and for enough."""

END_M = 0.1  # how far ends err: poses, noise of ranges, and what a scan sees of a reveal
CORNER_M = 0.3  # a wall that ends this near before another meets it: half of a thick wall
FACE_M = 0.08  # as far as points of a face scatter before and behind its line
NOISE_M = 0.03  # of a range or a height: a range seen along 15 degrees, poses, beams
HINGE_M = 0.2  # from a jamb to the end of its leaf: what a leaf is thick, and its end is off by
WIDEST_LEAF_M = 1.25  # a wider door has two leaves (DIN 18101 ends there)
ENOUGH_RAYS = 10  # fewer say nothing of a height, a direction or a way
LEAST_SCANS = 2  # one alone may meet a wall at one height, or have something too near to measure
LOW_PERCENT = 2  # of heights: lower ones may be stray, as may be so many at the top
ALONG_SHARE = 0.7  # of a width: what is there all along, though other things hide the rest
FURNITURE_M2 = 3.0  # that furniture stands on, or parts off between it and a wall, at most
