"""Greedy cover, every scan looked at in every step."""


def order(seen, length_m):
    """Return the scans (rows of booleans) by what each adds.

    When none adds anything, as if nothing had been seen.
    """
    left, rest, chosen = list(length_m), list(range(len(seen))), []
    while rest:
        gains = [sum(m for m, s in zip(left, seen[i], strict=True) if s) for i in rest]
        if max(gains) <= 0:
            if left == list(length_m):
                return chosen + rest
            left = list(length_m)
            continue
        best = rest[gains.index(max(gains))]
        chosen.append(best)
        rest.remove(best)
        left = [0.0 if s else m for m, s in zip(left, seen[best], strict=True)]
    return chosen
