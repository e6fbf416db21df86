# What the project names of pye57, whose compiled part has no types.
