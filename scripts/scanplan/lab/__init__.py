"""The laboratory: simulated surveys, evaluation against the truth, and the thesis; nothing outside imports it."""
