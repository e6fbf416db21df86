"""The thesis's bitmap metrics (section 5.1), cell by cell."""


def shares(inferred, truth):
    """Return false negative, correct match and false positive of two maps of 0 and 1."""
    errors = [
        i - t
        for row_i, row_t in zip(inferred, truth, strict=True)
        for i, t in zip(row_i, row_t, strict=True)
    ]
    return tuple(sum(error == value for error in errors) / len(errors) for value in (-1, 0, 1))
