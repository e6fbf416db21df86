"""Lines, planes, rigid motions and polygons: geometry that knows nothing of scans."""
