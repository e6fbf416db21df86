"""Python that has read the libraries already: half of what a run on two small rooms takes.

The code of the project is read anew by each process, as it is a copy's and may be edited.
"""

import importlib
import multiprocessing
import os
import runpy
import shlex
import socket
import socketserver
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

import threadpoolctl

_STARTER = multiprocessing.get_context("forkserver")
_STARTER.set_forkserver_preload(
    [
        *("snakemake.cli", "snakemake.report.html_reporter", "jsonschema", "numpy", "yaml"),
        *("pyarrow.parquet", "pyarrow.compute", "pandas", "shapely", "psutil", "jinja2"),
        *("scipy.ndimage", "scipy.optimize", "scipy.sparse.csgraph", "scipy.sparse.linalg"),
        *("scipy.spatial.transform", "scipy.special", "sklearn.cluster", "small_gicp"),
        *("matplotlib.figure", "matplotlib.backends.backend_svg", "mpl_toolkits.mplot3d"),
        *("matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf"),
        *("ezdxf", "ezdxf.addons.drawing", "ifcopenshell.geom", "ifcopenshell.util.element"),
        *("laspy", "rosbags.rosbag1", "rosbags.rosbag2", "rosbags.typesys", "open3d", "trimesh"),
    ]
)

# it hands a command to the server with its streams, and ends as that does
_CLIENT = """
import os, signal, socket, sys
server, program, python, *given = sys.argv[1:]
begun = given[given[0] == "-P"]
if begun != "-m" and not begun.endswith(".py"):
    os.execv(python, [python, *given])
environ = [b"%b=%b" % item for item in os.environb.items()]
said = [os.getcwdb(), b"%d" % len(given), *map(os.fsencode, [program, *given]), *environ]
with socket.socket(socket.AF_UNIX) as to_server:
    to_server.connect(server)
    socket.send_fds(to_server, [b"!"], [0, 1, 2])
    to_server.sendall(b"\\0".join(said))
    to_server.shutdown(socket.SHUT_WR)
    status = int(to_server.recv(16))
if status < 0:
    os.kill(os.getpid(), -status)
sys.exit(status)
"""


@contextmanager
def serve_python(folder):
    """Yield a program that runs `[-P] SCRIPT` or `-m MODULE` as Python does, in the block.

    A process that it starts by `sys.executable` begins so, too. Signals do not reach what it runs.

    Parameters
    ----------
    folder : path-like
        For its files, with a short path: that of a socket has 100 bytes.
    """
    place, client, program = (Path(folder, name) for name in ("socket", "client.py", "python"))
    client.write_text(_CLIENT)
    given = (sys.executable, "-IS", client, place, program, sys.executable)
    program.write_text(f'#!/bin/sh\nexec {shlex.join(map(os.fspath, given))} "$@"\n')
    program.chmod(0o700)
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(os.fspath(place))
        listening.listen()
        server = _STARTER.Process(target=_serve, args=(listening,))
        server.start()
    try:
        yield os.fspath(program)
    finally:
        server.terminate()
        server.join()


class _Server(socketserver.ForkingMixIn, socketserver.UnixStreamServer):
    """Each command has a process that waits for it."""


class _Waiting(socketserver.BaseRequestHandler):
    def handle(self):
        _, streams, *_ = socket.recv_fds(self.request, 1, 3)
        asked = b"".join(iter(lambda: self.request.recv(1 << 16), b""))
        run = multiprocessing.get_context("fork").Process(target=_run, args=(asked, streams))
        run.start()
        run.join()
        self.request.sendall(b"%d" % run.exitcode)


def _serve(listening):
    with _Server(None, _Waiting, bind_and_activate=False) as server:
        server.socket.close()
        server.socket = listening
        server.serve_forever(poll_interval=0.1)


def _run(asked, streams):
    """Run a command in this process, which is a new one, as if Python had begun with it."""
    folder, n_given, *rest = map(os.fsdecode, asked.split(b"\0"))
    n_words = 1 + int(n_given)
    words, environ = rest[:n_words], rest[n_words:]
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    # that of `multiprocessing` is empty
    sys.stdin = os.fdopen(0, closefd=False)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(item.split("=", 1) for item in environ)
    # as the libraries that count cores would read it
    threadpoolctl.threadpool_limits(int(os.environ.get("OMP_NUM_THREADS", os.cpu_count())))
    sys.executable, sys.orig_argv[:] = words[0], words
    is_safe = words[1] == "-P"
    given = words[1 + is_safe :]
    is_module = given[0] == "-m"
    sys.argv[:] = given[is_module:]
    # what the tests find besides is not there: their code is not that of a copy
    libraries = tuple(f"{place}/lib" for place in (sys.prefix, sys.base_prefix))
    own = [] if is_safe else [folder if is_module else os.fspath(Path(given[0]).absolute().parent)]
    added = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    sys.path[:] = [*own, *added, *(place for place in sys.path if place.startswith(libraries))]
    sys.modules.pop("sitecustomize", None)
    try:
        with suppress(ModuleNotFoundError):
            importlib.import_module("sitecustomize")
        if is_module:
            runpy.run_module(given[1], run_name="__main__", alter_sys=True)
        else:
            runpy.run_path(given[0], run_name="__main__")
    except Exception:
        sys.excepthook(*sys.exc_info())
        sys.exit(1)
