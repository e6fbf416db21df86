"""The figures of the thesis, drawn from what was measured."""
