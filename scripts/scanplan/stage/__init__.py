"""What every stage does: log, show progress, work on several cores, end with its run."""
