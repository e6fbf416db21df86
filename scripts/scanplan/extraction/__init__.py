"""Wall segments of single scans."""
