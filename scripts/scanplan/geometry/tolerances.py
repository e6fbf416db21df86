"""What counts as nothing: one answer for every sum, length and area."""

ROUNDING = 1e-9
"""Relative, or of metres and cells: sums and quotients in double precision agree far better."""

SAME_M = 1e-6
"""Coordinates nearer than a micrometre are the same: no sensor resolves them."""

DIGITS = 4
"""Decimals of metres that files of drawings have: a tenth of a millimetre."""

SHORTEST_M = 1e-3
"""Shorter lengths are rounding of coordinates that are given to the millimetre."""

FACING = 0.5
"""Cosine: surfaces turned by less than 60 degrees face the same way."""

SMALLEST_M2 = SHORTEST_M * SHORTEST_M
"""A square millimetre: smaller areas are equal, as overlays of large regions round them."""
