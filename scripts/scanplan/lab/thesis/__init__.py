"""The thesis's experiments, figures and claims."""
