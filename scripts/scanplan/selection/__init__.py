"""What scans cover, and the orders in which they are taken into the plan."""
