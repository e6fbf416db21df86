"""The plan and its scans as data: what elements are called, tables, geometry, points, poses."""
