"""A server for the report's page on this computer alone: it shows results and takes corrections.

It listens on 127.0.0.1. Whoever asks needs the token in the address; a page of another site, or a
name that leads here, gets nothing.
"""

import contextlib
import json
import mimetypes
import os
import secrets
import sys
import zlib
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, cast
from urllib.parse import unquote, urlsplit

from scanplan.errors import StageError
from scanplan.project.run import growing
from scanplan.project.run.edit_session import PAGE, ConflictError, EditSession

_HERE = "127.0.0.1"
_FIRST_PORT, _N_PORTS = 49152, 10_000  # of those that nobody has registered
_MOST_BYTES = 2**18
"""Of what a page sends: as much as is read of a file of corrections."""
_PATIENCE_S = 30  # for a request that has begun: a page here needs milliseconds
_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
"""What no other page may do with an answer: keep, embed, guess or frame it, learn its address."""
_SHOWN = (
    *(".html", ".pdf", ".svg", ".png", ".dxf", ".geojson", ".ifc", ".glb", ".gpkg", ".csv"),
    *(".json", ".pgm", ".yaml", ".tum", ".txt", ".bcf", ".laz"),
)
"""Files that the page links, by suffix; tables and recordings are none of them."""
_TAKEN = [("api", what) for what in ("corrections", "stop", "go")]
"""What a page may send."""
_RUN_PAGE = Path(__file__).absolute().parents[4] / "workflow/report/run/run.html"
"""What is shown in the report's place until there is one."""


