"""Surveys with a known truth: simulated ones, and what plans and poses are measured by.

No other package imports it, and no stage that a recording without a truth runs. Within it imports
go one way: `simulation` imports `buildings` and `evaluation`, which import neither each other nor
what is above them.
"""
