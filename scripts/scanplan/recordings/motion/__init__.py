"""The motion of the sensor during and between its sweeps."""
