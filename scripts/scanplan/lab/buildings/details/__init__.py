"""What drawn buildings have beside walls and holes: leaves, columns, ceilings, stairs."""
