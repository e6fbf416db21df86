"""Position tolerances and outlier counts of all ray evidence."""

ON_M = 0.08
"""Returns of one scan this near to a surface are its own: noise of ranges and roughness."""
BEHIND_M = 0.15
"""What is nearer before or behind a surface may be the surface: what poses and ranges err by."""
NEAR_FLOOR_M = 0.06
"""Above or below the floor: noise of heights, and what one steps over."""
SKIRTING_M = 0.2
"""Above the floor: lower returns may be the floor's, or a skirting board's."""
STRETCH_M = 0.3
"""Of a surface's length or height: less of it may be a trace of something else, or hidden."""
STRAY_SHARE = 0.15
"""Of rays, or of a length: less may be stray, or noise of heights and poses."""
FEW = 3
"""Rays, or scans: one or two that say so may be stray."""
