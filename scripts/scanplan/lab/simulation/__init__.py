"""Surveys of buildings with known walls."""
