"""Several storeys as one building: their models and drawings put together."""
