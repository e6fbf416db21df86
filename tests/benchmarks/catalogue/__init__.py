"""Buildings as they are, and drives through them, from seeds."""
