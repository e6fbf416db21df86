"""The elements of a building model, and what joins them."""
