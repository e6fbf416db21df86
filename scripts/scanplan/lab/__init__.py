"""The laboratory: simulated surveys, evaluation against the truth, and the thesis.

Nothing outside imports it. Within it imports go one way: `simulation` imports `buildings` and
`evaluation`, `thesis` imports `evaluation`; `buildings` and `evaluation` import neither each other
nor what is above them.
"""
