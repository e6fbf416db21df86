"""The plan in the formats that others read."""
