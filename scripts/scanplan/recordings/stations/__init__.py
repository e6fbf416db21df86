"""Stations: scans that were taken standing still, each with a pose of its own."""
