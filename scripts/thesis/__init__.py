"""The laboratory: the thesis's experiments, and what orderings and extractors are compared by.

A workflow of its own, `workflow/thesis`, runs its stages. Nothing outside imports it.
"""
