"""What changed between two surveys of a floor."""
