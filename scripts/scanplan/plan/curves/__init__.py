"""Curved walls: faces that are chords of one circle, and the walls that they show."""
