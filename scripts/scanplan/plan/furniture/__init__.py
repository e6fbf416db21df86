"""What stands in the building and is no wall."""
