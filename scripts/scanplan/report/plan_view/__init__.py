"""The plan in the report: how it grows, and where a next visit would stand."""
