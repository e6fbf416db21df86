"""A run of the workflow: one at a time in a folder, what it shows, how it ends."""
