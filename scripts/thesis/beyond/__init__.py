"""Experiments that go beyond those of the thesis."""
