"""The design of a floor as it was drawn, and how what was built differs from it."""