class EditServer(ThreadingHTTPServer):
    """The server of a session, on a port of its results while that is free.

    A browser keeps things by the port: changes that were not saved are there again.

    Attributes
    ----------
    session : edit_session.EditSession
    token : str
        What all addresses begin with.
    """

    daemon_threads = True
    # elsewhere it lets two servers share a port
    allow_reuse_address = os.name == "posix"

    def __init__(self, session: EditSession) -> None:
        own = _FIRST_PORT + zlib.crc32(str(session.results).encode()) % _N_PORTS
        try:
            super().__init__((_HERE, own), _Handler)
        except OSError:
            super().__init__((_HERE, 0), _Handler)
        self.session = session
        self.token = secrets.token_urlsafe(24)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a page that has left before its answer."""
        if not isinstance(sys.exception(), ConnectionError | TimeoutError):
            super().handle_error(request, client_address)

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{_HERE}:{self.server_port}/{self.token}/{PAGE}"


class _Handler(BaseHTTPRequestHandler):
    timeout = _PATIENCE_S
    server_version, sys_version = "scanplan", ""

    @property
    def _served(self) -> EditServer:
        return cast(EditServer, self.server)

    def do_GET(self) -> None:
        place = self._find_place()
        session = self._served.session
        if place == ("api", "state"):
            self._answer(session.state)
        elif place == ("api", "run"):
            self._answer(session.tell_run)
        elif place == ("api", "drawn"):
            self._answer(session.draw)
        elif place == ("api", "points"):
            self._send_points()
        elif place == (PAGE,) and not session.is_made:
            self._send(HTTPStatus.OK, "text/html", _RUN_PAGE.read_bytes())
        elif place is not None:
            self._send_file(place)

    def do_POST(self) -> None:
        place = self._find_place()
        if place is None:
            return
        fault = self._find_fault(place)
        if fault is not None:
            self._refuse(*fault)
            return
        try:
            asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        except (ValueError, RecursionError):
            asked = None
        if not isinstance(asked, dict):
            self._refuse(HTTPStatus.BAD_REQUEST, "expected an object of JSON")
            return
        session = self._served.session
        acts = {"stop": session.stop, "go": session.go_on}
        self._answer(acts.get(place[1], lambda: session.save(asked)))

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing: addresses hold the token."""

    def _find_place(self) -> tuple[str, ...] | None:
        """Return the parts of the path after the token; None where nobody may ask."""
        host = self.headers.get("Host")
        # another name that leads here is one that a page elsewhere has given it
        is_here = host in [f"{name}:{self._served.server_port}" for name in (_HERE, "localhost")]
        if not is_here or self.headers.get("Origin", f"http://{host}") != f"http://{host}":
            self._refuse(HTTPStatus.FORBIDDEN, "asked by another page")
            return None
        token, *place = urlsplit(self.path).path.lstrip("/").split("/")
        if not secrets.compare_digest(token.encode(), self._served.token.encode()):
            self._refuse(HTTPStatus.FORBIDDEN, "the address lacks its token; open it again")
            return None
        return tuple(map(unquote, place))

    def _find_fault(self, place: tuple[str, ...]) -> tuple[HTTPStatus, str] | None:
        """Return why what is sent is not read."""
        length = self.headers.get("Content-Length", "")
        if "Origin" not in self.headers:
            return HTTPStatus.FORBIDDEN, "asked by no page"
        if place not in _TAKEN:
            return HTTPStatus.NOT_FOUND, "nothing is there"
        if self.headers.get_content_type() != "application/json":
            return HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "expected JSON"
        if not (length.isascii() and length.isdigit()):
            return HTTPStatus.LENGTH_REQUIRED, "does not say how long it is"
        if len(length) > len(str(_MOST_BYTES)) or int(length) > _MOST_BYTES:
            fault = f"the corrections have more than {_MOST_BYTES} bytes; take some back"
            return HTTPStatus.REQUEST_ENTITY_TOO_LARGE, fault
        return None

    def _send_file(self, place: tuple[str, ...]) -> None:
        folder = self._served.session.results
        is_plain = all(part and part[0] != "." and not set(part) & set("/\\\0") for part in place)
        path = folder.joinpath(*place)
        try:
            is_inside = is_plain and path.resolve().is_relative_to(folder.resolve())
            content = path.read_bytes() if is_inside and path.suffix in _SHOWN else None
        except OSError:
            content = None
        if content is None:
            self._refuse(HTTPStatus.NOT_FOUND, "nothing is there")
            return
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        self._send(HTTPStatus.OK, kind, content)

    def _send_points(self) -> None:
        pieces = growing.send_points(self._served.session.results)
        try:
            first = next(pieces)
        except StageError as error:
            self._refuse(HTTPStatus.BAD_REQUEST, str(error))
            return
        # how much is to come is not known: the end of the connection is that of the points
        self._send(HTTPStatus.OK, "application/octet-stream", first, is_whole=False)
        with contextlib.closing(pieces):
            for piece in pieces:
                self.wfile.write(piece)

    def _answer(self, act: Callable[[], Mapping[str, Any] | bytes]) -> None:
        status = HTTPStatus.OK
        try:
            try:
                said = act()
            except ConflictError as error:
                status = HTTPStatus.CONFLICT
                said = {**self._served.session.state(), "error": str(error)}
            content = said if isinstance(said, bytes) else json.dumps(said).encode()
        except StageError as error:
            self._refuse(HTTPStatus.BAD_REQUEST, str(error))
        except (OSError, TypeError, ValueError, RecursionError) as error:
            # of files that others write at the same time: a page waits for a line, not for nothing
            fault = f"{type(error).__name__}: {error}".splitlines()[0]
            self._refuse(HTTPStatus.INTERNAL_SERVER_ERROR, fault)
        else:
            self._send(status, "application/json", content)

    def _refuse(self, status: HTTPStatus, fault: str) -> None:
        self._send(status, "application/json", json.dumps({"error": fault}).encode())

    def _send(
        self, status: HTTPStatus, kind: str, content: bytes, *, is_whole: bool = True
    ) -> None:
        is_text = kind.startswith("text/") or kind.endswith(("json", "xml"))
        self.send_response(status)
        self.send_header("Content-Type", kind + "; charset=utf-8" * is_text)
        if is_whole:
            self.send_header("Content-Length", str(len(content)))
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)
