"""A session behind its server, as `scanplan open` has it, in the process of a test."""

import contextlib
import threading

from scanplan.project.run.edit_server import EditServer


@contextlib.contextmanager
def serving(session):
    """The server of a session; its run ends with it."""
    with EditServer(session) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()
            session.end()
