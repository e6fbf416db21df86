"""Rooms of a plan: what bounds them, and what of their floor was seen."""
