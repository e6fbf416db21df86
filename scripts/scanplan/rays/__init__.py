"""Ray evidence on surfaces, openings and free space."""
