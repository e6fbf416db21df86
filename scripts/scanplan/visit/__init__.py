"""From where a second visit would settle what a plan does not know."""
