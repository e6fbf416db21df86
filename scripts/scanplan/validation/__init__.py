"""How well a plan predicts the rays of scans that it was not made of."""
