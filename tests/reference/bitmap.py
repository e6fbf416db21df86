"""The thesis's bitmap metrics (section 5.1), cell by cell."""


def rasterise(lines, low, cell, shape, steps=4000):
    """Return a map of 0 and 1: the cells in which any of many points along the lines lies."""
    rows, columns = shape
    cells = [[0] * columns for _ in range(rows)]
    for x0, y0, x1, y1 in lines:
        for step in range(steps + 1):
            share = step / steps
            column = int((x0 + share * (x1 - x0) - low[0]) // cell)
            row = int((y0 + share * (y1 - y0) - low[1]) // cell)
            cells[row][column] = 1
    return cells


def shares(inferred, truth):
    """Return false negative, correct match and false positive of two maps of 0 and 1."""
    errors = [
        i - t
        for row_i, row_t in zip(inferred, truth, strict=True)
        for i, t in zip(row_i, row_t, strict=True)
    ]
    return tuple(sum(error == value for error in errors) / len(errors) for value in (-1, 0, 1))
