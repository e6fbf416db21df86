"""A floor plan of arrays, for programs that hold their scans."""
