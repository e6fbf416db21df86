"""What changed between two surveys as a drawing and as GeoJSON."""
