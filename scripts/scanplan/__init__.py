"""From raw rover recordings to a floor plan: the helpers that every stage shares.

One topic a file; nothing is imported here, so that a stage pays only for what it uses.
"""
