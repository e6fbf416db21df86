"""Reading what a rover recorded: clouds, stamps, poses and motion."""
