"""Candidates as they are registered, before their poses are optimised together: all, or chunks."""
