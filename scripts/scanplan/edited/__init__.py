"""Plans that were edited in other programs, and what was changed there as corrections."""
