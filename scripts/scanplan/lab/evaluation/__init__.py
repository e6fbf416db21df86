"""How good poses, walls and plans are, measured against the truth."""
