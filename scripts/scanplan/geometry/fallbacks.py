"""How often overlays had to be done another way: counted here, told in a stage's log."""

_n_fallbacks = 0


def note_fallbacks(count: int = 1) -> None:
    """Count overlays that were done another way, here or in a process that worked for this one."""
    global _n_fallbacks
    _n_fallbacks += count


def take_fallbacks() -> int:
    """Return how often overlays were done another way since this was asked last."""
    global _n_fallbacks
    taken, _n_fallbacks = _n_fallbacks, 0
    return taken
