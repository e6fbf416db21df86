"""The sheet of a plan: one description of it that SVG, PDF, PNG and DXF render."""
