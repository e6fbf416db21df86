"""Coverage of scans, and orders of scans by it."""
