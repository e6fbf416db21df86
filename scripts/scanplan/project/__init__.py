"""What the workflow itself asks: settings, datasets, which code a stage depends on."""
