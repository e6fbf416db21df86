"""The area of a growing union of polygons, brought up to date only where it must be."""
