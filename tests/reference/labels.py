"""All ways to part a short line into stretches of kinds, one by one, with what each weighs."""

import math


def find_cuts(likely):
    """Return where stretches may begin and end, by the (c, l) weights of labels of columns."""
    n_columns = len(likely)
    best = [max(range(len(row)), key=list(row).__getitem__) for row in likely]
    cuts = {0, n_columns}
    for column in range(1, n_columns):
        if best[column] != best[column - 1]:
            cuts |= {column - 1, column, column + 1}
    return sorted(cut for cut in cuts if cut <= n_columns)


def list_ways(cuts, likely, labels, priors):
    """Yield the log weight of each way that is possible, and its stretches (begin, end, kind).

    `labels` is a list of (kind, log prior), `priors` has the logarithms of what a line begins and
    ends with, `begins[kind]` and `ends[kind]`, of what follows what, `change[kind][next kind]`, and
    of lengths, `length[kind][columns - 1]`.
    """

    def follow(begin, before, weight, stretches):
        if begin == cuts[-1]:
            if not math.isinf(priors["ends"][before]):
                yield weight + priors["ends"][before], stretches
            return
        for end in (cut for cut in cuts if cut > begin):
            for kind in range(len(priors["ends"])):
                comes = priors["begins"][kind] if before is None else priors["change"][before][kind]
                long = priors["length"][kind][end - begin - 1]
                if math.isinf(comes) or math.isinf(long):
                    continue
                here = comes + long + weigh_kind(begin, end, kind, likely, labels)
                yield from follow(end, kind, weight + here, [*stretches, (begin, end, kind)])

    yield from follow(cuts[0], None, 0.0, [])


def weigh_kind(begin, end, kind, likely, labels):
    """Return what all labels of a kind weigh together between two places."""
    weights = list(_weigh_labels(begin, end, kind, likely, labels).values())
    return add(weights) if weights else -math.inf


def best_label(begin, end, kind, likely, labels):
    """Return the number of the label of a kind that weighs most between two places."""
    weights = _weigh_labels(begin, end, kind, likely, labels)
    return max(weights, key=weights.get)


def kind_shares(ways, n_columns, n_kinds):
    """Return the probability of each kind in each column, as lists."""
    whole = add([weight for weight, _ in ways])
    shares = [[0.0] * n_kinds for _ in range(n_columns)]
    for weight, stretches in ways:
        for begin, end, kind in stretches:
            for column in range(begin, end):
                shares[column][kind] += math.exp(weight - whole)
    return shares


def add(logs):
    """Return the logarithm of a sum of what has these logarithms."""
    most = max(logs)
    return most + math.log(sum(math.exp(one - most) for one in logs))


def _weigh_labels(begin, end, kind, likely, labels):
    return {
        number: prior + sum(likely[column][number] for column in range(begin, end))
        for number, (of_kind, prior) in enumerate(labels)
        if of_kind == kind
    }
