"""The one exception whose message is for the user."""


class StageError(Exception):
    """Wrong data or settings, in one line: the file, the value found, the limit and the remedy.

    A stage that raises it ends without traceback and without output. A wrong call (a programmer's
    mistake) is a `ValueError` instead.
    """

    def __init__(self, message: object) -> None:
        super().__init__(" ".join(str(message).split()))
