"""The one exception that speaks to the user."""


class StageError(Exception):
    """Wrong data or settings, told in one line: the file, the value found, the limit and the remedy.

    A stage that raises it ends without traceback and without output. A wrong call (a programmer's mistake) is a
    `ValueError` instead.
    """

    def __init__(self, message):
        super().__init__(" ".join(str(message).split()))
