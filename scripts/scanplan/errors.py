"""The one exception whose message is for the user."""


class StageError(Exception):
    """Wrong data or settings, in one line: the file, the value found, the limit and the remedy.

    A stage that raises it ends without traceback and without output. A wrong call (a programmer's
    mistake) is a `ValueError` instead.
    """

    def __init__(self, message: object) -> None:
        line = " ".join(str(message).split())
        # a value may be a page long: what is before and behind it says more
        super().__init__(line if len(line) <= 1200 else f"{line[:800]} ... {line[-300:]}")
